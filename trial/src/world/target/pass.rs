//! How a body passes iron, but for a straight line at one depth: it heaves with the sea, and may be in a turn.

use std::f64::consts::{FRAC_PI_2, TAU};

use rand::RngExt;

use super::super::vector::{Vector, length, scaled};
use crate::random::{Random, log_uniform};

/// Heave, m rms, and its periods, s. A body that is towed shallow follows the swell.
const HEAVES_M: [f64; 2] = [0.05, 0.4];
const PERIODS_S: std::ops::Range<f64> = 3.0..9.0;
/// Share of the passes that are in a turn, and its radii, m: those of boxes and eights of a small boat.
const IN_A_TURN: f64 = 0.5;
const RADII_M: [f64; 2] = [12.0, 80.0];

/// What a body does beside going straight on. Two waves of the same height: their sum is none that repeats.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pass {
    amplitude_m: f64,
    /// Of each wave, its frequency, rad/s, and phase, rad.
    waves: [[f64; 2]; 2],
    /// Over the radius of the turn, 1/m, to starboard; 0 of none.
    curvature_per_m: f64,
}

impl Pass {
    /// In the sea of a recording, on no turn.
    pub(super) fn in_a_sea(draw: &mut Random) -> Self {
        let rms_m = log_uniform(HEAVES_M, draw);
        let mut wave = || [TAU / draw.random_range(PERIODS_S), draw.random_range(0.0..TAU)];
        Self { amplitude_m: rms_m, waves: [wave(), wave()], curvature_per_m: 0.0 }
    }

    /// The same sea, and a turn or none.
    pub(super) fn with_any_turn(self, draw: &mut Random) -> Self {
        let is_turn = draw.random_bool(IN_A_TURN);
        let radius_m = log_uniform(RADII_M, draw) * if draw.random_bool(0.5) { 1.0 } else { -1.0 };
        Self { curvature_per_m: if is_turn { 1.0 / radius_m } else { 0.0 }, ..self }
    }

    /// From where it was nearest to where it is, m; `velocity_m_per_s` is that at the nearest point, horizontal. It turns by a right angle
    /// to either side and goes straight on there.
    pub(super) fn way_m(&self, velocity_m_per_s: Vector, since_s: f64, time_s: f64) -> Vector {
        let turn_per_s = self.curvature_per_m * length(velocity_m_per_s);
        let [ahead_s, beside_s] = ahead_and_beside(turn_per_s, since_s);
        let [north, east, _] = velocity_m_per_s;
        let heave_m: f64 = self.waves.iter().map(|[rate, phase]| libm::sin(rate * time_s + phase)).sum();
        let [to_north_m, to_east_m, _] = scaled(velocity_m_per_s, ahead_s);
        [to_north_m - beside_s * east, to_east_m + beside_s * north, self.amplitude_m * heave_m]
    }
}

/// How far one comes in so many seconds ahead and to starboard of where one is headed, in seconds of going straight on; just these where
/// there is no turn.
fn ahead_and_beside(turn_per_s: f64, since_s: f64) -> [f64; 2] {
    if turn_per_s == 0.0 {
        return [since_s, 0.0];
    }
    let angle = (turn_per_s * since_s).clamp(-FRAC_PI_2, FRAC_PI_2);
    let straight_s = since_s - angle / turn_per_s;
    let (sin, cos) = libm::sincos(angle);
    [sin / turn_per_s + straight_s * cos, (1.0 - cos) / turn_per_s + straight_s * sin]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    /// Steps are as long as without a turn, and the turn has its radius as far as it goes.
    #[test]
    fn a_turn_is_a_circle_between_two_straight_ways() {
        let turn = Pass { curvature_per_m: 1.0 / 15.0, ..Pass::default() };
        let place = |way_m: f64| turn.way_m([2.0, 0.0, 0.0], way_m / 2.0, 0.0);
        for way_m in [-60.0, -20.0, 5.0, 23.0, 50.0] {
            let [a, b] = [place(way_m), place(way_m + 0.01)];
            assert!(((a[0] - b[0]).hypot(a[1] - b[1]) - 0.01).abs() < 1e-6, "{way_m}");
        }
        for way_m in [-20.0, 5.0, 23.0] {
            let [north, east, _] = place(way_m);
            assert!((north.hypot(east - 15.0) - 15.0).abs() < 1e-9, "{way_m}");
        }
    }

    #[test]
    fn a_straight_pass_is_that_of_its_velocity_to_the_bit() {
        let velocity_m_per_s = [1.7, -0.9, 0.0];
        for since_s in [-12.3, 0.1, 7.7] {
            let [north, east, down] = Pass::default().way_m(velocity_m_per_s, since_s, 100.0);
            assert_eq!([north, east, down], [since_s * 1.7, since_s * -0.9, 0.0]);
        }
    }

    #[test]
    fn it_heaves_as_much_as_is_said() {
        let sea = Pass::in_a_sea(&mut Random::seed_from_u64(3));
        let down_m = |s: i32| sea.way_m([2.0, 0.0, 0.0], 0.0, f64::from(s))[2];
        let rms_m = ((0..10_000).map(|s| down_m(s).powi(2)).sum::<f64>() / 10_000.0).sqrt();
        assert!((rms_m / sea.amplitude_m - 1.0).abs() < 0.05, "{rms_m}");
    }
}

//! A dipole that the body passes, and what is seen of it.

use super::super::vector::{Vector, dot, length, scaled};
use super::pass::Pass;
use crate::answer::Target;

/// Samples of a lobe, from as many times its length before the nearest point to as many after.
const STEPS: i32 = 2000;
const REACH: f64 = 8.0;

/// A dipole that is passed.
#[derive(Clone, Debug)]
pub(crate) struct Dipole {
    /// When it is nearest, s since the first row.
    pub(super) nearest_s: f64,
    /// North, east, down, m/s, where it is nearest.
    pub(super) velocity_m_per_s: Vector,
    /// How it is passed, but for straight on.
    pub(super) pass: Pass,
    /// From the dipole to the body where it is nearest, m.
    pub(super) offset_m: Vector,
    /// Magnetic constant over 4 pi times its moment, nT m^3.
    pub(super) moment_nt_m3: Vector,
    /// What of it is seen, on the recording's time axis.
    pub(crate) seen: Target,
}

impl Dipole {
    /// Its field along that of the Earth, nT.
    pub(super) fn anomaly_nt(&self, earth: Vector, time_s: f64) -> f64 {
        let since_s = time_s - self.nearest_s;
        let way_m = self.pass.way_m(self.velocity_m_per_s, since_s, time_s);
        let place: Vector = std::array::from_fn(|k| self.offset_m[k] + way_m[k]);
        let distance_m = length(place);
        let unit = scaled(place, 1.0 / distance_m);
        let moment = self.moment_nt_m3;
        (3.0 * dot(moment, unit) * dot(unit, earth) - dot(moment, earth)) / distance_m.powi(3)
    }

    /// Time since the nearest point, size and width of the largest lobe.
    pub(super) fn largest_lobe(&self, earth: Vector) -> Target {
        let step_s = REACH * length(self.offset_m) / length(self.velocity_m_per_s) / f64::from(STEPS);
        let at = |step: i32| self.anomaly_nt(earth, self.nearest_s + step_s * f64::from(step));
        let size = |step: &i32| at(*step).abs();
        let top = (-STEPS..=STEPS).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
        let peak_nt = at(top);
        let is_inside = |step: &i32| at(*step) / peak_nt > 0.5;
        let last = (top..=STEPS).take_while(is_inside).last().unwrap_or(top);
        let first = (-STEPS..=top).rev().take_while(is_inside).last().unwrap_or(top);
        // Straight between the last sample inside and the first one outside.
        let beyond = |inside: i32, outside: i32| (at(inside) - 0.5 * peak_nt) / (at(inside) - at(outside));
        let steps = f64::from(last - first) + beyond(last, last + 1) + beyond(first, first - 1);
        Target { time_s: step_s * f64::from(top), peak_nt, width_s: step_s * steps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn over_a_vertical_dipole_in_a_vertical_field_the_anomaly_is_that_of_the_textbook() {
        let seen = Target { time_s: 0.0, peak_nt: 0.0, width_s: 0.0 };
        let (velocity_m_per_s, offset_m) = ([2.0, 0.0, 0.0], [0.0, 0.0, -4.0]);
        let (pass, moment_nt_m3) = (Pass::default(), [0.0, 0.0, 640.0]);
        let dipole = Dipole { nearest_s: 10.0, velocity_m_per_s, pass, offset_m, moment_nt_m3, seen };
        let down = [0.0, 0.0, 1.0];
        // m (2 z^2 - x^2) / (x^2 + z^2)^(5/2): 2 m / z^3 = 20 nT above it, none at x = z root 2.
        for (time_s, nt) in [(10.0, 20.0), (10.0 + 2.0 * 2.0_f64.sqrt(), 0.0)] {
            assert!((dipole.anomaly_nt(down, time_s) - nt).abs() < 1e-9);
        }
        let at_x = |x: f64| 640.0 * (32.0 - x * x) / (x * x + 16.0).powf(2.5);
        assert!((dipole.anomaly_nt(down, 11.0) - at_x(2.0)).abs() < 1e-9);
        let lobe = dipole.largest_lobe(down);
        assert!((lobe.peak_nt - 20.0).abs() < 1e-9 && lobe.time_s == 0.0);
        // Half of it where at_x is 10 nT, at x = 2.02 m: as wide as it is deep, at 2 m/s.
        let half_m = 0.5 * lobe.width_s * 2.0;
        assert!((at_x(half_m) - 10.0).abs() < 0.01, "{half_m}");
    }
}

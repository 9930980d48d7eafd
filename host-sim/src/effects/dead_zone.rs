//! `dead_zone`: near one axis the scalar sensor's signal is weak, its reading noisy, and it does not say so.

use rand_distr::{Distribution, StandardNormal};

use super::parts::{axis, axis_azimuth_deg, axis_elevation_deg, dot, real, scalar_by_row};
use crate::effects::{Change, Draw, Effect, Kind, Parameter, Search, Spec};
use crate::simulator::signals::Signals;

/// The effect `dead_zone`.
#[derive(Debug)]
pub struct DeadZone;

const PARAMETERS: &[Parameter] = &[
    axis_azimuth_deg(Kind::Searched),
    axis_elevation_deg(Kind::Searched),
    real("half_angle_deg", "deg", [0.0, 90.0], [2.0, 45.0], Kind::Searched),
    real("noise_nT", "nT", [0.0, 10_000.0], [0.05, 50.0], Kind::Spread),
];

const SPEC: Spec = Spec {
    name: "dead_zone",
    title: "a dead zone of the scalar sensor",
    what: "extra white noise while the field is within some angle of an axis, in either sense",
    origin: "optical pumping gives no signal along (or across) the optical axis",
    source: "5 to 10 degrees in sensor handbooks; the G-882's asks for 15 to 75 degrees off the axis",
    model: "white noise near an axis, not flagged",
    parameters: PARAMETERS,
    random: true,
    search: Search::Cone,
    injectable: true,
    ..Spec::BASE
};

impl Effect for DeadZone {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], draw: &mut Draw) -> Change {
        scalar_by_row(signals, |row| {
            // Drawn for every row, so that the noise of a row does not depend on the angle.
            let unit: f64 = StandardNormal.sample(draw);
            if is_within(signals, parameters, row) { parameters[3] * unit } else { 0.0 }
        })
    }

    fn variance(&self, signals: &Signals, parameters: &[f64]) -> Option<Change> {
        let square = parameters[3].powi(2);
        Some(scalar_by_row(signals, |row| if is_within(signals, parameters, row) { square } else { 0.0 }))
    }
}

fn is_within(signals: &Signals, parameters: &[f64], row: usize) -> bool {
    let off_axis = dot(signals.rows().direction[row], axis(parameters[0], parameters[1])).abs();
    off_axis >= libm::cos(parameters[2].to_radians())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulator::signals::tests::signals;
    use rand::SeedableRng;

    #[test]
    fn the_noise_is_where_the_angle_says_and_as_strong_as_asked() {
        let signals = signals();
        let (mut sum, mut count) = (0.0, 0);
        for seed in 0..40 {
            let change = DeadZone.change(&signals, &[0.0, -90.0, 25.0, 2.0], &mut Draw::seed_from_u64(seed));
            for (c, nt) in signals.rows().direction.iter().zip(change.scalar_nt) {
                // Down or up: the axis is the vertical one in either sense.
                let is_inside = c[2].abs().acos().to_degrees() <= 25.0;
                assert_eq!(nt != 0.0, is_inside);
                (sum, count) = (sum + nt * nt, count + usize::from(is_inside));
            }
        }
        assert!(count > 1000 && count < 40 * 600, "{count}");
        assert!((sum / count as f64 / 4.0 - 1.0).abs() < 0.05);
    }
}

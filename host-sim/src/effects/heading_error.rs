//! `heading_error`: the scalar sensor reads another field at another angle. `s' = s + h3 u^3 + h4 u^4`, `u = c . a`.
//!
//! Terms in `u` and `u^2` lie in the span of the 18 terms and are no gap.

use super::parts::{axis, axis_azimuth_deg, axis_elevation_deg, dot, linear, scalar_by_row};
use crate::effects::{Change, Draw, Effect, Kind, Parameter, Search, Spec, Step};
use crate::simulator::signals::Signals;

/// The effect `heading_error`. The opposite axis with the opposite cubic term is the same.
#[derive(Debug)]
pub struct HeadingError;

/// Half the width of the derivatives by the axis, degrees.
const TURN: Step = Step::fixed(0.5);

const PARAMETERS: &[Parameter] = &[
    axis_azimuth_deg(Kind::Differentiable(TURN)),
    axis_elevation_deg(Kind::Differentiable(TURN)),
    linear("cubic_nT", "nT", 1000.0, 20.0),
    linear("quartic_nT", "nT", 1000.0, 20.0),
];

const SPEC: Spec = Spec {
    name: "heading_error",
    title: "a heading error of the scalar sensor",
    what: "the scalar reading depends on the angle between the field and the sensor's optical axis",
    origin: "nonlinear Zeeman splitting and light shift of the rubidium or cesium line",
    source: "6 nT of nonlinear Zeeman effect in rubidium (arXiv 2310.11017), several nT in airborne cesium sensors",
    model: "`s' = s + h3 u^3 + h4 u^4`, `u = c . a`",
    parameters: PARAMETERS,
    search: Search::Axis,
    injectable: true,
    ..Spec::BASE
};

impl Effect for HeadingError {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    /// The axis that points down.
    fn canonical(&self, mut parameters: Vec<f64>) -> Vec<f64> {
        if parameters[1] < 0.0 {
            parameters[0] = (parameters[0] + 360.0).rem_euclid(360.0) - 180.0;
            parameters[1] = -parameters[1];
            parameters[2] = -parameters[2];
        }
        parameters
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let [azimuth_deg, elevation_deg, cubic_nt, quartic_nt] = *parameters else { unreachable!("four parameters") };
        let axis = axis(azimuth_deg, elevation_deg);
        scalar_by_row(signals, |row| {
            let u = dot(signals.rows().direction[row], axis);
            u * u * u * (cubic_nt + quartic_nt * u)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::signals;

    #[test]
    fn on_the_three_axes_it_is_a_power_of_a_component() {
        let signals = signals();
        for (angles, component) in [([0.0, 0.0], 0), ([90.0, 0.0], 1), ([17.0, 90.0], 2)] {
            let change = HeadingError.change(&signals, &[angles[0], angles[1], 2.0, -3.0], &mut no_draw());
            for (c, nt) in signals.rows().direction.iter().zip(change.scalar_nt) {
                assert!((nt - (2.0 * c[component].powi(3) - 3.0 * c[component].powi(4))).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_opposite_axis_with_the_opposite_cubic_is_the_same() {
        let signals = signals();
        let one = HeadingError.change(&signals, &[30.0, 20.0, 2.0, 3.0], &mut no_draw()).scalar_nt;
        let other = HeadingError.change(&signals, &[-150.0, -20.0, -2.0, 3.0], &mut no_draw()).scalar_nt;
        assert!(one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-9));
    }
}

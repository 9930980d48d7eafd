//! `fluxgate_scale`: each fluxgate axis has its own scale. `f'_i = (1 + 1e-6 k_i) f_i`.

use super::parts::{flux_by_row, linear};
use crate::effects::{Change, Channel, Draw, Effect, Parameter, Spec};
use crate::simulator::signals::Signals;

/// The effect `fluxgate_scale`.
#[derive(Debug)]
pub struct FluxgateScale;

const PARAMETERS: &[Parameter] = &[
    linear("x_ppm", "ppm", 200_000.0, 5000.0),
    linear("y_ppm", "ppm", 200_000.0, 5000.0),
    linear("z_ppm", "ppm", 200_000.0, 5000.0),
];

const SPEC: Spec = Spec {
    name: "fluxgate_scale",
    title: "unequal scales of the fluxgate's axes",
    what: "each axis of the fluxgate is read too large or too small",
    origin: "scale of sensor and converter, calibrated elsewhere or aged",
    source: "28 to 99 ppm on the Swarm satellites, 0.1 to 1 % of low-cost sensors",
    model: "`f'_i = (1 + 1e-6 k_i) f_i`",
    parameters: PARAMETERS,
    channel: Channel::Fluxgate,
    injectable: true,
    ..Spec::BASE
};

impl Effect for FluxgateScale {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    /// Scale factors with zero mean: a common one does not show.
    fn canonical(&self, mut parameters: Vec<f64>) -> Vec<f64> {
        let mean = parameters.iter().sum::<f64>() / 3.0;
        parameters.iter_mut().for_each(|scale| *scale -= mean);
        parameters
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        flux_by_row(signals, |_, f| std::array::from_fn(|i| 1e-6 * parameters[i] * f[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::signals;

    #[test]
    fn a_common_scale_lengthens_the_vector_and_one_axis_its_share() {
        let signals = signals();
        let common = FluxgateScale.change(&signals, &[100.0; 3], &mut no_draw());
        let first = FluxgateScale.change(&signals, &[100.0, 0.0, 0.0], &mut no_draw());
        for row in 0..signals.len() {
            let (f, c) = (signals.rows().flux_nt[row], signals.rows().direction[row]);
            let field_nt = signals.rows().field_nt[row];
            assert!((0..3).all(|i| (common.flux_nt[row][i] - f[i] / 10_000.0).abs() < 1e-9));
            // Along the field: F k c_x^2.
            let along: f64 = (0..3).map(|i| first.flux_nt[row][i] * c[i]).sum();
            assert!((along - 1e-4 * field_nt * c[0] * c[0]).abs() < 1e-4);
        }
    }
}

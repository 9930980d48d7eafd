//! `fluxgate_bias`: each fluxgate axis has an offset. `f' = f + b`.

use super::parts::{flux_by_row, linear};
use crate::effects::{Change, Channel, Draw, Effect, Parameter, Spec};
use crate::simulator::signals::Signals;

/// The effect `fluxgate_bias`.
#[derive(Debug)]
pub struct FluxgateBias;

const PARAMETERS: &[Parameter] = &[
    linear("x_nT", "nT", 100_000.0, 100.0),
    linear("y_nT", "nT", 100_000.0, 100.0),
    linear("z_nT", "nT", 100_000.0, 100.0),
];

const SPEC: Spec = Spec {
    name: "fluxgate_bias",
    title: "an offset of the fluxgate",
    what: "a constant is added to each axis of the fluxgate",
    origin: "offset of sensor and converter, or a magnet fixed beside the fluxgate",
    source: "5 to 100 nT of commercial fluxgates",
    model: "`f' = f + b`",
    parameters: PARAMETERS,
    channel: Channel::Fluxgate,
    injectable: true,
    ..Spec::BASE
};

impl Effect for FluxgateBias {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let b = [parameters[0], parameters[1], parameters[2]];
        flux_by_row(signals, |_, _| b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::signals;

    #[test]
    fn the_magnitude_changes_by_the_bias_along_the_field() {
        let signals = signals();
        let change = FluxgateBias.change(&signals, &[10.0, -20.0, 30.0], &mut no_draw());
        for (row, b) in change.flux_nt.iter().enumerate() {
            let (f, c) = (signals.rows().flux_nt[row], signals.rows().direction[row]);
            let length = ((f[0] + b[0]).powi(2) + (f[1] + b[1]).powi(2) + (f[2] + b[2]).powi(2)).sqrt();
            let along = 10.0 * c[0] - 20.0 * c[1] + 30.0 * c[2];
            // What is across the field adds its square over twice the field, 14 / 1000 nT at most.
            assert!((length - signals.rows().field_nt[row] - along - 0.007).abs() < 0.0075);
        }
    }
}

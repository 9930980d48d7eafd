//! `depth_gradient`: the field changes with depth. `s' = s + g (z - mean z)`.

use super::parts::{depth_m, linear, mean, scalar_by_row};
use crate::effects::{Change, Column, Draw, Effect, Parameter, Spec};
use crate::simulator::signals::Signals;

/// The effect `depth_gradient`.
#[derive(Debug)]
pub struct DepthGradient;

const PARAMETERS: &[Parameter] = &[linear("gradient_nT_per_m", "nT/m", 1000.0, 10.0)];

const SPEC: Spec = Spec {
    name: "depth_gradient",
    title: "a vertical gradient of the field",
    what: "the scalar reading follows the body's depth",
    origin: "vertical gradient of the main field, of rock or of objects below",
    source: "0.01 to 0.03 nT/m of the main field, 0.1 to 10 nT/m near rock and iron",
    model: "`s' = s + g (z - mean z)`; needs a tow",
    parameters: PARAMETERS,
    needs: Some(Column::Depth),
    ..Spec::BASE
};

impl Effect for DepthGradient {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let depth_m = depth_m(signals);
        let mean_m = mean(depth_m);
        scalar_by_row(signals, |row| parameters[0] * (depth_m[row] - mean_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::signals;
    use std::f64::consts::TAU;

    #[test]
    fn a_metre_of_heave_is_the_gradient() {
        let signals = signals();
        let change = DepthGradient.change(&signals, &[0.7], &mut no_draw());
        for (time_s, nt) in signals.epochs_s().iter().zip(change.scalar_nt) {
            // Six whole periods: the mean of the sine is zero.
            assert!((nt - 0.7 * (TAU * 0.1 * time_s).sin()).abs() < 1e-9);
        }
    }
}

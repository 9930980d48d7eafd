//! `scalar_lowpass`: a first-order low-pass in the scalar channel. `time_constant ds'/dt = s - s'`.

use super::parts::{low_passed, real};
use crate::effects::{Change, CoefficientDependence, Draw, Effect, Kind, Parameter, Search, Spec, Step};
use crate::simulator::signals::Signals;

/// The effect `scalar_lowpass`.
#[derive(Debug)]
pub struct ScalarLowpass;

const PARAMETERS: &[Parameter] =
    &[real("time_constant_s", "s", [1e-4, 5.0], [0.005, 0.5], Kind::Differentiable(Step::growing(2e-4, 0.02)))];

const SPEC: Spec = Spec {
    name: "scalar_lowpass",
    title: "a low-pass in the scalar sensor",
    what: "the scalar sensor follows the field with a first-order low-pass",
    origin: "the tracking loop or the output filter of the sensor",
    source: "time constants of 10 to 300 ms in commercial sensors",
    model: "first-order low-pass of `s`",
    parameters: PARAMETERS,
    coefficients: CoefficientDependence::Proportional,
    search: Search::Secant { starts: &[0.01, 0.1, 0.5] },
    injectable: true,
    ..Spec::BASE
};

impl Effect for ScalarLowpass {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn typical(&self, _: &Signals) -> Vec<f64> {
        vec![0.05]
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        low_passed(signals, signals.scalar_nt(), parameters[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::sine_signals;
    use std::f64::consts::TAU;

    #[test]
    fn a_sine_has_the_analytic_amplitude_and_phase() {
        let signals = sine_signals(20.0, 0.5);
        let wt = TAU * 0.5 * 0.15;
        let change = ScalarLowpass.change(&signals, &[0.15], &mut no_draw());
        for (time_s, change_nt) in signals.epochs_s().iter().zip(change.scalar_nt) {
            let passed = (TAU * 0.5 * time_s - wt.atan()).sin() / (1.0 + wt * wt).sqrt();
            assert!((change_nt - 20.0 * (passed - (TAU * 0.5 * time_s).sin())).abs() < 1e-5);
        }
    }
}

//! `scalar_lag`: the scalar reading is late, or early, against the fluxgate. `s'(t) = s(t - lag)`.

use super::parts::{real, retimed};
use crate::effects::{Change, CoefficientDependence, Draw, Effect, Kind, Parameter, Search, Spec, Step};
use crate::simulator::signals::Signals;

/// The effect `scalar_lag`.
#[derive(Debug)]
pub struct ScalarLag;

const PARAMETERS: &[Parameter] =
    &[real("lag_s", "s", [-2.0, 2.0], [-0.5, 0.5], Kind::Differentiable(Step::fixed(1e-3)))];

const SPEC: Spec = Spec {
    name: "scalar_lag",
    title: "a delay of the scalar reading",
    what: "the scalar reading is late (or early) against the fluxgate by a fixed time",
    origin: "serial transfer, buffering, or a time stamp at the wrong end of the measurement",
    source: "40 bytes at 115,200 Bd take 3.5 ms; a buffered sample 100 ms",
    model: "`s'(t) = s(t - lag)`",
    parameters: PARAMETERS,
    coefficients: CoefficientDependence::Proportional,
    search: Search::Secant { starts: &[0.01, -0.1, 0.1] },
    family: Some("clock"),
    injectable: true,
    ..Spec::BASE
};

impl Effect for ScalarLag {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn typical(&self, _: &Signals) -> Vec<f64> {
        vec![0.05]
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let lag_s = parameters[0];
        retimed(signals, |_, time_s| time_s - lag_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::sine_signals;
    use std::f64::consts::TAU;

    #[test]
    fn a_late_sine_is_the_sine_of_an_earlier_phase() {
        let signals = sine_signals(20.0, 0.5);
        for lag_s in [-0.3, 0.02, 1.1] {
            let change = ScalarLag.change(&signals, &[lag_s], &mut no_draw());
            for (time_s, change_nt) in signals.epochs_s().iter().zip(change.scalar_nt) {
                let expected_nt = 20.0 * ((TAU * 0.5 * (time_s - lag_s)).sin() - (TAU * 0.5 * time_s).sin());
                assert!((change_nt - expected_nt).abs() < 1e-5, "{lag_s} {time_s}");
            }
        }
    }
}

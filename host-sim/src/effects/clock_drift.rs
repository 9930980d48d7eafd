//! `clock_drift`: the scalar sensor's clock runs at another rate. `s'(t) = s(t - 1e-6 rate t)`.

use super::parts::{real, retimed};
use crate::effects::{Change, CoefficientDependence, Draw, Effect, Kind, Parameter, Search, Spec, Step};
use crate::simulator::signals::Signals;

/// The effect `clock_drift`.
#[derive(Debug)]
pub struct ClockDrift;

const PARAMETERS: &[Parameter] =
    &[real("rate_ppm", "ppm", [-20_000.0, 20_000.0], [-500.0, 500.0], Kind::Differentiable(Step::over_duration(1e3)))];

const SPEC: Spec = Spec {
    name: "clock_drift",
    title: "a drift of the scalar's clock",
    what: "the lag of the scalar reading grows with time",
    origin: "scalar sensor and logger count on two crystals, and nothing aligns them",
    source: "crystals are good to 20 to 100 ppm: 72 ms in an hour at 20 ppm",
    model: "`s'(t) = s(t - 1e-6 rate t)`",
    parameters: PARAMETERS,
    coefficients: CoefficientDependence::Proportional,
    search: Search::Secant { starts: &[10.0, -300.0, 300.0] },
    family: Some("clock"),
    injectable: true,
    ..Spec::BASE
};

impl Effect for ClockDrift {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn typical(&self, _: &Signals) -> Vec<f64> {
        vec![20.0]
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let rate = 1e-6 * parameters[0];
        retimed(signals, |_, time_s| time_s - rate * time_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::sine_signals;
    use std::f64::consts::TAU;

    #[test]
    fn the_frequency_of_a_sine_changes_by_the_rate() {
        let signals = sine_signals(20.0, 0.5);
        let change = ClockDrift.change(&signals, &[700.0], &mut no_draw());
        for (time_s, change_nt) in signals.epochs_s().iter().zip(change.scalar_nt) {
            let slowed = (TAU * 0.5 * (1.0 - 700e-6) * time_s).sin();
            assert!((change_nt - 20.0 * (slowed - (TAU * 0.5 * time_s).sin())).abs() < 1e-5);
        }
    }
}

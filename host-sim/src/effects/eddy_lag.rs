//! `eddy_lag`: eddy currents take time to build up. The eddy part of `A beta` passes a first-order low-pass.

use super::parts::{low_passed, real};
use crate::effects::{Change, CoefficientDependence, Draw, Effect, Kind, Parameter, Search, Spec, Step};
use crate::simulator::signals::Signals;

/// The effect `eddy_lag`.
#[derive(Debug)]
pub struct EddyLag;

const PARAMETERS: &[Parameter] =
    &[real("time_constant_s", "s", [1e-4, 5.0], [0.005, 1.0], Kind::Differentiable(Step::growing(2e-4, 0.02)))];

const SPEC: Spec = Spec {
    name: "eddy_lag",
    title: "slow eddy currents",
    what: "the field of the eddy currents follows the motion with a delay",
    origin: "inductance of thick, well conducting parts; eq. (4) takes them for pure resistance",
    source: "mu0 sigma t a / 3: 4 ms for 3 mm of aluminium of 0.1 m radius, 50 ms and more for thick frames",
    model: "first-order low-pass of the eddy part",
    parameters: PARAMETERS,
    coefficients: CoefficientDependence::Proportional,
    search: Search::Secant { starts: &[0.01, 0.1, 0.5] },
    ..Spec::BASE
};

impl Effect for EddyLag {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn typical(&self, _: &Signals) -> Vec<f64> {
        vec![0.05]
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        low_passed(signals, signals.eddy_nt(), parameters[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::{FIELD_NT, sine_signals};
    use std::f64::consts::TAU;

    #[test]
    fn only_the_eddy_part_is_delayed() {
        let sine = sine_signals(20.0, 0.5);
        let mut coefficients = *sine.coefficients();
        // F e c_x dc_x/dt with c_x = 0.1 sin(wt) is a sine of twice the frequency.
        coefficients[9] = 0.01;
        let change = EddyLag.change(&sine.with_coefficients(coefficients), &[0.1], &mut no_draw());
        let (w, amplitude_nt) = (TAU * 0.5, 0.5 * FIELD_NT * 0.01 * 0.01 * TAU * 0.5);
        let wt = 2.0 * w * 0.1;
        for (time_s, nt) in sine.epochs_s().iter().zip(change.scalar_nt) {
            let passed = (2.0 * w * time_s - wt.atan()).sin() / (1.0 + wt * wt).sqrt();
            assert!((nt - amplitude_nt * (passed - (2.0 * w * time_s).sin())).abs() < 2e-5, "{time_s}");
        }
    }
}

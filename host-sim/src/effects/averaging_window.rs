//! `averaging_window`: the scalar sensor counts over a gate. `s'(t)` = mean of `s` over `[t - window, t]`.

use super::parts::{real, scalar_by_row};
use crate::effects::{Change, CoefficientDependence, Draw, Effect, Kind, Parameter, Search, Spec, Step};
use crate::simulator::signals::{GAUSS_LEGENDRE, Segment, Signals};

/// The effect `averaging_window`.
#[derive(Debug)]
pub struct AveragingWindow;

const PARAMETERS: &[Parameter] =
    &[real("window_s", "s", [0.0, 5.0], [0.0, 1.0], Kind::Differentiable(Step::growing(2e-3, 0.02)))];

const SPEC: Spec = Spec {
    name: "averaging_window",
    title: "an averaging window in the scalar sensor",
    what: "the scalar reading is a mean over a window that ends at its time",
    origin: "a counter's gate, or samples averaged down to 10 Hz, stamped at the end",
    source: "counters with a gate of a whole sample, 100 ms, have their first null at 10 Hz",
    model: "`s'(t)` = mean of `s` over `[t - window, t]`",
    parameters: PARAMETERS,
    coefficients: CoefficientDependence::Proportional,
    search: Search::Secant { starts: &[0.05, 0.5] },
    injectable: true,
    ..Spec::BASE
};

impl Effect for AveragingWindow {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn typical(&self, _: &Signals) -> Vec<f64> {
        vec![0.05]
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let window_s = parameters[0];
        let mut segments = signals.segments().iter();
        let mut segment = segments.next();
        scalar_by_row(signals, |row| {
            while segment.is_some_and(|s| row >= s.epochs.end) {
                segment = segments.next();
            }
            segment.map_or(0.0, |s| mean_nt(signals, s, row, window_s) - signals.scalar_at_rows_nt()[row])
        })
    }
}

/// Mean over the window that ends at a row, by a rule that is exact for polynomials of degree 15.
fn mean_nt(signals: &Signals, segment: &Segment, row: usize, window_s: f64) -> f64 {
    let middle_s = signals.epochs_s()[row] - 0.5 * window_s;
    let value_nt = |node: f64| signals.scalar_at(segment, middle_s + 0.5 * window_s * node);
    GAUSS_LEGENDRE.iter().map(|&(node, weight)| 0.5 * weight * value_nt(node)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::sine_signals;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn a_sine_loses_a_sinc_and_is_late_by_half_the_window() {
        let signals = sine_signals(20.0, 0.7);
        for window_s in [0.1, 0.45, 1.3] {
            let change = AveragingWindow.change(&signals, &[window_s], &mut no_draw());
            let x = PI * 0.7 * window_s;
            for (time_s, change_nt) in signals.epochs_s().iter().zip(change.scalar_nt) {
                let mean_nt = 20.0 * x.sin() / x * (TAU * 0.7 * (time_s - 0.5 * window_s)).sin();
                assert!((change_nt - (mean_nt - 20.0 * (TAU * 0.7 * time_s).sin())).abs() < 1e-5);
            }
        }
    }
}

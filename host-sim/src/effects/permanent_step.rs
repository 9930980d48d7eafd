//! `permanent_step`: the permanent magnetisation jumps. From `time_s` on, `s' = s + p . c`.

use super::parts::{TIME_S, dot, has_begun, linear, middle_s, scalar_by_row};
use crate::effects::{Change, Draw, Effect, HeldOut, Parameter, Search, Spec};
use crate::simulator::signals::Signals;

/// The effect `permanent_step`.
#[derive(Debug)]
pub struct PermanentStep;

const PARAMETERS: &[Parameter] = &[
    TIME_S,
    linear("x_nT", "nT", 100_000.0, 100.0),
    linear("y_nT", "nT", 100_000.0, 100.0),
    linear("z_nT", "nT", 100_000.0, 100.0),
];

const SPEC: Spec = Spec {
    name: "permanent_step",
    title: "a step in the body's magnetisation",
    what: "from one moment on, the body is magnetised differently",
    origin: "a knock, a tool moved, a strong field nearby",
    source: "1 to 100 nT; moving a ferrous pipe is an event in the SGL 2020 flight logs",
    model: "from `time_s` on, `s' = s + p . c`",
    parameters: PARAMETERS,
    search: Search::Onset { sizes: &[] },
    portable: false,
    held_out: HeldOut::MustNotHarm,
    injectable: true,
    ..Spec::BASE
};

impl Effect for PermanentStep {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn typical(&self, signals: &Signals) -> Vec<f64> {
        vec![middle_s(signals), 0.0, 0.0, 0.0]
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let [from_s, x_nt, y_nt, z_nt] = *parameters else { unreachable!("four parameters") };
        let p = [x_nt, y_nt, z_nt];
        scalar_by_row(signals, |row| {
            if has_begun(signals, row, from_s) { dot(p, signals.rows().direction[row]) } else { 0.0 }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::{direction, signals};

    #[test]
    fn it_starts_at_its_time_on_the_axis_of_the_recording() {
        let signals = signals();
        let change = PermanentStep.change(&signals, &[125.0, 3.0, -4.0, 5.0], &mut no_draw());
        for (time_s, nt) in signals.epochs_s().iter().zip(change.scalar_nt) {
            let [x, y, z] = direction(*time_s);
            let expected_nt = if *time_s < 24.99 { 0.0 } else { 3.0 * x - 4.0 * y + 5.0 * z };
            assert!((nt - expected_nt).abs() < 1e-5);
        }
    }
}

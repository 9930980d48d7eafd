//! `permanent_temperature`: magnetisation depends on temperature. `s' = s + (T - T_first) k . c`.

use super::parts::{dot, linear, scalar_by_row, warming_k};
use crate::effects::{Change, Column, Draw, Effect, Parameter, Spec};
use crate::simulator::signals::Signals;

/// The effect `permanent_temperature`.
#[derive(Debug)]
pub struct PermanentTemperature;

const PARAMETERS: &[Parameter] = &[
    linear("x_nT_per_K", "nT/K", 10_000.0, 5.0),
    linear("y_nT_per_K", "nT/K", 10_000.0, 5.0),
    linear("z_nT_per_K", "nT/K", 10_000.0, 5.0),
];

const SPEC: Spec = Spec {
    name: "permanent_temperature",
    title: "a magnetisation that follows temperature",
    what: "the permanent magnetisation of the body changes with its temperature",
    origin: "magnets and steel lose magnetisation as they warm",
    source: "0.1 to 0.5 %/K of magnets: 0.05 to 0.5 nT/K at 100 nT",
    model: "`s' = s + (T - T_first) k . c`; needs `[temperature]`",
    parameters: PARAMETERS,
    needs: Some(Column::Temperature),
    ..Spec::BASE
};

impl Effect for PermanentTemperature {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let k = [parameters[0], parameters[1], parameters[2]];
        scalar_by_row(signals, |row| warming_k(signals, row) * dot(k, signals.rows().direction[row]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::{direction, signals};

    #[test]
    fn it_grows_with_the_warming_since_the_first_row() {
        let signals = signals();
        let change = PermanentTemperature.change(&signals, &[0.3, -0.4, 0.5], &mut no_draw());
        for (time_s, nt) in signals.epochs_s().iter().zip(change.scalar_nt) {
            let [x, y, z] = direction(*time_s);
            assert!((nt - time_s / 60.0 * (0.3 * x - 0.4 * y + 0.5 * z)).abs() < 1e-5);
        }
    }
}

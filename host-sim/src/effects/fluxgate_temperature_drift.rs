//! `fluxgate_temperature_drift`: the fluxgate's offsets depend on temperature. `f' = f + k (T - T_first)`.

use super::parts::{flux_by_row, linear, warming_k};
use crate::effects::{Change, Channel, Column, Draw, Effect, Parameter, Spec};
use crate::simulator::signals::Signals;

/// The effect `fluxgate_temperature_drift`.
#[derive(Debug)]
pub struct FluxgateTemperatureDrift;

const PARAMETERS: &[Parameter] = &[
    linear("x_nT_per_K", "nT/K", 10_000.0, 10.0),
    linear("y_nT_per_K", "nT/K", 10_000.0, 10.0),
    linear("z_nT_per_K", "nT/K", 10_000.0, 10.0),
];

const SPEC: Spec = Spec {
    name: "fluxgate_temperature_drift",
    title: "a temperature drift of the fluxgate",
    what: "the offsets of the fluxgate change with its temperature",
    origin: "core, coil and electronics of the fluxgate",
    source: "0.1 to 1 nT/K of offset in data sheets",
    model: "`f' = f + k (T - T_first)`; needs `[temperature]`",
    parameters: PARAMETERS,
    channel: Channel::Fluxgate,
    needs: Some(Column::Temperature),
    ..Spec::BASE
};

impl Effect for FluxgateTemperatureDrift {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        flux_by_row(signals, |row, _| std::array::from_fn(|i| parameters[i] * warming_k(signals, row)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::signals;

    #[test]
    fn it_grows_with_the_warming_since_the_first_row() {
        let signals = signals();
        let change = FluxgateTemperatureDrift.change(&signals, &[1.0, -2.0, 0.5], &mut no_draw());
        for (change, time_s) in change.flux_nt.iter().zip(signals.epochs_s()) {
            let kelvin = time_s / 60.0;
            assert!((0..3).all(|i| (change[i] - [1.0, -2.0, 0.5][i] * kelvin).abs() < 1e-9));
        }
    }
}

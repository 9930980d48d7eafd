//! `fluxgate_nonlinearity`: the fluxgate's characteristic is curved. `f'_i = f_i (1 + 1e-6 k (f_i / 50000)^2)`.

use super::parts::{flux_by_row, linear};
use crate::effects::{Change, Channel, Draw, Effect, Parameter, Spec};
use crate::simulator::signals::Signals;

/// The effect `fluxgate_nonlinearity`.
#[derive(Debug)]
pub struct FluxgateNonlinearity;

/// Where the cubic part is as large as the parameter says, nT.
const FULL_SCALE_NT: f64 = 50_000.0;

const PARAMETERS: &[Parameter] = &[linear("cubic_ppm", "ppm", 200_000.0, 1000.0)];

const SPEC: Spec = Spec {
    name: "fluxgate_nonlinearity",
    title: "a nonlinearity of the fluxgate",
    what: "each axis of the fluxgate is read too large where the field is large, by a cubic law",
    origin: "loop gain of the sensor and nonlinearity of the converter",
    source: "10 to 100 ppm of integral nonlinearity in data sheets",
    model: "`f'_i = f_i (1 + 1e-6 k (f_i / 50000)^2)`",
    parameters: PARAMETERS,
    channel: Channel::Fluxgate,
    injectable: true,
    ..Spec::BASE
};

impl Effect for FluxgateNonlinearity {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let cubic = 1e-6 * parameters[0];
        flux_by_row(signals, |_, f| f.map(|nt| cubic * nt * (nt / FULL_SCALE_NT) * (nt / FULL_SCALE_NT)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::{signals, signals_of};

    #[test]
    fn at_50_000_nt_it_is_the_parameter() {
        let mut trajectory = signals().trajectory().clone();
        trajectory.field_nt.fill(50_000.0);
        for (c, ppm) in [([0.0, 0.0, 1.0], [0.0, 0.0, 80.0]), ([0.6, -0.8, 0.0], [28.8, 51.2, 0.0])] {
            trajectory.direction.fill(c);
            let signals = signals_of(trajectory.clone());
            let change = FluxgateNonlinearity.change(&signals, &[80.0], &mut no_draw());
            let expected: [f64; 3] = std::array::from_fn(|i| 50_000.0 * c[i] * 1e-6 * ppm[i]);
            assert!(change.flux_nt.iter().all(|nt| (0..3).all(|i| (nt[i] - expected[i]).abs() < 1e-9)));
        }
    }
}

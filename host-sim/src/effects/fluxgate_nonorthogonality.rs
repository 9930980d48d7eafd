//! `fluxgate_nonorthogonality`: the fluxgate axes are not square. `f'_y = f_y + xy f_x`, `f'_z = f_z + xz f_x + yz f_y`.

use super::parts::{flux_by_row, linear};
use crate::effects::{Change, Channel, Draw, Effect, Parameter, Spec};
use crate::simulator::signals::Signals;

/// The effect `fluxgate_nonorthogonality`.
#[derive(Debug)]
pub struct FluxgateNonorthogonality;

const PARAMETERS: &[Parameter] = &[
    linear("xy_mrad", "mrad", 500.0, 20.0),
    linear("xz_mrad", "mrad", 500.0, 20.0),
    linear("yz_mrad", "mrad", 500.0, 20.0),
];

const SPEC: Spec = Spec {
    name: "fluxgate_nonorthogonality",
    title: "skewed axes of the fluxgate",
    what: "the axes of the fluxgate are not at right angles",
    origin: "mounting of the three sensors on their block",
    source: "up to 0.5 degrees (9 mrad) of commercial sensors",
    model: "`f'_y = f_y + xy f_x`, `f'_z = f_z + xz f_x + yz f_y`",
    parameters: PARAMETERS,
    channel: Channel::Fluxgate,
    injectable: true,
    ..Spec::BASE
};

impl Effect for FluxgateNonorthogonality {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let [xy, xz, yz] = [0, 1, 2].map(|index: usize| 1e-3 * parameters[index]);
        flux_by_row(signals, |_, f| [0.0, xy * f[0], xz * f[0] + yz * f[1]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::signals;

    #[test]
    fn the_vector_is_sheared() {
        let signals = signals();
        let change = FluxgateNonorthogonality.change(&signals, &[2.0, -3.0, 5.0], &mut no_draw());
        for (change, f) in change.flux_nt.iter().zip(&signals.rows().flux_nt) {
            let sheared = [f[0], f[1] + 0.002 * f[0], f[2] - 0.003 * f[0] + 0.005 * f[1]];
            assert!((0..3).all(|i| (f[i] + change[i] - sheared[i]).abs() < 1e-9));
        }
    }
}

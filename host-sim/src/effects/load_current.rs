//! `load_current`: the current of a load makes a field that is fixed in the body. `s' = s + I(t) g . c`.
//!
//! `I` is on or off, by period, duty and phase (then `g` is in nT), or a recorded current (then `g` is in nT per ampere).

use super::parts::{dot, linear, nonlinear, scalar_by_row};
use crate::effects::{Change, Channel, Draw, Effect, Kind, Parameter, Spec};
use crate::simulator::signals::Signals;

/// The effect `load_current`.
#[derive(Debug, Default)]
pub struct LoadCurrent {
    /// The load whose recorded current it is: of `current_<load>_A`. `None`: a current that switches by itself.
    pub load: Option<String>,
}

const X: Parameter = linear("x_nT", "nT", 100_000.0, 100.0);
const Y: Parameter = linear("y_nT", "nT", 100_000.0, 100.0);
const Z: Parameter = linear("z_nT", "nT", 100_000.0, 100.0);

const SWITCHED: &[Parameter] = &[
    X,
    Y,
    Z,
    nonlinear("period_s", "s", [0.2, 100_000.0], [0.5, 600.0]),
    nonlinear("duty", "", [0.0, 1.0], [0.02, 0.98]),
    Parameter { name: "phase", unit: "cycles", range: [-1.0, 1.0], plausible: [0.0, 1.0], kind: Kind::Cyclic },
];

const WHAT: &str = "a field fixed in the body that comes and goes with a load's current";
const ORIGIN: &str = "a wire loop of battery, pump, strobe or telemetry";
const SOURCE: &str =
    "a loop of 10 cm^2 at 1 m gives 0.2 nT per ampere, a single wire 200; drones 21 to 574 nT (GI 10, 101)";

const SPEC: Spec = Spec {
    name: "load_current",
    title: "the current of a load",
    what: WHAT,
    origin: ORIGIN,
    source: SOURCE,
    parameters: SWITCHED,
    channel: Channel::Scalar,
    needs: None,
    random: false,
};

const RECORDED: Spec = Spec {
    name: "load_current",
    title: "the current of a load",
    what: WHAT,
    origin: ORIGIN,
    source: SOURCE,
    parameters: &[X, Y, Z],
    channel: Channel::Scalar,
    needs: None,
    random: false,
};

impl Effect for LoadCurrent {
    fn spec(&self) -> &'static Spec {
        if self.load.is_some() { &RECORDED } else { &SPEC }
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let g = [parameters[0], parameters[1], parameters[2]];
        let recorded = self.load.as_deref().and_then(|load| signals.current_a(load));
        scalar_by_row(signals, |row| {
            let current = match (recorded, &self.load) {
                (Some(current_a), _) => current_a[row],
                // A load that the recording does not know draws nothing.
                (None, Some(_)) => 0.0,
                (None, None) => is_on(&parameters[3..], signals.epochs_s()[row]),
            };
            current * dot(g, signals.rows().direction[row])
        })
    }

    fn load(&self) -> Option<&str> {
        self.load.as_deref()
    }
}

/// 1 while the fraction of the cycle is below the duty, else 0.
fn is_on(switching: &[f64], time_s: f64) -> f64 {
    let (period_s, duty, phase) = (switching[0], switching[1], switching[2]);
    let cycles = time_s / period_s + phase;
    f64::from(u8::from(cycles - cycles.floor() < duty))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::{direction, signals};

    #[test]
    fn on_for_its_share_of_each_period() {
        let signals = signals();
        let change = LoadCurrent::default().change(&signals, &[3.0, -4.0, 5.0, 7.05, 0.3, 0.25], &mut no_draw());
        for (time_s, nt) in signals.epochs_s().iter().zip(change.scalar_nt) {
            // A quarter of the first cycle has gone by; it is on during the first 0.3 of each.
            let into_cycle_s = (time_s + 0.25 * 7.05).rem_euclid(7.05);
            let [x, y, z] = direction(*time_s);
            let expected_nt = if into_cycle_s < 0.3 * 7.05 { 3.0 * x - 4.0 * y + 5.0 * z } else { 0.0 };
            assert!((nt - expected_nt).abs() < 1e-5, "{time_s}");
        }
    }

    #[test]
    fn a_recorded_current_drives_it() {
        let signals = signals();
        let strobe = LoadCurrent { load: Some("strobe".into()) };
        let change = strobe.change(&signals, &[3.0, -4.0, 5.0], &mut no_draw());
        for (row, nt) in change.scalar_nt.into_iter().enumerate() {
            let [x, y, z] = direction(signals.epochs_s()[row]);
            let ampere = signals.current_a("strobe").unwrap()[row];
            assert!((nt - ampere * (3.0 * x - 4.0 * y + 5.0 * z)).abs() < 1e-5);
        }
        assert!(strobe.applies_to(&signals));
        assert!(!LoadCurrent { load: Some("pump".into()) }.applies_to(&signals));
    }
}

//! `load_current`: the current of a load makes a field that is fixed in the body. `s' = s + I(t) g . c`.
//!
//! `I` is on or off, by period, duty and phase (then `g` is in nT), or a recorded current (then `g` is in nT per ampere).

use std::sync::Arc;

use super::parts::{dot, linear, real, scalar_by_row};
use crate::effects::{
    Change, Domain, Draw, Driver, Effect, HeldOut, Kind, Parameter, Recorded, RecordedForm, Search, Spec, Step,
};
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

/// Edges are met to parts of a row where there are many of them: so the steps of period, duty and phase.
const EDGE_S: f64 = 0.05;
/// Shortest period, s: two epochs.
const LEAST_PERIOD_S: f64 = 0.2;
/// Parts of a cycle that are told apart.
const SAME_MOMENT: f64 = 1e-9;
/// Where period, duty and phase are.
const PERIOD: usize = 3;
const DUTY: usize = 4;
const PHASE: usize = 5;

/// [`LoadCurrent::discrete_steps`] has the steps, which depend on the period.
const STEPPED: Kind = Kind::Discrete(Step::fixed(EDGE_S));

const SWITCHED: &[Parameter] = &[
    X,
    Y,
    Z,
    real("period_s", "s", [LEAST_PERIOD_S, 100_000.0], [0.5, 600.0], STEPPED),
    real("duty", "", [0.0, 1.0], [0.02, 0.98], STEPPED),
    Parameter { domain: Domain::Cyclic { turn: 1.0 }, ..real("phase", "cycles", [-1.0, 1.0], [0.0, 1.0], STEPPED) },
];

const SPEC: Spec = Spec {
    name: "load_current",
    title: "the current of a load",
    what: "a field fixed in the body that comes and goes with a load's current",
    origin: "a wire loop of battery, pump, strobe or telemetry",
    source: "a loop of 10 cm^2 at 1 m gives 0.2 nT per ampere, a single wire 200; drones 21 to 574 nT (GI 10, 101)",
    model: "`s' = s + on(t) g . c`; or `load` = name of a `[[current]]` in place of `period_s`, `duty`, `phase`: then `g` is in nT per ampere",
    parameters: SWITCHED,
    search: Search::PulseTrain,
    portable: false,
    held_out: HeldOut::MustExplain,
    driver: Some(Driver::Loads),
    injectable: true,
    ..Spec::BASE
};

/// With a recorded current: when it flows is known.
const RECORDED: Spec = Spec { parameters: &[X, Y, Z], search: Search::Linear, ..SPEC };

impl Effect for LoadCurrent {
    fn spec(&self) -> &'static Spec {
        if self.load.is_some() { &RECORDED } else { &SPEC }
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let g = [parameters[0], parameters[1], parameters[2]];
        along(signals, &self.current(signals, parameters), g)
    }

    fn regressors(&self, signals: &Signals, parameters: &[f64]) -> Vec<Change> {
        // When it flows is told once, not for each axis: most of what a search for it costs.
        let current = self.current(signals, parameters);
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| along(signals, &current, axis)).into()
    }

    fn typical(&self, _: &Signals) -> Vec<f64> {
        if self.load.is_some() { vec![0.0; 3] } else { vec![0.0, 0.0, 0.0, 10.0, 0.3, 0.0] }
    }

    /// A step moves an edge by a twentieth of a second, of a period the one that is furthest from the middle.
    fn discrete_steps(&self, parameters: &[f64], duration_s: f64) -> Vec<(usize, f64)> {
        if self.load.is_some() {
            return Vec::new();
        }
        let period_s = parameters[PERIOD];
        vec![(PERIOD, EDGE_S * period_s / duration_s), (PHASE, EDGE_S / period_s), (DUTY, EDGE_S / period_s)]
    }

    /// A period turns about the middle of the recording, or the phase there would change too.
    fn moved(&self, parameters: &[f64], index: usize, by: f64, duration_s: f64) -> Vec<f64> {
        let mut moved = parameters.to_vec();
        moved[index] += by;
        moved[PERIOD] = moved[PERIOD].max(LEAST_PERIOD_S);
        moved[PHASE] += 0.5 * duration_s * (1.0 / parameters[PERIOD] - 1.0 / moved[PERIOD]);
        moved[DUTY] = moved[DUTY].clamp(0.001, 0.999);
        moved[PHASE] = moved[PHASE].rem_euclid(1.0);
        moved
    }

    /// Also phase and duty together: an edge of a pulse moves alone only then.
    fn neighbours(&self, parameters: &[f64], duration_s: f64, scale: f64) -> Vec<Vec<f64>> {
        let steps = self.discrete_steps(parameters, duration_s);
        let [_, (_, phase), (_, duty)] = steps[..] else { return Vec::new() };
        let mut neighbours = Vec::new();
        for sign in [-scale, scale] {
            let moved = |&(index, step): &(usize, f64)| self.moved(parameters, index, sign * step, duration_s);
            neighbours.extend(steps.iter().map(moved));
            let shifted = self.moved(parameters, PHASE, sign * phase, duration_s);
            neighbours.push(self.moved(&shifted, DUTY, sign * duty, duration_s));
        }
        neighbours
    }

    fn fundamental_hz(&self, parameters: &[f64]) -> Option<f64> {
        parameters.get(PERIOD).map(|period_s| 1.0 / period_s)
    }

    fn driven_by(&self, load: &str) -> Option<Arc<dyn Effect>> {
        self.load.is_none().then(|| Arc::new(Self { load: Some(load.into()) }) as Arc<dyn Effect>)
    }

    fn load(&self) -> Option<&str> {
        self.load.as_deref()
    }

    fn recorded(&self) -> Option<Recorded> {
        let of = |load: &String| Recorded {
            column: format!("current_{load}_A"),
            form: RecordedForm::Moment,
            is_asked: false,
        };
        self.load.as_ref().map(of)
    }
}

impl LoadCurrent {
    /// What flows at each row: the recorded current, A, or 1 and 0.
    fn current(&self, signals: &Signals, parameters: &[f64]) -> Vec<f64> {
        match &self.load {
            // A load that the recording does not know draws nothing.
            Some(load) => signals.current_a(load).map_or_else(|| vec![0.0; signals.len()], <[f64]>::to_vec),
            None => signals.epochs_s().iter().map(|&time_s| is_on(&parameters[PERIOD..], time_s)).collect(),
        }
    }
}

/// A field fixed in the body that goes with a current.
fn along(signals: &Signals, current: &[f64], g: [f64; 3]) -> Change {
    scalar_by_row(signals, |row| current[row] * dot(g, signals.rows().direction[row]))
}

/// 1 while the fraction of the cycle is below the duty, else 0.
fn is_on(switching: &[f64], time_s: f64) -> f64 {
    let (period_s, duty, phase) = (switching[0], switching[1], switching[2]);
    let cycles = time_s / period_s + phase;
    // A row at the very moment of switching is on one side of it, whatever the last bits of its time say.
    let moments = ((cycles - whole(cycles)) / SAME_MOMENT + 0.5) as i64 as f64 * SAME_MOMENT;
    f64::from(u8::from(moments - whole(moments) < duty - 0.5 * SAME_MOMENT))
}

/// The largest whole number that is not above a value: a search asks for millions, and `floor` is a call of the C library on
/// processors without an instruction for it.
fn whole(value: f64) -> f64 {
    let towards_zero = value as i64 as f64;
    if towards_zero > value { towards_zero - 1.0 } else { towards_zero }
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
    fn a_row_at_the_moment_of_switching_is_always_on_the_same_side() {
        for phase in [0.0, 0.25, 0.5] {
            let on: Vec<bool> = (0..2000).map(|row| is_on(&[20.0, 0.3, phase], 0.1 * f64::from(row)) > 0.5).collect();
            // 200 rows a cycle, on for 60 of them.
            assert!((0..2000).all(|row| on[row] == ((row + (200.0 * phase) as usize) % 200 < 60)), "{phase}");
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

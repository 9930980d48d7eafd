//! `mains_alias`: a line of the mains, folded into the band. `s' = s + a sin(2 pi f t + phase)`.

use std::f64::consts::{PI, TAU};

use super::parts::{real, scalar_by_row};
use crate::effects::{Change, Domain, Draw, Effect, Kind, Parameter, Search, Spec, Step};
use crate::simulator::signals::Signals;

/// The effect `mains_alias`. Its linear coordinates are the amplitudes of sine and cosine.
#[derive(Debug)]
pub struct MainsAlias;

const PARAMETERS: &[Parameter] = &[
    real("frequency_hz", "Hz", [0.1, 5.0], [0.1, 5.0], Kind::Differentiable(Step::over_duration(0.01))),
    real("amplitude_nT", "nT", [0.0, 10_000.0], [0.01, 10.0], Kind::Derived),
    Parameter {
        domain: Domain::Cyclic { turn: TAU },
        ..real("phase_rad", "rad", [-TAU, TAU], [-PI, PI], Kind::Derived)
    },
];

const SPEC: Spec = Spec {
    name: "mains_alias",
    title: "a steady tone, as of mains",
    what: "a steady tone that depends on nothing else",
    origin: "mains or inverter fields at 16.7, 50 or 60 Hz and their harmonics, sampled at 10 Hz without a filter",
    source: "0.01 to 10 nT near a grid; 16.7 Hz appears at 3.3 Hz",
    model: "`s' = s + a sin(2 pi f t + phase)`",
    parameters: PARAMETERS,
    search: Search::Tone,
    portable: false,
    injectable: true,
    ..Spec::BASE
};

impl Effect for MainsAlias {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let [frequency_hz, amplitude_nt, phase_rad] = *parameters else { unreachable!("three parameters") };
        let at = |row: usize| TAU * frequency_hz * signals.epochs_s()[row] + phase_rad;
        scalar_by_row(signals, |row| amplitude_nt * libm::sin(at(row)))
    }

    fn regressors(&self, signals: &Signals, parameters: &[f64]) -> Vec<Change> {
        let at = |row: usize| TAU * parameters[0] * signals.epochs_s()[row];
        vec![scalar_by_row(signals, |row| libm::sin(at(row))), scalar_by_row(signals, |row| libm::cos(at(row)))]
    }

    fn typical(&self, _: &Signals) -> Vec<f64> {
        vec![1.0, 0.0, 0.0]
    }

    fn fundamental_hz(&self, parameters: &[f64]) -> Option<f64> {
        Some(parameters[0])
    }

    fn from_coordinates(&self, parameters: &[f64], coordinates: &[f64]) -> Vec<f64> {
        let (sine, cosine) = (coordinates[0], coordinates[1]);
        vec![parameters[0], libm::hypot(sine, cosine), libm::atan2(cosine, sine)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::{signals, signals_of, trajectory};

    #[test]
    fn a_tone_of_50_hz_sampled_every_100_3_ms_looks_like_its_alias() {
        // 50 Hz against 1 / 0.1003 s: five turns and 0.015 of one more in each step.
        let mut trajectory = trajectory();
        trajectory.epochs_s = (0..600).map(|k| f64::from(k) * 0.1003).collect();
        let signals = signals_of(trajectory);
        let change = MainsAlias.change(&signals, &[0.015 / 0.1003, 2.0, 0.3], &mut no_draw());
        for (time_s, nt) in signals.epochs_s().iter().zip(change.scalar_nt) {
            assert!((nt - 2.0 * (TAU * 50.0 * time_s + 0.3).sin()).abs() < 1e-6);
        }
    }

    #[test]
    fn the_coordinates_give_amplitude_and_phase() {
        let signals = signals();
        let parameters = [0.7, 1.5, -2.0];
        let direct = MainsAlias.change(&signals, &parameters, &mut no_draw()).scalar_nt;
        let coordinates = [1.5 * (-2.0_f64).cos(), 1.5 * (-2.0_f64).sin()];
        let regressors = MainsAlias.regressors(&signals, &parameters);
        for (row, direct) in direct.into_iter().enumerate() {
            let sum = coordinates[0] * regressors[0].scalar_nt[row] + coordinates[1] * regressors[1].scalar_nt[row];
            assert!((sum - direct).abs() < 1e-9);
        }
        let back = MainsAlias.from_coordinates(&parameters, &coordinates);
        assert!(back.iter().zip(parameters).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}

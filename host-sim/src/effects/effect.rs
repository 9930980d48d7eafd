//! What an unmodelled effect is. Written once: `simulate` switches it on, `diagnose` fits it and asks it for all else.

use std::sync::Arc;

use rand_chacha::ChaCha8Rng;

use super::spec::{Channel, Column, Kind, Parameter, Spec};
use crate::simulator::signals::Signals;

/// The generator of everything random: the same stream for a seed on every platform and release.
pub type Draw = ChaCha8Rng;

/// What an effect adds to the readings, one value a row; empty where it adds nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Change {
    /// To the scalar, nT.
    pub scalar_nt: Vec<f64>,
    /// To the fluxgate, nT.
    pub flux_nt: Vec<[f64; 3]>,
}

/// A recorded column that drives an effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recorded {
    /// Its name.
    pub column: String,
    /// How it adds to the field.
    pub form: RecordedForm,
    /// Whether a user asked for it: then it is tried with any delay.
    pub is_asked: bool,
}

/// How a recorded column adds to the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedForm {
    /// Whatever the attitude: by one linear parameter.
    Additive,
    /// As a moment in body axes: by three linear parameters.
    Moment,
}

/// Readings with noise, one a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Readings {
    /// Scalar, nT.
    pub scalar_nt: Vec<f64>,
    /// Fluxgate in body axes, nT.
    pub flux_nt: Vec<[f64; 3]>,
}

/// An unmodelled effect.
pub trait Effect: std::fmt::Debug + Send + Sync {
    /// What it is.
    fn spec(&self) -> &'static Spec;

    /// What it adds before the sensor noise. `parameters` are in the order of the [`Spec`] and in its units.
    fn change(&self, signals: &Signals, parameters: &[f64], draw: &mut Draw) -> Change;

    /// What it does to readings that have their noise already.
    fn after_noise(&self, _signals: &Signals, _parameters: &[f64], _readings: &mut Readings, _draw: &mut Draw) {}

    /// Variance that it adds to each reading, nT^2, of effects that are random from epoch to epoch.
    fn variance(&self, _signals: &Signals, _parameters: &[f64]) -> Option<Change> {
        None
    }

    /// Changes for a unit of each linear coordinate, the nonlinear parameters held: any change with them is a sum.
    ///
    /// The coordinates are the linear parameters unless an effect says otherwise.
    fn regressors(&self, signals: &Signals, parameters: &[f64]) -> Vec<Change> {
        let linear = self.spec().linear_parameters();
        let unit = |&of: &usize| {
            let mut at = parameters.to_vec();
            linear.iter().for_each(|&index| at[index] = f64::from(u8::from(index == of)));
            self.change(signals, &at, &mut no_draw())
        };
        linear.iter().map(unit).collect()
    }

    /// The parameters that linear coordinates stand for, in the order of [`Self::regressors`].
    #[expect(clippy::wrong_self_convention, reason = "an effect turns its coordinates into its parameters")]
    fn from_coordinates(&self, parameters: &[f64], coordinates: &[f64]) -> Vec<f64> {
        let mut at = parameters.to_vec();
        self.spec().linear_parameters().iter().zip(coordinates).for_each(|(&index, &value)| at[index] = value);
        at
    }

    /// Values at which it is typical on a recording, where a diagnosis has not found its own. The linear ones may be 0.
    fn typical(&self, _signals: &Signals) -> Vec<f64> {
        vec![0.0; self.spec().parameters.len()]
    }

    /// Values that a request may leave out, in the order of the [`Spec`], of an effect that has such.
    fn defaults(&self) -> Option<Vec<f64>> {
        None
    }

    /// The one among equal descriptions that is told, as where an axis and its opposite mean the same.
    fn canonical(&self, parameters: Vec<f64>) -> Vec<f64> {
        parameters
    }

    /// Parameters in which the change is smooth, by index, each with half the width of its difference quotient.
    fn derivative_steps(&self, parameters: &[f64], duration_s: f64) -> Vec<(usize, f64)> {
        let step = |(index, parameter): (usize, &Parameter)| match parameter.kind {
            Kind::Differentiable(step) => Some((index, step.at(parameters[index], duration_s))),
            _ => None,
        };
        self.spec().parameters.iter().enumerate().filter_map(step).collect()
    }

    /// Parameters that must be tried out, by index, each with its smallest useful step.
    fn discrete_steps(&self, parameters: &[f64], duration_s: f64) -> Vec<(usize, f64)> {
        let step = |(index, parameter): (usize, &Parameter)| match parameter.kind {
            Kind::Discrete(step) => Some((index, step.at(parameters[index], duration_s))),
            _ => None,
        };
        self.spec().parameters.iter().enumerate().filter_map(step).collect()
    }

    /// The parameters with a discrete one moved; others may have to follow, so that nothing else changes.
    fn moved(&self, parameters: &[f64], index: usize, by: f64, _duration_s: f64) -> Vec<f64> {
        let mut moved = parameters.to_vec();
        moved[index] += by;
        moved
    }

    /// Points about the parameters in every direction that a search by halved steps must know, `scale` smallest steps
    /// away.
    fn neighbours(&self, parameters: &[f64], duration_s: f64, scale: f64) -> Vec<Vec<f64>> {
        let steps = self.discrete_steps(parameters, duration_s);
        let side = |sign: f64| {
            let moved = |&(index, step): &(usize, f64)| self.moved(parameters, index, sign * step, duration_s);
            steps.iter().map(moved).collect::<Vec<_>>()
        };
        [-scale, scale].into_iter().flat_map(side).collect()
    }

    /// Its fundamental, Hz, of an effect that is periodic in time.
    fn fundamental_hz(&self, _parameters: &[f64]) -> Option<f64> {
        None
    }

    /// The same driven by the recorded current of a load, of an effect that a current drives.
    fn driven_by(&self, _load: &str) -> Option<Arc<dyn Effect>> {
        None
    }

    /// The load whose recorded current drives it, for the effect that may have one.
    fn load(&self) -> Option<&str> {
        None
    }

    /// The recorded column that drives it, of an effect that has one.
    fn recorded(&self) -> Option<Recorded> {
        None
    }

    /// Columns of a recording that it needs, by their names, beside those that every effect may ask for.
    fn columns(&self) -> Vec<&str> {
        Vec::new()
    }

    /// Why it has no meaning on a recording with these `usable` rows that it was expressly asked for, if it has none: at some
    /// values of its parameters, or, without any, wherever it may be looked for.
    fn refusal(&self, _signals: &Signals, _usable: &[bool], _parameters: Option<&[f64]>) -> Option<String> {
        None
    }

    /// Whether a recording holds what it needs.
    fn applies_to(&self, signals: &Signals) -> bool {
        let column = match self.spec().needs {
            None => true,
            Some(Column::Depth) => signals.trajectory().depth_m.is_some(),
            Some(Column::Temperature) => signals.trajectory().temperature_deg_c.is_some(),
        };
        column && self.load().is_none_or(|load| signals.current_a(load).is_some())
    }
}

/// Everything that an effect does to readings without noise: what its size is measured by.
pub fn change_of_clean(effect: &dyn Effect, signals: &Signals, parameters: &[f64], draw: &mut Draw) -> Change {
    let clean = Readings { scalar_nt: signals.scalar_at_rows_nt().to_vec(), flux_nt: signals.rows().flux_nt.clone() };
    let mut readings = clean.clone();
    readings.add(&effect.change(signals, parameters, draw));
    effect.after_noise(signals, parameters, &mut readings, draw);
    let scalar_nt = readings.scalar_nt.iter().zip(&clean.scalar_nt).map(|(with, without)| with - without).collect();
    let flux_nt = readings.flux_nt.iter().zip(&clean.flux_nt).map(|(with, without)| minus(*with, *without)).collect();
    match effect.spec().channel {
        Channel::Scalar => Change::of_scalar(scalar_nt),
        Channel::Fluxgate => Change::of_flux(flux_nt),
    }
}

/// For effects that draw nothing.
pub fn no_draw() -> Draw {
    rand::SeedableRng::seed_from_u64(0)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

impl Change {
    /// Of the scalar alone.
    pub fn of_scalar(scalar_nt: Vec<f64>) -> Self {
        Self { scalar_nt, flux_nt: Vec::new() }
    }

    /// Of the fluxgate alone.
    pub fn of_flux(flux_nt: Vec<[f64; 3]>) -> Self {
        Self { scalar_nt: Vec::new(), flux_nt }
    }

    /// Root mean square over the rows of what it changes: of the scalar, or of the fluxgate vector; nT.
    pub fn rms_nt(&self) -> f64 {
        let squares: Vec<f64> = match self.flux_nt.is_empty() {
            true => self.scalar_nt.iter().map(|x| x * x).collect(),
            false => self.flux_nt.iter().map(|v| v.iter().map(|x| x * x).sum()).collect(),
        };
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    }
}

impl Readings {
    /// Add what an effect adds.
    pub fn add(&mut self, change: &Change) {
        self.scalar_nt.iter_mut().zip(&change.scalar_nt).for_each(|(reading, change)| *reading += change);
        for (reading, change) in self.flux_nt.iter_mut().zip(&change.flux_nt) {
            reading.iter_mut().zip(change).for_each(|(component, change)| *component += change);
        }
    }
}

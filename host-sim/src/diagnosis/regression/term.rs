//! An effect with values, and the columns that it makes of them.

use crate::effects::{Change, Channel, Effect, Library, no_draw};
use crate::simulator::signals::Signals;

/// An effect of the library with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Term {
    /// Which of the library.
    pub(crate) effect: usize,
    /// All parameters; those that coordinates stand for are set by [`Term::parameters`].
    pub(crate) at: Vec<f64>,
    /// Linear coordinates, as many as the effect has signatures.
    pub(crate) coordinates: Vec<f64>,
}

impl Term {
    /// All parameters in the order of the effect's own list.
    pub(crate) fn parameters(&self, library: &Library) -> Vec<f64> {
        let effect = &library[self.effect];
        if self.coordinates.is_empty() { self.at.clone() } else { effect.from_coordinates(&self.at, &self.coordinates) }
    }

    /// What it adds to its channel, nT: to the scalar, or to the magnitude of the fluxgate vector.
    pub(crate) fn column(&self, library: &Library, signals: &Signals) -> Vec<f64> {
        let effect = &library[self.effect];
        let change = effect.change(signals, &self.parameters(library), &mut no_draw());
        match effect.spec().channel {
            Channel::Scalar => along_scalar(change, signals),
            Channel::Fluxgate => magnitude_change(&change, signals),
        }
    }

    /// Columns of its linear coordinates.
    pub(crate) fn regressors(&self, library: &Library, signals: &Signals) -> Vec<Vec<f64>> {
        regressors(&*library[self.effect], signals, &self.at)
    }

    /// Parameters in which the effect is smooth, by index, each with half the width of its difference quotient.
    pub(crate) fn derivative_steps(&self, library: &Library, duration_s: f64) -> Vec<(usize, f64)> {
        library[self.effect].derivative_steps(&self.at, duration_s)
    }

    /// Parameters that must be tried out, by index, each with its smallest useful step.
    pub(crate) fn discrete_steps(&self, library: &Library, duration_s: f64) -> Vec<(usize, f64)> {
        library[self.effect].discrete_steps(&self.at, duration_s)
    }

    /// Name of the effect.
    pub(crate) fn name(&self, library: &Library) -> &'static str {
        library[self.effect].spec().name
    }
}

/// Columns of the linear coordinates of an effect.
pub(crate) fn regressors(effect: &dyn Effect, signals: &Signals, at: &[f64]) -> Vec<Vec<f64>> {
    let changes = effect.regressors(signals, at);
    let channel = effect.spec().channel;
    changes
        .into_iter()
        .map(|change| match channel {
            Channel::Scalar => along_scalar(change, signals),
            Channel::Fluxgate => along_field(&change, signals),
        })
        .collect()
}

fn along_scalar(change: Change, signals: &Signals) -> Vec<f64> {
    if change.scalar_nt.is_empty() { vec![0.0; signals.len()] } else { change.scalar_nt }
}

/// First order of what a change does to the magnitude, nT.
fn along_field(change: &Change, signals: &Signals) -> Vec<f64> {
    let along = |(d, c): (&[f64; 3], &[f64; 3])| d[0] * c[0] + d[1] * c[1] + d[2] * c[2];
    change.flux_nt.iter().zip(&signals.rows().direction).map(along).collect()
}

fn magnitude_change(change: &Change, signals: &Signals) -> Vec<f64> {
    let length = |v: [f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let with = |(d, f): (&[f64; 3], &[f64; 3])| length([d[0] + f[0], d[1] + f[1], d[2] + f[2]]) - length(*f);
    change.flux_nt.iter().zip(&signals.rows().flux_nt).map(with).collect()
}

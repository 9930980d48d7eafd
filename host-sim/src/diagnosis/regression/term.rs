//! An effect with values: what the diagnosis knows of each effect beyond its forward model.

use crate::effects::{Change, Channel, Effect, no_draw};
use crate::simulator::signals::Signals;

/// The library as a diagnosis holds it.
pub(crate) type Library = Vec<Box<dyn Effect>>;

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

/// Parameters that a fit varies smoothly, by index, each with the step of its derivative.
pub(crate) fn differentiable_parameters(name: &str, at: &[f64], duration_s: f64) -> Vec<(usize, f64)> {
    match name {
        "scalar_lag" => vec![(0, 1e-3)],
        "clock_drift" => vec![(0, 1e3 / duration_s.max(60.0))],
        "averaging_window" => vec![(0, 2e-3 + 0.02 * at[0])],
        "scalar_lowpass" | "eddy_lag" => vec![(0, 2e-4 + 0.02 * at[0])],
        "heading_error" => vec![(0, 0.5), (1, 0.5)],
        "mains_alias" => vec![(0, 0.01 / duration_s)],
        _ => Vec::new(),
    }
}

/// Parameters that act at whole rows only, so that a fit must try them out, each with its smallest useful step.
pub(crate) fn discrete_parameters(name: &str, at: &[f64], duration_s: f64) -> Vec<(usize, f64)> {
    match name {
        "sample_slip" | "permanent_step" => vec![(0, 0.1)],
        "load_current" if at.len() == 6 => {
            let period_s = at[3];
            vec![(3, 0.05 * period_s / duration_s), (5, 0.05 / period_s), (4, 0.05 / period_s)]
        }
        _ => Vec::new(),
    }
}

/// Values near those of a term, `scale` smallest steps away in every direction that a search by halves must know: an
/// edge of a pulse moves alone only when phase and duty move together.
pub(crate) fn neighbours(name: &str, at: &[f64], duration_s: f64, scale: f64) -> Vec<Vec<f64>> {
    let steps = discrete_parameters(name, at, duration_s);
    let mut out = Vec::new();
    for sign in [-scale, scale] {
        out.extend(steps.iter().map(|&(index, step)| moved(name, at, index, sign * step, duration_s)));
        if let ("load_current", [_, (phase, step), (duty, _)]) = (name, &steps[..]) {
            let shifted = moved(name, at, *phase, sign * step, duration_s);
            out.push(moved(name, &shifted, *duty, sign * step, duration_s));
        }
    }
    out
}

/// Tried parameters with one of them elsewhere; a period turns about the middle of the recording, or the phase there
/// would change too.
pub(crate) fn moved(name: &str, at: &[f64], index: usize, by: f64, duration_s: f64) -> Vec<f64> {
    let mut other = at.to_vec();
    other[index] += by;
    if name == "load_current" {
        other[3] = other[3].max(LEAST_PERIOD_S);
        other[5] += 0.5 * duration_s * (1.0 / at[3] - 1.0 / other[3]);
        other[4] = other[4].clamp(0.001, 0.999);
        other[5] = other[5].rem_euclid(1.0);
    }
    other
}

/// Shortest period of a load, s: two epochs.
const LEAST_PERIOD_S: f64 = 0.2;

/// Whether its change depends on the 18 coefficients.
pub(crate) fn depends_on_coefficients(name: &str) -> bool {
    is_timing(name) || name == "second_order"
}

/// Whether its change is in proportion to the signals.
pub(crate) fn is_timing(name: &str) -> bool {
    ["scalar_lag", "clock_drift", "sample_slip", "averaging_window", "scalar_lowpass", "eddy_lag"].contains(&name)
}

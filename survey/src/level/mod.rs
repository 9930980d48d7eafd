//! The field at its level: all 18 terms, coefficients that move, and the background as a slow random process.
//!
//! A fixed-interval smoother (f64) over all rows of all recordings of one body: the reading is the background (a random walk
//! whose slope walks too), plus the interference of coefficients that walk, plus noise. No penalty: what a recording tells
//! of the terms through turns and headings fixes the level, and what it does not tell is in the standard deviation.

mod background;
mod kalman;
mod model_search;
mod series;
mod smoother;
mod terms;
mod uncertainty;

use crate::Tow;
pub(crate) use background::slow_part;
use kalman::{Model, Start};
use series::{Onset, Series};
use smoother::{Smoothed, smooth};
use terms::{COMBINATIONS, TERMS, combine, expand};
use uncertainty::{Covariance, KNOT_ROWS, knots};

/// A reading that is so many standard deviations off all others has its variance raised.
const FAR_OFF: f64 = 4.0;
/// Rounds of raising variances, finding moves and fitting the model again.
const ROUNDS: usize = 4;
/// A move must be this likely, as twice the logarithm of the likelihood ratio: 16 coefficients' worth, at any row.
const MOVE_GLRT: f64 = 400.0;
/// Rows between two places where a move is looked for.
const MOVE_EVERY: usize = 10;

/// The field of all recordings, one after another, at its level.
#[derive(Clone, Debug)]
pub struct Level {
    /// Compensated total field, nT; NaN where a row is not usable.
    pub field_nt: Vec<f64>,
    /// Standard deviation of the interference that was taken off, nT, but for one constant of all recordings.
    pub interference_std_nt: Vec<f64>,
    /// Standard deviation of the reading's noise, nT.
    pub noise_std_nt: Vec<f64>,
    /// All 18 terms, nT a coefficient of [`Level::coefficients`]' scale.
    pub terms: Vec<[f64; TERMS]>,
    /// Coefficients in the units of eq. (4), mean over the rows.
    pub coefficients: [f64; TERMS],
    /// Their standard deviations.
    pub coefficient_std: [f64; TERMS],
    /// Rows where the coefficients became others.
    pub moves: Vec<usize>,
    /// Debug.
    pub model: String,
}

/// Level all recordings of one body. `targets_nt` are the fitted anomalies of targets, a row each: they are left in the
/// field, and learnt from nothing.
#[must_use]
pub fn level(tows: &[Tow], targets_nt: &[f64]) -> Level {
    let mut series = Series::of(tows);
    for (sample, target_nt) in series.samples.iter_mut().zip(targets_nt) {
        sample.scalar_nt -= target_nt;
    }
    let start = Start::unknown();
    let (model, smoothed) = fitted(&mut series, &start);
    let covariances = knots(&series.samples, &start, &model);
    read_off(tows, &series, &model, &smoothed, &covariances)
}

fn fitted(series: &mut Series, start: &Start) -> (Model, Vec<Smoothed>) {
    let mut model = model_search::likeliest(&series.samples, start, None);
    for _round in 0..ROUNDS {
        let smoothed = smooth(&series.samples, start, &model, Some(MOVE_EVERY));
        let raised = raise_variances(series, &smoothed);
        let moved = mark_move(series, &smoothed);
        if !moved && raised == 0 {
            return (model, smoothed);
        }
        model = model_search::likeliest(&series.samples, start, if moved { None } else { Some(model) });
    }
    let smoothed = smooth(&series.samples, start, &model, None);
    (model, smoothed)
}

fn raise_variances(series: &mut Series, smoothed: &[Smoothed]) -> usize {
    let mut raised = 0;
    for (sample, smoothed) in series.samples.iter_mut().zip(smoothed) {
        if smoothed.off.abs() > FAR_OFF {
            sample.variance_ratio *= (smoothed.off / (0.5 * FAR_OFF)).powi(2);
            raised += 1;
        }
    }
    raised
}

fn mark_move(series: &mut Series, smoothed: &[Smoothed]) -> bool {
    let best = (0..smoothed.len()).max_by(|&a, &b| smoothed[a].move_glrt.total_cmp(&smoothed[b].move_glrt));
    let Some(row) = best.filter(|&row| smoothed[row].move_glrt > MOVE_GLRT) else { return false };
    if series.samples[row].onset != Onset::Nothing {
        return false;
    }
    series.samples[row].onset = Onset::Move;
    true
}

fn read_off(tows: &[Tow], series: &Series, model: &Model, smoothed: &[Smoothed], covariances: &[Covariance]) -> Level {
    let rows = series.samples.len();
    let scalar: Vec<f64> = tows.iter().flat_map(|tow| tow.scalar_nt.iter().copied()).collect();
    let mut out = Level {
        field_nt: vec![f64::NAN; rows],
        interference_std_nt: vec![f64::NAN; rows],
        noise_std_nt: vec![f64::NAN; rows],
        terms: series.all_terms.clone(),
        coefficients: [0.0; TERMS],
        coefficient_std: [0.0; TERMS],
        moves: (0..rows).filter(|&row| series.samples[row].onset == Onset::Move).collect(),
        model: format!("{model:?}"),
    };
    let _ = (combine(&series.circle), expand(&[0.0; COMBINATIONS]));
    for row in (0..rows).filter(|&row| series.samples[row].variance_ratio.is_finite()) {
        let sample = &series.samples[row];
        let covariance = &covariances[row / KNOT_ROWS];
        let terms = nalgebra::SVector::<f64, COMBINATIONS>::from_column_slice(&sample.terms);
        out.field_nt[row] = scalar[row] - kalman::dot(&smoothed[row].state, &sample.terms);
        out.interference_std_nt[row] = terms.dot(&(covariance * terms)).max(0.0).sqrt();
        out.noise_std_nt[row] = model.noise_nt2.sqrt();
    }
    out
}

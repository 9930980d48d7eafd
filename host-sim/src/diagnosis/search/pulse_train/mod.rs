//! What is switched on and off: period, duty and phase from the residual, folded.

mod folds;
mod periods;
mod residual;

use std::sync::Arc;

use rayon::prelude::*;

use crate::diagnosis::policy::{PULSE_LEAST_ROWS, PULSE_TRIALS_PER_ROW, RATE_HZ};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::Candidate;
use folds::{Fold, best_near, every_duty};
use periods::{OF_EDGES, OF_PULSES, Spectrum};
use residual::DirectedResidual;

/// Periods that are folded with every duty: where little but the edges of a long pulse is left above the background, a
/// few duties miss them.
const REFOLDED: usize = 12;
/// Periods closer than this, as a share, are the same.
const SAME_PERIOD: f64 = 1e-3;
/// How many of the best folds have their edges moved, and the first and last step of that, rows: duties are folded in steps of a
/// tenth of a long period, so that edges may be seconds off; many short periods together tell parts of a row.
const POLISHED: [(usize, [f64; 2]); 3] = [(8, [64.0, 16.0]), (3, [8.0, 1.0]), (1, [0.5, 1.0 / 16.0])];

/// Standard deviation of the noise over that of its prediction error from which it counts as red: AR(1) of 0.75 has 1.5.
const SHARP: f64 = 1.5;

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let mut fitted = fitted_folds(problem, fit, effect);
    if problem.whitening.predictor().gain() > SHARP {
        fitted.extend(found_in_white_noise(problem, fit, effect));
    }
    let (glrt, mut term) = best_polished(problem, fit, fitted, &POLISHED).into_iter().next()?;
    canonical(&mut term);
    let trials_factor = RATE_HZ * problem.duration_s() * PULSE_TRIALS_PER_ROW;
    Some(Candidate { term, glrt, dof: 3.0, trials_factor, variance: None })
}

/// Folds as terms, and what each explains: a fold does not know what 18 terms and background take.
fn fitted_folds(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Vec<(f64, Term)> {
    let fitted = |fold: &Fold| {
        let at = vec![0.0, 0.0, 0.0, fold.period_s, fold.duty, fold.phase];
        let mut term = Term { effect, at, coordinates: vec![0.0; 3] };
        (problem.glrt(&mut term, &fit.projection, &fit.residual_whitened), term)
    };
    best_folds(problem, fit).par_iter().map(fitted).filter(|(_, term)| is_sampled(problem, term)).collect()
}

/// The same, found as if the noise were white. Beside red noise nothing but the edges of a pulse counts, each within a row: folds
/// are too coarse for that, and no step towards it is better than the one before.
fn found_in_white_noise(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Vec<(f64, Term)> {
    let white = problem.whitened_by(&Arc::new(problem.whitening.of_white_noise()));
    let white_fit = white.fit(&fit.terms);
    let found = best_polished(&white, &white_fit, fitted_folds(&white, &white_fit, effect), &POLISHED[..2]);
    let again = |(_, mut term): (f64, Term)| (problem.glrt(&mut term, &fit.projection, &fit.residual_whitened), term);
    found.into_iter().map(again).collect()
}

/// The few best of some terms, their edges moved.
fn best_polished(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    fitted: Vec<(f64, Term)>,
    steps: &[(usize, [f64; 2])],
) -> Vec<(f64, Term)> {
    let mut fitted = fitted;
    for (count, scales) in steps {
        fitted.sort_by(|a, b| b.0.total_cmp(&a.0));
        fitted.truncate(*count);
        fitted = fitted.into_iter().map(|(_, term)| polished(problem, fit, term, *scales)).collect();
    }
    fitted
}

/// Folds over the periods whose harmonics stand out and their multiples, then those whose edges do and the best of the others with
/// every duty.
fn best_folds(problem: &RegressionProblem<'_>, fit: &Fit) -> Vec<Fold> {
    let residual = DirectedResidual::of(problem, fit);
    let spectrum = Spectrum::of(&residual);
    // A long period shows by its harmonics alone, as the background has its fundamental: multiples are tried too.
    let multiples = |period_s: f64| [1.0, 2.0, 3.0].map(|times| times * period_s);
    let periods_s = distinct(spectrum.periods_s(OF_PULSES).into_iter().flat_map(multiples).collect());
    let mut folds: Vec<Fold> =
        periods_s.into_par_iter().flat_map_iter(|period_s| best_near(&residual, period_s)).collect();
    folds.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
    let best_s = distinct(folds.iter().map(|fold| fold.period_s).collect()).into_iter().take(REFOLDED);
    let again_s: Vec<f64> = spectrum.periods_s(OF_EDGES).into_iter().chain(best_s).collect();
    folds.par_extend(again_s.into_par_iter().flat_map_iter(|period_s| every_duty(&residual, period_s)));
    folds
}

/// Periods without those that are the same as one before them.
fn distinct(periods_s: Vec<f64>) -> Vec<f64> {
    let mut distinct: Vec<f64> = Vec::new();
    for period_s in periods_s {
        if !distinct.iter().any(|other| (other / period_s - 1.0).abs() < SAME_PERIOD) {
            distinct.push(period_s);
        }
    }
    distinct
}

/// A load that is on for most of the time is one that is off for the others, with the field the other way round and a
/// constant magnetisation, which the 18 terms have: it is told by the shorter time.
fn canonical(term: &mut Term) {
    if term.at[4] > 0.5 {
        term.at[5] = (term.at[5] - term.at[4]).rem_euclid(1.0);
        term.at[4] = 1.0 - term.at[4];
        term.coordinates.iter_mut().for_each(|value| *value = -*value);
    }
}

/// Whether enough samples are inside pulses, and outside: pulses that fall between nearly all rows would explain anything.
fn is_sampled(problem: &RegressionProblem<'_>, term: &Term) -> bool {
    let duty = term.at[4].min(1.0 - term.at[4]);
    duty * problem.whitening.samples() as f64 >= PULSE_LEAST_ROWS && problem.is_plausible(term)
}

/// The best period, phase and duty near those of a term, everything else held, by steps that are halved from one length
/// to another, rows.
fn polished(problem: &RegressionProblem<'_>, fit: &Fit, term: Term, [first, last]: [f64; 2]) -> (f64, Term) {
    let mut best = term;
    let mut glrt = problem.glrt(&mut best, &fit.projection, &fit.residual_whitened);
    let mut scale = first;
    while scale >= last {
        let tried: Vec<(f64, Term)> = problem.library[best.effect]
            .neighbours(&best.at, problem.duration_s(), scale)
            .into_par_iter()
            .map(|at| {
                let mut other = Term { at, ..best.clone() };
                (problem.glrt(&mut other, &fit.projection, &fit.residual_whitened), other)
            })
            .filter(|(_, other)| is_sampled(problem, other))
            .collect();
        match tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((better, term)) if better > glrt => (glrt, best) = (better, term),
            _ => scale *= 0.5,
        }
    }
    (glrt, best)
}

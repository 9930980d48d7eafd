//! What is switched on and off: period, duty and phase from what is left, folded.

mod folds;

use rayon::prelude::*;

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::Candidate;
use folds::{Fold, Folds, RATE_HZ};

/// Periods that are folded with every duty: of a long one hardly more than its edges is left, and they must be met.
const REFOLDED: usize = 12;
/// Independent pulse trains per row of the recording: with it, half of 130 clean recordings have a best chance below one
/// half.
const TRIALS_PER_ROW: f64 = 2000.0;
/// Folds whose edges are moved, and the steps of that, rows: duties are folded in steps of a tenth of a long period, so
/// that edges may be seconds off; with many short periods, parts of a row tell.
const POLISHED: usize = 8;
const COARSE: [f64; 2] = [64.0, 1.0];
const FINE: [f64; 2] = [1.0, 1.0 / 16.0];
/// Rows in pulses, or between them, at least.
const LEAST_MET: f64 = 20.0;

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let search = Folds::new(problem, fit);
    // A long period shows by its harmonics alone, the background has its fundamental: multiples are tried too.
    let periods_s: Vec<f64> =
        search.periods_s().into_iter().flat_map(|period_s| [1.0, 2.0, 3.0].map(|times| times * period_s)).collect();
    let mut folds: Vec<Fold> =
        distinct(periods_s).into_par_iter().flat_map_iter(|period_s| search.best_near(period_s)).collect();
    folds.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
    let best_s = distinct(folds.iter().map(|fold| fold.period_s).collect());
    folds.par_extend(best_s.into_par_iter().take(REFOLDED).flat_map_iter(|period_s| search.every_duty(period_s)));
    // A fold does not know what 18 terms and background take: each is fitted.
    let mut fitted: Vec<(f64, Term)> = folds
        .par_iter()
        .map(|fold| {
            let at = vec![0.0, 0.0, 0.0, fold.period_s, fold.duty, fold.phase];
            let mut term = Term { effect, at, coordinates: vec![0.0; 3] };
            (problem.glrt(&mut term, &fit.projection, &fit.residual_whitened), term)
        })
        .filter(|(_, term)| is_met(problem, term))
        .collect();
    fitted.sort_by(|a, b| b.0.total_cmp(&a.0));
    let polish = |term, scales| polished(problem, fit, term, scales);
    let polished = fitted.into_iter().take(POLISHED).map(|(_, term)| polish(term, COARSE));
    let (_, term) = polished.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (glrt, mut term) = polish(term, FINE);
    canonical(&mut term);
    let trials_factor = RATE_HZ * problem.duration_s() * TRIALS_PER_ROW;
    Some(Candidate { term, glrt, dof: 3.0, trials_factor, variance: None })
}

/// Periods of which none is as good as another.
fn distinct(periods_s: Vec<f64>) -> Vec<f64> {
    let mut distinct: Vec<f64> = Vec::new();
    for period_s in periods_s {
        if !distinct.iter().any(|other| (other / period_s - 1.0).abs() < 1e-3) {
            distinct.push(period_s);
        }
    }
    distinct
}

/// A load that is on for most of the time is one that is off for the rest, with the field the other way round and a
/// constant magnetisation, which the 18 terms have: the shorter time is told.
fn canonical(term: &mut Term) {
    if term.at[4] > 0.5 {
        term.at[5] = (term.at[5] - term.at[4]).rem_euclid(1.0);
        term.at[4] = 1.0 - term.at[4];
        term.coordinates.iter_mut().for_each(|value| *value = -*value);
    }
}

/// Whether rows meet the pulses: some that fall between nearly all rows would explain anything.
fn is_met(problem: &RegressionProblem<'_>, term: &Term) -> bool {
    let duty = term.at[4].min(1.0 - term.at[4]);
    duty * problem.whitening.samples() as f64 >= LEAST_MET && problem.is_plausible(term)
}

/// Period, phase and duty, everything else held, by steps from one length to another, rows.
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
            .filter(|(_, other)| is_met(problem, other))
            .collect();
        match tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((better, term)) if better > glrt => (glrt, best) = (better, term),
            _ => scale *= 0.5,
        }
    }
    (glrt, best)
}

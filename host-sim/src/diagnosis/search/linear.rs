//! Effects that are linear in all parameters: one least-squares fit.

use crate::diagnosis::regression::problem::{Fit, RegressionProblem, solve};
use crate::diagnosis::regression::term::{Term, regressors};
use crate::diagnosis::search::Candidate;

/// Share of its power that a signature must keep after the sweep to mean anything.
const LEAST_SHARE: f64 = 1e-7;

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let at = vec![0.0; problem.library[effect].spec().parameters.len()];
    let raw = regressors(&*problem.library[effect], &problem.signals, &at);
    let before: f64 = raw.iter().map(|column| norm(&problem.whitening.apply(column))).sum();
    let projected = problem.projected(&raw, &fit.projection);
    let after: f64 = projected.iter().map(|column| norm(column)).sum();
    if after <= LEAST_SHARE * before {
        return None;
    }
    let (glrt, coordinates, rank) = solve(&projected, &fit.residual_whitened);
    Some(Candidate {
        term: Term { effect, at, coordinates },
        glrt,
        dof: rank as f64,
        trials_factor: 1.0,
        variance: None,
    })
}

fn norm(column: &[f64]) -> f64 {
    column.iter().map(|x| x * x).sum()
}

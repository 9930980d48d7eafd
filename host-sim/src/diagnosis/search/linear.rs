//! Effects that are linear in all parameters: one least-squares fit.

use crate::diagnosis::policy::REGRESSOR_LEAST_SHARE;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem, solve};
use crate::diagnosis::regression::term::{Term, regressors};
use crate::diagnosis::search::Candidate;

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let at = vec![0.0; problem.library[effect].spec().parameters.len()];
    let raw = regressors(&*problem.library[effect], &problem.signals, &at);
    let before: f64 = raw.iter().map(|column| power(&problem.whitening.apply(column))).sum();
    let projected = problem.projected(&raw, &fit.projection);
    let after: f64 = projected.iter().map(|column| power(column)).sum();
    if after <= REGRESSOR_LEAST_SHARE * before {
        return None;
    }
    let (glrt, coordinates, rank) = solve(&projected, &fit.residual_whitened);
    let term = Term { effect, at, coordinates };
    Some(Candidate { term, glrt, dof: rank as f64, trials_factor: 1.0, variance: None })
}

/// Sum of squares, in order.
fn power(column: &[f64]) -> f64 {
    column.iter().map(|x| x * x).sum()
}

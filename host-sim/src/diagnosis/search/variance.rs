//! Effects that are random from epoch to epoch: they show in the variance of what is left.

use super::Candidate;
use crate::diagnosis::noise::variance::{VarianceFit, fit_variance, innovation_variance, scale, squares};
use crate::diagnosis::policy::{TRIALS_PER_VARIANCE, VARIANCE_LEAST_GROWTH};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;

/// The point at which the residual's variance follows the effect's best, with the size fitted. `last` is what was found
/// before, with another noise model.
pub(super) fn scan(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    effect: usize,
    starts: &[&[f64]],
    last: Option<&Candidate>,
) -> Option<Candidate> {
    let squares = squares(&fit.residual_whitened, last.and_then(Candidate::growth));
    let found = starts.iter().filter_map(|start| at_point(problem, &squares, effect, start));
    let best = found.max_by(|a, b| a.glrt.total_cmp(&b.glrt))?;
    Some(Candidate { trials_factor: TRIALS_PER_VARIANCE * starts.len() as f64, ..best })
}

/// With the size fitted that is the first parameter.
fn at_point(problem: &RegressionProblem<'_>, squares: &[f64], effect: usize, point: &[f64]) -> Option<Candidate> {
    let change = problem.library[effect].variance(&problem.signals, point)?;
    let v = innovation_variance(&problem.whitening, &change.scalar_nt);
    let added = fit_variance(squares, &v);
    let mut at = point.to_vec();
    at[0] = (added.kappa * scale(squares, &v, added.kappa)).sqrt();
    let variance = VarianceFit::new(&v, &added);
    if upper_twentieth(&variance.growth) < 1.0 + VARIANCE_LEAST_GROWTH {
        return None;
    }
    let term = Term { effect, at, coordinates: Vec::new() };
    Some(Candidate { term, glrt: added.glrt, dof: 1.0, trials_factor: TRIALS_PER_VARIANCE, variance: Some(variance) })
}

fn upper_twentieth(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let at = (sorted.len() - 1) * 19 / 20;
    *sorted.select_nth_unstable_by(at, f64::total_cmp).1
}

//! Effects that are random from epoch to epoch: they show in the variance of the residual.

use super::Candidate;
use crate::diagnosis::noise::variance::{VarianceFit, fit_variance, innovation_variance, scale, squares};
use crate::diagnosis::policy::{JITTER_TRIALS, VARIANCE_LEAST_GROWTH};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;

/// `sample_jitter`: variance in proportion to the squared slope of the signal. `last` is what was found before.
pub(crate) fn scan_jitter(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    effect: usize,
    last: Option<&Candidate>,
) -> Option<Candidate> {
    let change = problem.library[effect].variance(&problem.signals, &[1.0])?;
    let v = innovation_variance(&problem.whitening, &change.scalar_nt);
    let squares = squares(&fit.residual_whitened, last.and_then(Candidate::growth));
    let added = fit_variance(&squares, &v);
    let variance = VarianceFit::new(&v, &added);
    if upper_twentieth(&variance.growth) < 1.0 + VARIANCE_LEAST_GROWTH {
        return None;
    }
    let sigma_s = (added.kappa * scale(&squares, &v, added.kappa)).sqrt();
    let term = Term { effect, at: vec![sigma_s], coordinates: Vec::new() };
    Some(Candidate { term, glrt: added.glrt, dof: 1.0, trials_factor: JITTER_TRIALS, variance: Some(variance) })
}

/// The value that a twentieth of them are above.
fn upper_twentieth(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let at = (sorted.len() - 1) * 19 / 20;
    *sorted.select_nth_unstable_by(at, f64::total_cmp).1
}

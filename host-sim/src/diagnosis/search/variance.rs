//! Effects that are random from epoch to epoch: they show in the variance of what is left.

use super::Candidate;
use crate::diagnosis::noise::variance::{VarianceFit, fit_variance, innovation_variance, scale, squares};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;

/// Growth of the variance that a noise model may miss by itself, where it grows most.
pub(crate) const LEAST_GROWTH: f64 = 0.25;

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
    let (glrt, kappa, curvature) = fit_variance(&squares, &v);
    let sigma_s = (kappa * scale(&squares, &v, kappa)).sqrt();
    let term = Term { effect, at: vec![sigma_s], coordinates: Vec::new() };
    let variance = VarianceFit::new(&v, kappa, curvature);
    if most_of(&variance.growth) < 1.0 + LEAST_GROWTH {
        return None;
    }
    Some(Candidate { term, glrt, dof: 1.0, trials_factor: 2.0, variance: Some(variance) })
}

/// What a twentieth of the values is above.
fn most_of(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let at = (sorted.len() - 1) * 19 / 20;
    *sorted.select_nth_unstable_by(at, f64::total_cmp).1
}

//! Any nonlinear effect: some points of its parameters are tried, and the best one is left to the joint fit.

use rayon::prelude::*;

use super::Candidate;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;

/// The point that explains most, its linear coordinates fitted.
pub(super) fn scan(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    effect: usize,
    starts: &'static [&'static [f64]],
) -> Option<Candidate> {
    let at = |start: &&[f64]| {
        let mut term = Term { effect, at: start.to_vec(), coordinates: Vec::new() };
        let glrt = problem.glrt(&mut term, &fit.projection, &fit.residual_whitened);
        (glrt, term)
    };
    let (glrt, term) = starts.par_iter().map(at).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let nonlinear = term.derivative_steps(problem.library, problem.duration_s()).len();
    let dof = (nonlinear + term.coordinates.len()).max(1) as f64;
    Some(Candidate { term, glrt, dof, trials_factor: starts.len() as f64, variance: None })
}

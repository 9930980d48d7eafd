//! Effects of one parameter that the signal answers to almost in proportion: secant steps from several starts.

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::Candidate;

/// Steps from each start.
const STEPS: usize = 4;

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize, starts: &[f64]) -> Option<Candidate> {
    let spec = problem.library[effect].spec();
    let [low, high] = spec.parameters[0].plausible;
    let mut best = (0.0, 0.0);
    for &start in starts {
        let mut value = start;
        for _ in 0..STEPS {
            let term = Term { effect, at: vec![value], coordinates: Vec::new() };
            let mut column = problem.whitening.apply(&term.column(problem.library, &problem.signals));
            fit.projection.project_out(&mut column);
            let (along, own) = (dot(&column, &fit.residual_whitened), dot(&column, &column));
            // The coefficients give way once it is fitted with them, so the size counts less than the shape.
            let glrt = if along > 0.0 && own > 0.0 { along * along / own } else { 0.0 };
            if glrt > best.0 {
                best = (glrt, value);
            }
            if own <= 0.0 {
                break;
            }
            let ratio = along / own;
            let next = if low < 0.0 { value * ratio } else { value * ratio.max(0.25) };
            let next = next.clamp(-4.0 * value.abs(), 4.0 * value.abs()).clamp(low.min(0.0), high);
            if (next - value).abs() < 1e-3 * value.abs() || next == 0.0 {
                break;
            }
            value = next;
        }
    }
    let term = Term { effect, at: vec![best.1], coordinates: Vec::new() };
    Some(Candidate { term, glrt: best.0, dof: 1.0, trials_factor: if low < 0.0 { 1.0 } else { 2.0 }, variance: None })
}

//! Joint fits: Gauss and Newton's steps, halved where they went too far.

use std::sync::Arc;

use rayon::prelude::*;

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::regression::term::Term;

/// Iterations of a joint fit.
const ITERATIONS: usize = 8;
/// A fit has converged when a step promises less than this of the sum of squares.
const CONVERGED: f64 = 0.02;

impl RegressionProblem<'_> {
    /// Fit jointly, from the values that the terms have. Parameters that must be tried out stay as they are.
    pub(crate) fn fit(&self, terms: &[Term]) -> Fit {
        let mut terms = terms.to_vec();
        let mut signals = Arc::clone(&self.signals);
        let mut coefficients = self.fitted_of(&signals);
        let mut sensitivity: Option<Vec<Vec<f64>>> = None;
        let mut best: Option<(f64, Vec<Term>, Vec<f64>)> = None;
        let mut step = 1.0;
        let mut result: Option<(f64, Fit)> = None;
        for iteration in 0..ITERATIONS {
            let columns: Vec<Vec<f64>> = terms.par_iter().map(|term| term.column(self.library, &signals)).collect();
            let residual = self.whitening.apply(&self.residual(&coefficients, &columns));
            let sse = dot(&residual, &residual);
            if let Some((before, terms_before, coefficients_before)) = &best
                && sse > *before * (1.0 + 1e-9) + 1e-6
                && step > 0.05
                && iteration + 1 < ITERATIONS
            {
                // Too far: half the way back.
                let back = |new: &mut f64, old: f64| *new = old + 0.5 * (*new - old);
                for (term, old) in terms.iter_mut().zip(terms_before) {
                    term.at.iter_mut().zip(&old.at).for_each(|(new, &old)| back(new, old));
                    term.coordinates.iter_mut().zip(&old.coordinates).for_each(|(new, &old)| back(new, old));
                }
                coefficients.iter_mut().zip(coefficients_before).for_each(|(new, &old)| back(new, old));
                signals = self.signals_with(&coefficients);
                step *= 0.5;
                continue;
            }
            best = Some((sse, terms.clone(), coefficients.clone()));
            if sensitivity.is_none() || iteration <= 2 {
                sensitivity = Some(self.sensitivity(&terms, &signals, &coefficients));
            }
            let (projection, first_column) =
                self.projection_of(&terms, &signals, sensitivity.as_deref().unwrap_or(&[]));
            let change = projection.solve(&residual);
            let mut residual_whitened = residual;
            projection.project_out(&mut residual_whitened);
            let promised = sse - dot(&residual_whitened, &residual_whitened);
            let fit = Fit {
                terms: terms.clone(),
                coefficients: coefficients.clone(),
                columns,
                projection,
                first_column,
                residual_whitened,
            };
            if terms.is_empty() {
                let fitted = coefficients.iter().zip(&change).map(|(c, d)| c + d).collect();
                return Fit { coefficients: fitted, ..fit };
            }
            let converged = promised < CONVERGED && iteration > 0;
            // A fit that runs away is known by what it leaves, not by what its linearisation promises.
            if result.as_ref().is_none_or(|(best, _)| sse <= *best) {
                result = Some((sse, fit));
            }
            if converged {
                break;
            }
            step = 1.0;
            self.advance(&mut terms, &mut coefficients, &change);
            signals = self.signals_with(&coefficients);
        }
        let (sse, fit) = result.expect("at least one iteration");
        self.unless_run_away(sse, fit)
    }

    /// A fit that leaves far more than its linearisation says did not converge: what it leaves is what counts.
    fn unless_run_away(&self, sse: f64, fit: Fit) -> Fit {
        if sse <= 1.02 * fit.sse() + 20.0 {
            return fit;
        }
        let residual_whitened = self.whitening.apply(&self.residual(&fit.coefficients, &fit.columns));
        Fit { residual_whitened, ..fit }
    }

    fn advance(&self, terms: &mut [Term], coefficients: &mut [f64], change: &[f64]) {
        let mut at = coefficients.len();
        coefficients.iter_mut().zip(change).for_each(|(c, d)| *c += d);
        for term in terms {
            let spec = self.library[term.effect].spec();
            for coordinate in &mut term.coordinates {
                *coordinate += change[at];
                at += 1;
            }
            for (index, _) in term.derivative_steps(self.library, self.duration_s()) {
                let [low, high] = spec.parameters[index].range;
                let furthest = 0.25 * (spec.parameters[index].plausible[1] - spec.parameters[index].plausible[0]);
                term.at[index] = (term.at[index] + change[at].clamp(-furthest, furthest)).clamp(low, high);
                at += 1;
            }
        }
    }
}

//! Joint fits: Gauss and Newton's steps, halved where they went too far.

use std::sync::Arc;

use rayon::prelude::*;

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::regression::term::Term;
use crate::simulator::signals::Signals;

/// Iterations of a joint fit.
const ITERATIONS: usize = 8;
/// A fit has converged when a step promises less than this of the sum of squares.
const CONVERGED: f64 = 0.02;

/// Smallest part of a step that is still halved.
const SMALLEST_STEP: f64 = 0.05;
/// Iterations after which the dependence on the coefficients is not computed anew.
const SENSITIVE_ITERATIONS: usize = 2;

/// Values of everything that is fitted, and the signals that they give.
#[derive(Clone)]
struct Point {
    terms: Vec<Term>,
    coefficients: Vec<f64>,
    signals: Arc<Signals>,
}

/// Whether a sum of squares is larger than another by more than rounding.
fn is_worse(sse: f64, before: f64) -> bool {
    sse > before * (1.0 + 1e-9) + 1e-6
}

impl RegressionProblem<'_> {
    /// Fit jointly, from the values that the terms have. Parameters that must be tried out stay as they are.
    pub(crate) fn fit(&self, terms: &[Term]) -> Fit {
        let signals = Arc::clone(&self.signals);
        let mut point = Point { terms: terms.to_vec(), coefficients: self.fitted_of(&signals), signals };
        let mut last: Option<(f64, Point)> = None;
        let mut best: Option<(f64, Fit)> = None;
        let (mut step, mut sensitivity) = (1.0, Vec::new());
        for iteration in 0..ITERATIONS {
            let (columns, residual) = self.columns_and_residual(&point);
            let sse = dot(&residual, &residual);
            let may_halve = step > SMALLEST_STEP && iteration + 1 < ITERATIONS;
            if let Some((_, before)) = last.as_ref().filter(|(before, _)| may_halve && is_worse(sse, *before)) {
                (point, step) = (self.halfway(&point, before), 0.5 * step);
                continue;
            }
            last = Some((sse, point.clone()));
            if iteration <= SENSITIVE_ITERATIONS {
                sensitivity = self.sensitivity(&point.terms, &point.signals, &point.coefficients);
            }
            let (fit, change) = self.linear_fit(&point, columns, residual, &sensitivity);
            if terms.is_empty() {
                let coefficients = point.coefficients.iter().zip(&change).map(|(c, by)| c + by).collect();
                return Fit { coefficients, ..fit };
            }
            let has_converged = sse - fit.sse() < CONVERGED && iteration > 0;
            // A fit that runs away is known by the residual that it leaves, not by the one that its linearisation promises.
            if best.as_ref().is_none_or(|(best, _)| sse <= *best) {
                best = Some((sse, fit));
            }
            if has_converged {
                break;
            }
            (point, step) = (self.advanced(&point, &change), 1.0);
        }
        let (sse, fit) = best.expect("at least one iteration");
        self.unless_run_away(sse, fit)
    }

    /// What each term adds at a point, one a row, nT, and the whitened residual there.
    fn columns_and_residual(&self, point: &Point) -> (Vec<Vec<f64>>, Vec<f64>) {
        let column = |term: &Term| term.column(self.library, &point.signals);
        let columns: Vec<Vec<f64>> = point.terms.par_iter().map(column).collect();
        let residual = self.whitening.apply(&self.residual(&point.coefficients, &columns));
        (columns, residual)
    }

    /// The least-squares step from a point, and the fit that it promises. What of the coefficients these columns do not tell is taken off:
    /// with other noise, or before an effect was known, they may have told it, and of one heading the level of all induced ones comes at
    /// ten times the field.
    fn linear_fit(
        &self,
        point: &Point,
        columns: Vec<Vec<f64>>,
        mut residual: Vec<f64>,
        sensitivity: &[Vec<f64>],
    ) -> (Fit, Vec<f64>) {
        let (projection, first_column) = self.projection_of(&point.terms, &point.signals, sensitivity);
        let told = projection.told(&point.coefficients);
        let untold: Vec<f64> = point.coefficients.iter().zip(told).map(|(all, told)| all - told).collect();
        let untold_nt = self.of_coefficients(&untold, sensitivity);
        residual.iter_mut().zip(self.whitening.apply(&untold_nt)).for_each(|(residual, nt)| *residual += nt);
        let mut change = projection.solve(&residual);
        change.iter_mut().zip(&untold).for_each(|(change, untold)| *change -= untold);
        let mut residual_whitened = residual;
        projection.project_out(&mut residual_whitened);
        let Point { terms, coefficients, .. } = point.clone();
        (Fit { terms, coefficients, columns, projection, first_column, residual_whitened }, change)
    }

    /// What some coefficients make of the refitted columns and of what the terms add, one a row, nT.
    pub(super) fn of_coefficients(&self, coefficients: &[f64], sensitivity: &[Vec<f64>]) -> Vec<f64> {
        let mut sum_nt = vec![0.0; self.signals.len()];
        let both = [&self.nuisance_columns[..], sensitivity];
        for (column, coefficient) in both.into_iter().flat_map(|columns| columns.iter().zip(coefficients)) {
            sum_nt.iter_mut().zip(column).for_each(|(sum, x)| *sum += coefficient * x);
        }
        sum_nt
    }

    /// Half the way back, where a step went too far.
    fn halfway(&self, point: &Point, before: &Point) -> Point {
        let mut half = point.clone();
        let back = |new: &mut f64, old: f64| *new = old + 0.5 * (*new - old);
        for (term, old) in half.terms.iter_mut().zip(&before.terms) {
            term.at.iter_mut().zip(&old.at).for_each(|(new, &old)| back(new, old));
            term.coordinates.iter_mut().zip(&old.coordinates).for_each(|(new, &old)| back(new, old));
        }
        half.coefficients.iter_mut().zip(&before.coefficients).for_each(|(new, &old)| back(new, old));
        Point { signals: self.signals_with(&half.coefficients), ..half }
    }

    /// A fit that leaves far more than its linearisation says did not converge: what it leaves is what counts.
    fn unless_run_away(&self, sse: f64, fit: Fit) -> Fit {
        if sse <= 1.02 * fit.sse() + 20.0 {
            return fit;
        }
        let residual_whitened = self.whitening.apply(&self.residual(&fit.coefficients, &fit.columns));
        Fit { residual_whitened, ..fit }
    }

    /// A whole step from a point; no parameter leaves its range, or moves by more than a quarter of what is plausible.
    fn advanced(&self, point: &Point, change: &[f64]) -> Point {
        let Point { mut terms, mut coefficients, .. } = point.clone();
        let mut change = change.iter().copied();
        coefficients.iter_mut().zip(&mut change).for_each(|(coefficient, by)| *coefficient += by);
        for term in &mut terms {
            let steps = term.derivative_steps(self.library, self.duration_s());
            term.coordinates.iter_mut().zip(&mut change).for_each(|(coordinate, by)| *coordinate += by);
            for ((index, _), by) in steps.into_iter().zip(&mut change) {
                let parameter = &self.library[term.effect].spec().parameters[index];
                let [low, high] = parameter.range;
                let furthest = 0.25 * (parameter.plausible[1] - parameter.plausible[0]);
                term.at[index] = (term.at[index] + by.clamp(-furthest, furthest)).clamp(low, high);
            }
        }
        Point { signals: self.signals_with(&coefficients), terms, coefficients }
    }
}

#[cfg(test)]
mod tests {
    use towmag::model::TERMS;

    use crate::diagnosis::diagnose::simulated::{in_white_noise, recorded};
    use crate::diagnosis::recording::Recording;
    use crate::effects::Library;

    #[test]
    fn what_the_columns_do_not_tell_of_the_coefficients_is_not_kept() {
        let table = recorded("lake_tow.toml");
        let recording = Recording::of(&table, [0.0; TERMS]);
        let library = Library::default();
        let problem = in_white_noise(&recording, &library);
        let fit = problem.fit(&[]);
        // The three induced ones along the axes make a constant of any size, and little else.
        let mut level = fit.clone();
        [3, 6, 8].into_iter().for_each(|k| level.coefficients[k] += 500_000.0);
        let again = problem.linearised_at(&level).fit(&[]);
        assert!((again.sse() / fit.sse() - 1.0).abs() < 1e-6, "{} and {}", again.sse(), fit.sse());
        let off_nt = fit.coefficients.iter().zip(&again.coefficients).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off_nt < 1e-3, "{off_nt}");
    }
}

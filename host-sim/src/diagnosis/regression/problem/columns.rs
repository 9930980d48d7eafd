//! Columns of a fit: what each parameter does, and how the 18 terms change with it.

use nalgebra::DMatrix;
use rayon::prelude::*;
use towmag::model::TERMS;

use crate::diagnosis::once::made_once;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::Projection;
use crate::diagnosis::regression::term::Term;
use crate::effects::CoefficientDependence;
use crate::simulator::signals::Signals;

impl RegressionProblem<'_> {
    /// The directions of everything in a fit but one term.
    pub(crate) fn fit_held(&self, fit: &Fit, index: usize) -> Projection {
        let sensitivity = self.sensitivity(&fit.terms, &self.signals, &fit.coefficients);
        self.projection_of(&fit.others(index), &self.signals, &sensitivity).0
    }

    /// Columns of the parameters of a term, at a fit.
    pub(crate) fn own_columns(&self, fit: &Fit, index: usize) -> Vec<Vec<f64>> {
        let term = &fit.terms[index];
        let mut columns = term.regressors(self.library, &self.signals);
        columns.extend(self.derivatives(term, &self.signals));
        columns
    }

    /// Refitted columns as the terms make them, then the columns of each term.
    pub(crate) fn projection_of(
        &self,
        terms: &[Term],
        signals: &Signals,
        sensitivity: &[Vec<f64>],
    ) -> (Projection, Vec<usize>) {
        let mut raw: Vec<Vec<f64>> = self.nuisance_columns.to_vec();
        for (column, more) in raw.iter_mut().zip(sensitivity) {
            column.iter_mut().zip(more).for_each(|(x, d)| *x += d);
        }
        let mut first = Vec::with_capacity(terms.len());
        for term in terms {
            first.push(raw.len());
            raw.extend(term.regressors(self.library, signals));
            raw.extend(self.derivatives(term, signals));
        }
        let whitened: Vec<Vec<f64>> = raw.par_iter().map(|column| self.whitening.apply(column)).collect();
        (Projection::of(&whitened), first)
    }

    /// Derivatives by the smooth parameters of a term.
    fn derivatives(&self, term: &Term, signals: &Signals) -> Vec<Vec<f64>> {
        let parameters = self.library[term.effect].spec().parameters;
        term.derivative_steps(self.library, self.duration_s())
            .into_iter()
            .map(|(index, step)| {
                let shifted = |by: f64| {
                    let mut other = term.clone();
                    let [low, high] = parameters[index].range;
                    other.at[index] = (other.at[index] + by).clamp(low, high);
                    (other.at[index], other.column(self.library, signals))
                };
                let ((to, above), (from, below)) = (shifted(step), shifted(-step));
                let width = (to - from).max(f64::MIN_POSITIVE);
                above.iter().zip(&below).map(|(a, b)| (a - b) / width).collect()
            })
            .collect()
    }

    /// How what the terms add depends on each refitted coefficient, all terms together; empty when it does not.
    pub(crate) fn sensitivity(&self, terms: &[Term], signals: &Signals, coefficients: &[f64]) -> Vec<Vec<f64>> {
        let of = |wanted: CoefficientDependence| -> Vec<&Term> {
            terms.iter().filter(|term| self.library[term.effect].spec().coefficients == wanted).collect()
        };
        let proportional = of(CoefficientDependence::Proportional);
        let nonlinear = of(CoefficientDependence::Nonlinear);
        if self.nuisance_columns.is_empty() || (proportional.is_empty() && nonlinear.is_empty()) {
            return Vec::new();
        }
        let mut sums = vec![vec![0.0; signals.len()]; self.nuisance_columns.len()];
        if !proportional.is_empty() {
            let (none, each) = self.units();
            let base: Vec<Vec<f64>> = proportional.iter().map(|term| term.column(self.library, none)).collect();
            sums.par_iter_mut().zip(each).for_each(|(sum, unit)| {
                for (term, base) in proportional.iter().zip(&base) {
                    let column = term.column(self.library, unit);
                    sum.iter_mut().zip(column.iter().zip(base)).for_each(|(s, (x, b))| *s += x - b);
                }
            });
        }
        for term in nonlinear {
            let base = term.column(self.library, signals);
            sums.par_iter_mut().enumerate().for_each(|(k, sum)| {
                let mut other = coefficients.to_vec();
                other[k] += 1.0;
                let column = term.column(self.library, &self.signals_with(&other));
                sum.iter_mut().zip(column.iter().zip(&base)).for_each(|(s, (x, b))| *s += x - b);
            });
        }
        sums
    }

    fn units(&self) -> (&Signals, &[Signals]) {
        let unit = |k: usize| {
            let mut fitted = vec![0.0; TERMS];
            fitted[k] = 1.0;
            self.signals.with_coefficients(self.eq4(&fitted))
        };
        let all = || (0..TERMS).into_par_iter().map(unit).collect();
        let (none, each) = made_once(&self.units, || (self.signals.with_coefficients([0.0; TERMS]), all()));
        (none, each)
    }

    /// Of the covariance of all columns that of the parameters of a term as fitted: coordinates, then smooth ones.
    pub(crate) fn own_covariance(&self, covariance: &DMatrix<f64>, fit: &Fit, index: usize) -> DMatrix<f64> {
        let first = fit.first_column[index];
        let term = &fit.terms[index];
        let count = term.coordinates.len() + term.derivative_steps(self.library, self.duration_s()).len();
        covariance.view((first, first), (count, count)).into_owned()
    }
}

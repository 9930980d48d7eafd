//! What was fitted to a sensor before a dipole was known, the 18 terms or the fluxgate's own errors: it may hold a part of the
//! dipole, most of it where that is met on a heading of its own.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::regression::products::{dot, gram_of, norm};
use crate::diagnosis::regression::projection::explained;

/// Added to each squared length, so that columns that say the same do no harm.
const RIDGE: f64 = 1e-9;

/// The fitted columns, each of length 1 once whitened.
pub(super) struct Nuisance {
    /// One value a row, nT.
    columns_nt: Vec<Vec<f64>>,
    /// One value a sample.
    whitened: Vec<Vec<f64>>,
    /// Whether they were fitted to a sample.
    is_fitted: Vec<bool>,
    /// Their products over the samples that they were fitted to.
    gram: DMatrix<f64>,
}

/// A dipole's columns where it is, one value for each of some samples.
pub(super) struct Local {
    /// Which samples, ascending.
    pub(super) samples: Vec<usize>,
    pub(super) columns: Vec<Vec<f64>>,
}

/// Columns held against a residual, all that was fitted before free to change.
pub(super) struct Beside {
    /// Products of the columns, and with the residual, without what the fitted ones take of them.
    pub(super) gram: DMatrix<f64>,
    pub(super) along: DVector<f64>,
    fitted: Cholesky<f64, Dyn>,
    fitted_along: DVector<f64>,
    mixed: DMatrix<f64>,
}

impl Nuisance {
    /// Columns, one value a row, fitted to the rows that `is_fitted` says.
    pub(super) fn of(columns_nt: &[Vec<f64>], whitening: &Whitening, is_fitted: &[bool]) -> Self {
        let is_fitted: Vec<bool> = whitening.rows().map(|row| is_fitted[row]).collect();
        let whitened: Vec<Vec<f64>> = columns_nt.iter().map(|column| whitening.apply(column)).collect();
        let lengths: Vec<f64> = whitened.iter().map(|column| norm(column).max(f64::MIN_POSITIVE)).collect();
        let unit = |columns: &[Vec<f64>]| -> Vec<Vec<f64>> {
            columns.iter().zip(&lengths).map(|(column, length)| column.iter().map(|x| x / length).collect()).collect()
        };
        let (columns_nt, whitened) = (unit(columns_nt), unit(&whitened));
        let masked: Vec<Vec<f64>> = whitened.iter().map(|column| only(column, &is_fitted)).collect();
        let mut gram = gram_of(&slices(&masked));
        (0..whitened.len()).for_each(|k| gram[(k, k)] += RIDGE);
        Self { columns_nt, whitened, is_fitted, gram }
    }

    /// Their products with a residual over the samples that they were fitted to.
    pub(super) fn along(&self, residual: &[f64]) -> DVector<f64> {
        let residual = only(residual, &self.is_fitted);
        DVector::from_iterator(self.whitened.len(), self.whitened.iter().map(|column| dot(column, &residual)))
    }

    /// Whether they were fitted to a sample.
    pub(super) fn is_fitted(&self, sample: usize) -> bool {
        self.is_fitted[sample]
    }

    /// A dipole's columns beside them, held against a residual over the samples that they were fitted to and the dipole's own.
    pub(super) fn beside(&self, local: &Local, residual: &[f64], along: &DVector<f64>) -> Option<Beside> {
        let Local { samples, columns } = local;
        let (count, own) = (self.whitened.len(), columns.len());
        let (mut fitted, mut fitted_along) = (self.gram.clone(), along.clone());
        let mut mixed = DMatrix::zeros(count, own);
        for (k, &sample) in samples.iter().enumerate() {
            let values = DVector::from_fn(count, |i, _| self.whitened[i][sample]);
            if !self.is_fitted[sample] {
                fitted.ger(1.0, &values, &values, 1.0);
                fitted_along.axpy(residual[sample], &values, 1.0);
            }
            mixed.ger(1.0, &values, &DVector::from_fn(own, |j, _| columns[j][k]), 1.0);
        }
        let fitted = fitted.cholesky()?;
        let taken = fitted.solve(&mixed);
        let there: Vec<f64> = samples.iter().map(|&sample| residual[sample]).collect();
        let gram = gram_of(&slices(columns)) - mixed.tr_mul(&taken);
        let along = DVector::from_fn(own, |j, _| dot(&columns[j], &there)) - taken.tr_mul(&fitted_along);
        Some(Beside { gram, along, fitted, fitted_along, mixed })
    }

    /// A residual, one value a sample and one a row, nT, without what `sizes` make of them; the first is divided by `scale`.
    pub(super) fn taken_off(
        &self,
        sizes: &DVector<f64>,
        scale: f64,
        whitened: &[f64],
        residual_nt: &[f64],
    ) -> (Vec<f64>, Vec<f64>) {
        let less = |values: &[f64], columns: &[Vec<f64>], scale: f64| {
            let mut values = values.to_vec();
            for (column, size) in columns.iter().zip(sizes.iter()) {
                values.iter_mut().zip(column).for_each(|(value, x)| *value -= scale * size * x);
            }
            values
        };
        (less(whitened, &self.whitened, 1.0), less(residual_nt, &self.columns_nt, scale))
    }
}

impl Beside {
    /// What the columns explain at their best, and their sizes then.
    pub(super) fn explained(&self) -> (f64, DVector<f64>) {
        let (glrt, sizes, _) = explained(&self.gram, &self.along);
        (glrt, sizes)
    }

    /// By how much what was fitted before is off, if the columns have these sizes.
    pub(super) fn off(&self, sizes: &DVector<f64>) -> DVector<f64> {
        self.fitted.solve(&(&self.fitted_along - &self.mixed * sizes))
    }
}

fn slices(columns: &[Vec<f64>]) -> Vec<&[f64]> {
    columns.iter().map(Vec::as_slice).collect()
}

/// The values of some samples; 0 at the others.
fn only(values: &[f64], wanted: &[bool]) -> Vec<f64> {
    values.iter().zip(wanted).map(|(value, wanted)| if *wanted { *value } else { 0.0 }).collect()
}

//! What compensation has wrong: a change of the body's coefficients that is fitted beside the contacts, in their noise.
//!
//! The level weighs a recording as a random process does; a target that nobody has found yet is no such process, and goes
//! into the coefficients in part. Here they are told again by generalised least squares in the measured noise, without rows that
//! stand out of it.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::spectrum::Spectrum;
use super::stretch::Stretch;
use super::whitening::{Transform, Whitener};

/// Rows whose whitened residual is beyond so many standard deviations count less (Huber 1964).
const FAR_OFF: f64 = 3.0;
/// Rounds of weighing rows.
const ROUNDS: usize = 4;
/// Of the largest product, what is added to all: two combinations of the 18 terms are told by no recording.
const RIDGE: f64 = 1e-9;

/// The terms of a recording, whitened by a spectrum; a column each, all stretches one after another.
pub(super) struct Body {
    columns: DMatrix<f64>,
}

impl Body {
    /// `terms` are those of the rows of the recording.
    pub(super) fn whitened(
        terms: &[[f64; 18]],
        stretches: &[Stretch],
        transforms: &[Transform],
        spectrum: &Spectrum,
    ) -> Self {
        let column = |k: usize| {
            let values: Vec<f64> = terms.iter().map(|terms| terms[k]).collect();
            let of = |(stretch, transform): (&Stretch, &Transform)| {
                Whitener::new(transform, spectrum).whitened(&stretch.with(&values).values)
            };
            stretches.iter().zip(transforms).flat_map(of).collect::<Vec<f64>>()
        };
        let columns: Vec<DVector<f64>> = (0..18).into_par_iter().map(|k| DVector::from_vec(column(k))).collect();
        Self { columns: DMatrix::from_columns(&columns) }
    }

    /// The coefficients that explain most of what is left beside the contacts, whitened.
    pub(super) fn fitted(&self, left: &DVector<f64>) -> [f64; 18] {
        let mut weights = DVector::from_element(left.len(), 1.0);
        let mut fitted = DVector::zeros(18);
        for _round in 0..ROUNDS {
            let mut weighted = self.columns.clone();
            weighted.column_iter_mut().for_each(|mut column| column.component_mul_assign(&weights));
            let normal = weighted.tr_mul(&self.columns);
            let ridge = RIDGE * normal.diagonal().max();
            let right = weighted.tr_mul(left);
            let Some(factor) = (normal + DMatrix::identity(18, 18) * ridge).cholesky() else { break };
            fitted = factor.solve(&right);
            let off = left - &self.columns * &fitted;
            weights = off.map(|off| (FAR_OFF / off.abs().max(f64::MIN_POSITIVE)).min(1.0));
        }
        std::array::from_fn(|k| fitted[k])
    }
}

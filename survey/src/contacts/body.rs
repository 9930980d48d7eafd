//! What compensation has wrong: a change of the body's coefficients that is fitted beside the contacts, in their noise.
//!
//! The level weighs a recording as a random process does; a target that nobody has found yet is no such process, and goes
//! into the coefficients in part. Here they are told again by generalised least squares in the measured noise, without rows that
//! stand out of it.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::stretch::Stretch;
use super::whitening::Whitener;
use crate::level::TOLD;

/// Rows whose whitened residual is beyond so many standard deviations count less (Huber 1964).
const FAR_OFF: f64 = 3.0;
/// Rounds of weighing rows.
const ROUNDS: usize = 4;
/// Of the largest product, what is added to all: on one line some are told by no recording.
const RIDGE: f64 = 1e-9;

/// The coefficients that explain most of what is left beside the contacts. `terms` are the combinations of the 18 terms that can be
/// told, one for each row of the recording; the whiteners those of the stretches.
pub(super) fn coefficients(terms: &[[f64; TOLD]], left: &[Stretch], whiteners: &[Whitener<'_>]) -> [f64; TOLD] {
    let whitened = |values: &dyn Fn(&Stretch) -> Vec<f64>| {
        let of = left.iter().zip(whiteners).flat_map(|(stretch, whitener)| whitener.whitened(&values(stretch)));
        DVector::from_vec(of.collect())
    };
    let column = |k: usize| {
        let values: Vec<f64> = terms.iter().map(|terms| terms[k]).collect();
        whitened(&|stretch| stretch.with(&values).values)
    };
    let columns: Vec<DVector<f64>> = (0..TOLD).into_par_iter().map(column).collect();
    fitted(&DMatrix::from_columns(&columns), &whitened(&|stretch| stretch.values.clone()))
}

fn fitted(columns: &DMatrix<f64>, left: &DVector<f64>) -> [f64; TOLD] {
    let mut weights = DVector::from_element(left.len(), 1.0);
    let mut fitted = DVector::zeros(TOLD);
    for _round in 0..ROUNDS {
        let mut weighted = columns.clone();
        weighted.column_iter_mut().for_each(|mut column| column.component_mul_assign(&weights));
        let normal = weighted.tr_mul(columns);
        let ridge = RIDGE * normal.diagonal().max();
        let right = weighted.tr_mul(left);
        let Some(factor) = (normal + DMatrix::identity(TOLD, TOLD) * ridge).cholesky() else { break };
        fitted = factor.solve(&right);
        let off = left - columns * &fitted;
        weights = off.map(|off| (FAR_OFF / off.abs().max(f64::MIN_POSITIVE)).min(1.0));
    }
    std::array::from_fn(|k| fitted[k])
}

//! Errors of a fit where what is left of it is no noise: as far as the blocks of the recording disagree about its parameters.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::products::{dot, gram_of};

/// What of a direction a block may tell by itself; the whole of one that nothing else tells says nothing of its error. Set by hand.
const MOST_OF_A_DIRECTION: f64 = 0.9;

/// Covariance of all columns of a fit, each block left out in turn: what is left of them need not be noise, and may be larger in some of
/// them. Linear about the fit (Efron, The Jackknife, the Bootstrap and Other Resampling Plans, 1982, ch. 3).
pub(crate) fn covariance(problem: &RegressionProblem<'_>, fit: &Fit) -> DMatrix<f64> {
    let (basis, ranges) = (fit.projection.basis(), problem.whitening.ranges());
    let rank = basis.len();
    let mut sum = DMatrix::zeros(rank, rank);
    for range in &ranges {
        let parts: Vec<&[f64]> = basis.iter().map(|direction| &direction[range.clone()]).collect();
        let score =
            DVector::from_iterator(rank, parts.iter().map(|part| dot(part, &fit.residual_whitened[range.clone()])));
        let moved = without(&parts, score);
        sum += &moved * moved.transpose();
    }
    let blocks = ranges.len() as f64;
    fit.projection.of_directions(&sum) * ((blocks - 1.0).max(1.0) / blocks)
}

/// By how much a fit moves along each direction without a block whose part of the directions, and of them the residual's, these are.
fn without(parts: &[&[f64]], score: DVector<f64>) -> DVector<f64> {
    let mut eigen = SymmetricEigen::new(gram_of(parts));
    eigen.eigenvalues.apply(|told| *told = 1.0 / (1.0 - told.min(MOST_OF_A_DIRECTION)));
    eigen.recompose() * score
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_left_out_moves_the_fit_as_one_without_it() {
        let column: Vec<f64> = (0..90).map(|k| (0.37 * f64::from(k)).sin()).collect();
        let target: Vec<f64> = (0..90).map(|k| 2.0 * column[k as usize] + (1.9 * f64::from(k)).cos()).collect();
        let of = |rows: &[usize]| {
            let sum = |a: &[f64], b: &[f64]| rows.iter().map(|&row| a[row] * b[row]).sum::<f64>();
            sum(&column, &target) / sum(&column, &column)
        };
        let (all, block): (Vec<usize>, Vec<usize>) = ((0..90).collect(), (30..60).collect());
        let others: Vec<usize> = all.iter().copied().filter(|row| !block.contains(row)).collect();
        let size = dot(&column, &column).sqrt();
        let part: Vec<f64> = column[30..60].iter().map(|x| x / size).collect();
        let left: Vec<f64> = (30..60).map(|row| target[row] - of(&all) * column[row]).collect();
        let moved = without(&[&part], DVector::from_element(1, dot(&part, &left)))[0] / size;
        assert!((of(&all) - of(&others) - moved).abs() < 1e-12, "{moved}");
    }
}

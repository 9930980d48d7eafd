//! The space that whitened columns span: projection onto its complement, and least squares in it.
//!
//! Columns are slices of equal length.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rayon::prelude::*;

use super::products::{dot, gram_of, norm, project_out};
use crate::diagnosis::policy::{DEPENDENT_EIGENVALUE, EMPTY_COLUMN_NORM, EMPTY_COLUMN_SHARE, UNEXPLAINED_EIGENVALUE};

/// An orthonormal basis of whitened columns, and how to get from it to their coefficients.
#[derive(Clone, Debug, Default)]
pub(crate) struct Projection {
    /// Orthonormal vectors, one a direction.
    basis: Vec<Vec<f64>>,
    /// Coefficients of the columns for each direction: columns by directions.
    back: DMatrix<f64>,
    /// What each column has along each direction: directions by columns.
    along: DMatrix<f64>,
}

impl Projection {
    /// Of some columns of equal length, by the eigenvectors of their correlations; dependent and empty columns add no
    /// direction.
    pub(crate) fn of(columns: &[Vec<f64>]) -> Self {
        let norms: Vec<f64> = columns.iter().map(|column| norm(column)).collect();
        let used: Vec<usize> = (0..columns.len()).filter(|&k| norms[k] > EMPTY_COLUMN_NORM).collect();
        if used.is_empty() {
            let [back, along] = [DMatrix::zeros(columns.len(), 0), DMatrix::zeros(0, columns.len())];
            return Self { basis: Vec::new(), back, along };
        }
        let eigen = SymmetricEigen::new(correlations(columns, &used, &norms));
        let least = DEPENDENT_EIGENVALUE * eigen.eigenvalues.max();
        let independent: Vec<usize> = (0..used.len()).filter(|&k| eigen.eigenvalues[k] > least).collect();
        let mut back = DMatrix::zeros(columns.len(), independent.len());
        let mut along = DMatrix::zeros(independent.len(), columns.len());
        for (direction, &k) in independent.iter().enumerate() {
            for (i, &column) in used.iter().enumerate() {
                let (part, size) = (eigen.eigenvectors[(i, k)], eigen.eigenvalues[k].sqrt());
                back[(column, direction)] = part / size / norms[column];
                along[(direction, column)] = part * size * norms[column];
            }
        }
        let combined = |direction: usize| combination(columns, &used, |column| back[(column, direction)]);
        let basis = (0..independent.len()).into_par_iter().map(combined).collect();
        Self { basis, back, along }
    }

    /// How many directions there are.
    pub(crate) fn rank(&self) -> usize {
        self.basis.len()
    }

    /// Components of a column along the directions.
    pub(crate) fn components(&self, column: &[f64]) -> DVector<f64> {
        DVector::from_iterator(self.rank(), self.basis.iter().map(|base| dot(base, column)))
    }

    /// The orthonormal directions.
    pub(crate) fn basis(&self) -> &[Vec<f64>] {
        &self.basis
    }

    /// Project a column onto the orthogonal complement, one direction after another.
    pub(crate) fn project_out(&self, column: &mut [f64]) {
        project_out(column, self.basis.iter().map(Vec::as_slice));
    }

    /// Least-squares coefficients of the columns for a target.
    pub(crate) fn solve(&self, target: &[f64]) -> Vec<f64> {
        (&self.back * self.components(target)).as_slice().to_vec()
    }

    /// What of the coefficients of the first columns all columns tell: the least that differ from them only along what is no direction.
    pub(crate) fn told(&self, coefficients: &[f64]) -> Vec<f64> {
        let first = coefficients.len();
        let along = self.along.columns(0, first) * DVector::from_column_slice(coefficients);
        (self.back.rows(0, first) * along).as_slice().to_vec()
    }

    /// Covariance of the coefficients for noise of unit variance.
    pub(crate) fn covariance(&self) -> DMatrix<f64> {
        &self.back * self.back.transpose()
    }

    /// Covariance of the coefficients, from that of the target's components along the directions.
    pub(crate) fn of_directions(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        &self.back * covariance * self.back.transpose()
    }
}

/// Products of the used columns among each other, each scaled to norm 1.
fn correlations(columns: &[Vec<f64>], used: &[usize], norms: &[f64]) -> DMatrix<f64> {
    let gram = gram_of(&used.iter().map(|&k| &columns[k][..]).collect::<Vec<_>>());
    DMatrix::from_fn(used.len(), used.len(), |i, j| gram[(i, j)] / (norms[used[i]] * norms[used[j]]))
}

/// Sum of the used columns times their weights, in order.
fn combination(columns: &[Vec<f64>], used: &[usize], weight_of: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut sum = vec![0.0; columns[0].len()];
    for &column in used {
        let weight = weight_of(column);
        sum.iter_mut().zip(&columns[column]).for_each(|(sum, x)| *sum += weight * x);
    }
    sum
}

/// Least squares from products: `gram` of the columns among each other, `q` of the columns with the residual. Returns the
/// reduction of the sum of squares (the GLRT for noise of variance 1), the coefficients, and how many combinations of the
/// columns are independent; coefficients of dependent combinations are 0.
pub(crate) fn explained(gram: &DMatrix<f64>, q: &DVector<f64>) -> (f64, DVector<f64>, usize) {
    let m = q.len();
    let scale = scales(gram);
    if scale.iter().all(|&scale| scale == 0.0) {
        return (0.0, DVector::zeros(m), 0);
    }
    let eigen = SymmetricEigen::new(DMatrix::from_fn(m, m, |i, j| gram[(i, j)] * scale[i] * scale[j]));
    let least = UNEXPLAINED_EIGENVALUE * eigen.eigenvalues.max();
    let scaled = DVector::from_fn(m, |i, _| q[i] * scale[i]);
    let (mut glrt, mut rank) = (0.0, 0);
    let mut coefficients = DVector::zeros(m);
    for k in (0..m).filter(|&k| eigen.eigenvalues[k] > least) {
        let (value, vector) = (eigen.eigenvalues[k], eigen.eigenvectors.column(k));
        let along = vector.dot(&scaled);
        glrt += along * along / value;
        rank += 1;
        coefficients += vector * (along / value);
    }
    coefficients.iter_mut().zip(&scale).for_each(|(coefficient, scale)| *coefficient *= scale);
    (glrt, coefficients, rank)
}

/// One over the norm of each column; 0 for a column that is next to nothing beside the largest.
fn scales(gram: &DMatrix<f64>) -> Vec<f64> {
    let norms: Vec<f64> = gram.diagonal().iter().map(|square| square.max(0.0).sqrt()).collect();
    let least = EMPTY_COLUMN_SHARE * norms.iter().copied().fold(0.0, f64::max);
    norms.iter().map(|&norm| if norm > least { 1.0 / norm } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependent_columns_do_no_harm() {
        let a: Vec<f64> = (0..50).map(|k| (0.3 * f64::from(k)).sin()).collect();
        let b: Vec<f64> = (0..50).map(|k| (0.7 * f64::from(k)).cos()).collect();
        let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + b).collect();
        let target: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 2.0 * a - 3.0 * b).collect();
        let projection = Projection::of(&[a.clone(), b.clone(), sum.clone()]);
        assert_eq!(projection.rank(), 2);
        let x = projection.solve(&target);
        let fitted = |k: usize| x[0] * a[k] + x[1] * b[k] + x[2] * sum[k];
        assert!((0..50).all(|k| (fitted(k) - target[k]).abs() < 1e-9));
        // What of other coefficients makes no difference is not told by the columns.
        let told = projection.told(&[x[0] + 7.0, x[1] + 7.0, x[2] - 7.0]);
        assert!((0..3).all(|k| (told[k] - x[k]).abs() < 1e-9), "{told:?} {x:?}");
        let mut residual = target;
        projection.project_out(&mut residual);
        assert!(residual.iter().all(|x| x.abs() < 1e-9));
    }
}

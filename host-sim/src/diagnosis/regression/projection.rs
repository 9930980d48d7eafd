//! The space that nuisance columns span, and least squares in it.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Directions weaker than this, relative to the strongest, count as dependent on the others.
const DEPENDENT: f64 = 1e-9;

/// An orthonormal basis of whitened columns, and how to get from it to their coefficients.
#[derive(Clone, Debug, Default)]
pub(crate) struct Projection {
    /// Orthonormal, one vector a direction.
    basis: Vec<Vec<f64>>,
    /// Coefficients of the columns for each direction: columns by directions.
    back: DMatrix<f64>,
}

impl Projection {
    /// Of some columns of equal length.
    pub(crate) fn of(columns: &[Vec<f64>]) -> Self {
        let norms: Vec<f64> = columns.iter().map(|column| dot(column, column).sqrt()).collect();
        let used: Vec<usize> = (0..columns.len()).filter(|&k| norms[k] > 1e-12).collect();
        if used.is_empty() {
            return Self { basis: Vec::new(), back: DMatrix::zeros(columns.len(), 0) };
        }
        let gram = gram_of(&used.iter().map(|&k| &columns[k][..]).collect::<Vec<_>>());
        let scaled = DMatrix::from_fn(used.len(), used.len(), |i, j| gram[(i, j)] / (norms[used[i]] * norms[used[j]]));
        let eigen = SymmetricEigen::new(scaled);
        let largest = eigen.eigenvalues.max();
        let kept: Vec<usize> = (0..used.len()).filter(|&k| eigen.eigenvalues[k] > DEPENDENT * largest).collect();
        let mut back = DMatrix::zeros(columns.len(), kept.len());
        let mut basis = Vec::with_capacity(kept.len());
        for (direction, &k) in kept.iter().enumerate() {
            let mut vector = vec![0.0; columns[0].len()];
            for (i, &column) in used.iter().enumerate() {
                let weight = eigen.eigenvectors[(i, k)] / eigen.eigenvalues[k].sqrt() / norms[column];
                back[(column, direction)] = weight;
                vector.iter_mut().zip(&columns[column]).for_each(|(v, x)| *v += weight * x);
            }
            basis.push(vector);
        }
        Self { basis, back }
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

    /// Take everything along the directions out of a column.
    pub(crate) fn project_out(&self, column: &mut [f64]) {
        let Some(first) = self.basis.first() else { return };
        let mut along = dot(first, column);
        for (base, next) in self.basis.iter().zip(&self.basis[1..]) {
            along = projected_along(column, base, along, next);
        }
        let last = &self.basis[self.basis.len() - 1];
        column.iter_mut().zip(last).for_each(|(x, b)| *x -= along * b);
    }

    /// Least-squares coefficients of the columns for a target.
    pub(crate) fn solve(&self, target: &[f64]) -> Vec<f64> {
        (&self.back * self.components(target)).as_slice().to_vec()
    }

    /// Covariance of the coefficients for noise of unit variance.
    pub(crate) fn covariance(&self) -> DMatrix<f64> {
        &self.back * self.back.transpose()
    }
}

/// Mean square of most of the values: from the median of their squares, which the rest does not move.
pub(crate) fn mean_square_of_most(values: &[f64]) -> f64 {
    let mut squares: Vec<f64> = values.iter().map(|x| x * x).collect();
    let middle = squares.len() / 2;
    // The median of chi-squared with one degree of degrees of freedom.
    *squares.select_nth_unstable_by(middle, f64::total_cmp).1 / 0.454_936
}

/// Scalar product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Four sums side by side, which the compiler turns into vector instructions.
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a4.zip(b4) {
        for i in 0..4 {
            sums[i] += x[i] * y[i];
        }
    }
    sums[0] + sums[1] + sums[2] + sums[3] + rest
}

/// Take `along` times `base` out of a column, and give what is left along `next`: in one walk through the memory, with the
/// sums of [`dot`].
fn projected_along(column: &mut [f64], base: &[f64], along: f64, next: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (mut x4, b4, n4) = (column.chunks_exact_mut(4), base.chunks_exact(4), next.chunks_exact(4));
    let ends = (b4.remainder(), n4.remainder());
    for ((x, b), n) in (&mut x4).zip(b4).zip(n4) {
        for i in 0..4 {
            x[i] -= along * b[i];
            sums[i] += n[i] * x[i];
        }
    }
    let end = x4.into_remainder().iter_mut().zip(ends.0).zip(ends.1);
    let rest: f64 = end
        .map(|((x, b), n)| {
            *x -= along * b;
            n * *x
        })
        .sum();
    sums[0] + sums[1] + sums[2] + sums[3] + rest
}

/// All scalar products of some columns.
pub(crate) fn gram_of(columns: &[&[f64]]) -> DMatrix<f64> {
    let m = columns.len();
    let mut gram = DMatrix::zeros(m, m);
    for i in 0..m {
        for j in i..m {
            gram[(i, j)] = dot(columns[i], columns[j]);
            gram[(j, i)] = gram[(i, j)];
        }
    }
    gram
}

/// What columns with products `gram` among them and `q` with the residual explain of it, and with which coefficients.
pub(crate) fn explained(gram: &DMatrix<f64>, q: &DVector<f64>) -> (f64, DVector<f64>, usize) {
    let m = q.len();
    let norms: Vec<f64> = (0..m).map(|k| gram[(k, k)].max(0.0).sqrt()).collect();
    let largest = norms.iter().copied().fold(0.0, f64::max);
    if largest == 0.0 {
        return (0.0, DVector::zeros(m), 0);
    }
    let scale: Vec<f64> = norms.iter().map(|&norm| if norm > 1e-9 * largest { 1.0 / norm } else { 0.0 }).collect();
    let eigen = SymmetricEigen::new(DMatrix::from_fn(m, m, |i, j| gram[(i, j)] * scale[i] * scale[j]));
    let top = eigen.eigenvalues.max();
    let scaled = DVector::from_fn(m, |i, _| q[i] * scale[i]);
    let (mut glrt, mut rank) = (0.0, 0);
    let mut coefficients = DVector::zeros(m);
    for k in 0..m {
        let value = eigen.eigenvalues[k];
        if value <= 1e-8 * top {
            continue;
        }
        let along = eigen.eigenvectors.column(k).dot(&scaled);
        glrt += along * along / value;
        rank += 1;
        coefficients += eigen.eigenvectors.column(k) * (along / value);
    }
    for (k, coefficient) in coefficients.iter_mut().enumerate() {
        *coefficient *= scale[k];
    }
    (glrt, coefficients, rank)
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
        let mut rest = target;
        projection.project_out(&mut rest);
        assert!(rest.iter().all(|x| x.abs() < 1e-9));
    }
}

//! Products of long columns, and their projection. The order of every sum is fixed, so that results have the same bits on every machine:
//! four sums side by side in vector registers, which the compiler does not find by itself, then the sum of those.

use nalgebra::DMatrix;
use rayon::prelude::*;
use wide::f64x4;

/// Scalar product of two columns of equal length.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a4, a_end), (b4, b_end)) = (a.as_chunks(), b.as_chunks());
    let sums = a4.iter().zip(b4).fold(f64x4::ZERO, |sums, (x, y)| sums + f64x4::new(*x) * f64x4::new(*y));
    total(sums) + a_end.iter().zip(b_end).map(|(x, y)| x * y).sum::<f64>()
}

/// Root of the sum of squares.
pub(crate) fn norm(column: &[f64]) -> f64 {
    dot(column, column).sqrt()
}

/// All scalar products of some columns.
pub(crate) fn gram_of(columns: &[&[f64]]) -> DMatrix<f64> {
    let m = columns.len();
    let products_of = |i: usize| -> Vec<f64> { columns[i..].iter().map(|other| dot(columns[i], other)).collect() };
    let upper: Vec<Vec<f64>> = (0..m).into_par_iter().map(products_of).collect();
    DMatrix::from_fn(m, m, |i, j| upper[i.min(j)][i.abs_diff(j)])
}

/// Project a column onto the orthogonal complement of orthonormal directions, one after another.
pub(crate) fn project_out<'b>(column: &mut [f64], mut basis: impl Iterator<Item = &'b [f64]>) {
    let Some(mut base) = basis.next() else { return };
    let mut along = dot(base, column);
    for next in basis {
        along = subtract_and_dot(column, base, along, next);
        base = next;
    }
    subtract(column, base, along);
}

/// Subtract `along` times `base` from a column.
fn subtract(column: &mut [f64], base: &[f64], along: f64) {
    column.iter_mut().zip(base).for_each(|(x, b)| *x -= along * b);
}

/// [`subtract`], and the scalar product of what is left with `next`: in one walk through the memory.
fn subtract_and_dot(column: &mut [f64], base: &[f64], along: f64, next: &[f64]) -> f64 {
    let ((x4, x_end), (base4, base_end), (next4, next_end)) =
        (column.as_chunks_mut(), base.as_chunks(), next.as_chunks());
    let mut sums = f64x4::ZERO;
    let along4 = f64x4::splat(along);
    for ((x, b), n) in x4.iter_mut().zip(base4).zip(next4) {
        let left = f64x4::new(*x) - along4 * f64x4::new(*b);
        sums += f64x4::new(*n) * left;
        *x = left.to_array();
    }
    subtract(x_end, base_end, along);
    total(sums) + x_end.iter().zip(next_end).map(|(x, n)| n * x).sum::<f64>()
}

/// Of the four sums, in order.
fn total(sums: f64x4) -> f64 {
    let [a, b, c, d] = sums.to_array();
    a + b + c + d
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_projection_are_those_of_row_by_row() {
        let column = |hz: f64, rows: u32| (0..rows).map(|row| (hz * f64::from(row)).sin()).collect::<Vec<f64>>();
        for rows in [1, 3, 4, 7, 50] {
            let (x, a, b) = (column(0.7, rows), column(0.3, rows), column(1.9, rows));
            let by_row = |u: &[f64], v: &[f64]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
            assert!((dot(&x, &a) - by_row(&x, &a)).abs() < 1e-12, "{rows}");
            let mut left = x.clone();
            project_out(&mut left, [&a[..], &b].into_iter());
            let mut expected = x;
            for base in [&a, &b] {
                let along = by_row(&expected, base);
                expected.iter_mut().zip(base).for_each(|(x, b)| *x -= along * b);
            }
            assert!(left.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9 * (1.0 + b.abs())), "{rows}");
        }
    }
}

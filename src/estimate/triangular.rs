//! Triangular systems of a square-root factor, in place, with a rule for pivots that are zero.

use crate::model::{TERMS, TermVector};
use nalgebra::SMatrix;

/// Terms, right-hand side, and one spare so that a row fills whole vector registers.
pub(super) const WIDTH: usize = TERMS + 2;

/// Rows of an upper triangular `R` and of its right-hand side, each a column here, so that a row is contiguous in
/// memory. What lies left of the diagonal of `R` is zero.
pub(super) type Rows = SMatrix<f32, WIDTH, TERMS>;

/// Solve `R' w = value` in place, row by row of `R`: what `solve_lower_triangular_mut` does, but for [`ratio`].
///
/// `f32`. Each step is an elementwise update, so that no sum has an order; a quotient beyond 3.4e38 overflows to
/// infinity, which the caller finds in the result.
pub(super) fn solve_transposed(rows: &Rows, w: &mut TermVector) {
    for i in 0..TERMS {
        let known = ratio(w[i], rows[(i, i)]);
        w[i] = known;
        w.rows_range_mut(i + 1..).axpy(-known, &rows.view_range(i + 1..TERMS, i), 1.0);
    }
}

/// Solve `R b = value` in place, from the last row to the first: what `tr_solve_lower_triangular_mut` does, but for
/// [`ratio`].
///
/// `f32`. A sum goes by ascending column; overflow as above. By hand: with `nalgebra`'s `dot` over a range that is not
/// known at compile time, an epoch takes 5 % longer on the desk (adaptive 5.1 instead of 4.8 us), over all 18 columns
/// 14 %.
pub(super) fn solve(rows: &Rows, b: &mut TermVector) {
    for i in (0..TERMS).rev() {
        let row = &rows.data.0[i];
        let mut rest = b[i];
        for (b, r) in b.as_slice()[i + 1..].iter().zip(&row[i + 1..TERMS]) {
            rest -= b * r;
        }
        b[i] = ratio(rest, row[i]);
    }
}

/// `value / diagonal`, or zero where there is no information: `nalgebra` gives up there.
fn ratio(value: f32, diagonal: f32) -> f32 {
    if diagonal == 0.0 { 0.0 } else { value / diagonal }
}

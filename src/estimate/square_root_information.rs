//! Square-root information factor: the normal equations of eq. (16) without ever squaring their condition number.

use super::triangular::{Rows, WIDTH, solve, solve_transposed};
use crate::model::basis::{columns_to_terms, partner, to_terms};
use crate::model::{Coefficients, Row, TERMS, TermVector, ZEROS, dot, dot_arrays};
use crate::policy::LEAST_DIAGONAL;
use nalgebra::{ArrayStorage, Const, MatrixView, SMatrix};

/// Place of the right-hand side in a row.
const RHS: usize = TERMS;

/// `R'` within the storage, a lower triangle.
type Transposed<'a> = MatrixView<'a, f32, Const<TERMS>, Const<TERMS>, Const<1>, Const<WIDTH>>;

/// Upper triangular `R` and right-hand side `s` with `R' R = sum w x x'` and `R' s = sum w (y - x' centre) x`, kept by
/// Givens rotations (Bierman, "Factorization Methods for Discrete Sequential Estimation", 1977, ch. IV). In f32 the
/// covariance recursion of eq. (17) diverges and Cholesky of the normal equations loses 0.03 nT. The centre is what
/// makes a day in f32 as good as an hour: rounding errors pile up in proportion to what `s` holds, and that is what
/// the centre leaves of the signal, not the signal.
#[derive(Clone, Debug, PartialEq)]
pub struct SquareRootInformation {
    rows: Rows,
    centre: TermVector,
}

impl SquareRootInformation {
    /// No information at all. Its solution is zero.
    pub const EMPTY: Self = Self { rows: Rows::from_array_storage(ArrayStorage([[0.0; WIDTH]; TERMS])), centre: ZEROS };

    /// Independent information `weights` (per term of eq. (4), >= 0) about `coefficients`:
    /// `R = diag(sqrt(weights)) T`, centred on them.
    pub fn independent(weights: &TermVector, coefficients: &Coefficients) -> Self {
        let mut factor = Self { centre: *coefficients.basis(), ..Self::EMPTY };
        for (term, row) in factor.rows.data.0.iter_mut().enumerate() {
            *row = penalty_row(term, weights[term]);
        }
        factor
    }

    /// The upper triangle `R` given by its transpose, centred on its own solution.
    pub(super) fn centred(transposed: &SMatrix<f32, TERMS, TERMS>, solution: &Coefficients) -> Self {
        let mut factor = Self { centre: *solution.basis(), ..Self::EMPTY };
        factor.rows.fixed_rows_mut::<TERMS>(0).copy_from(transposed);
        factor
    }

    /// A share (0 to 1) of the same information, but about `centre`.
    pub(super) fn discounted(&self, share: f32, centre: &Coefficients) -> Self {
        let mut factor = Self { rows: self.rows, centre: *centre.basis() };
        factor.rows *= libm::sqrtf(share);
        factor.rows.row_mut(RHS).fill(0.0);
        factor
    }

    /// Multiply all information by the square of `sqrt_forgetting`, unless some of it would vanish.
    pub fn forget(&mut self, sqrt_forgetting: f32) {
        let least = (0..TERMS).map(|i| self.rows[(i, i)]).fold(f32::INFINITY, f32::min);
        if least * sqrt_forgetting >= LEAST_DIAGONAL {
            self.rows *= sqrt_forgetting;
        }
    }

    /// Add one observation of weight one. Returns what of it no coefficients can explain: the squares of all of
    /// them sum to the least-squares residual.
    pub fn add(&mut self, row: &Row) -> f32 {
        let mut new = [0.0; WIDTH];
        new[..TERMS].copy_from_slice(row.terms.as_slice());
        new[RHS] = row.scalar_nt - dot(&row.terms, &self.centre);
        self.givens_update(&mut new, 0)
    }

    /// Add one observation of a weight from 0 to 1.
    pub(super) fn add_weighted(&mut self, row: &Row, weight: f32) {
        let root = libm::sqrtf(weight);
        let mut new = [0.0; WIDTH];
        for (new, term) in new.iter_mut().zip(row.terms.as_slice()) {
            *new = root * term;
        }
        new[RHS] = root * (row.scalar_nt - dot(&row.terms, &self.centre));
        self.givens_update(&mut new, 0);
    }

    /// Add the information `weight` that the coefficient of `term` is that of the centre.
    pub(super) fn hold_to_centre(&mut self, term: usize, weight: f32) {
        self.givens_update(&mut penalty_row(term, weight), term);
    }

    /// Add the information `weight` that the coefficient of `term` is zero: one row of a ridge penalty.
    pub fn add_penalty(&mut self, term: usize, weight: f32) {
        let mut new = penalty_row(term, weight);
        new[RHS] = -new[term] * (self.centre[term] + partner(term).map_or(0.0, |sum| self.centre[sum]));
        self.givens_update(&mut new, term);
    }

    /// Move the centre to `coefficients`; what the factor knows stays the same.
    pub fn recentre(&mut self, coefficients: &Coefficients) {
        let residual = self.residual_vector(coefficients);
        self.rows.row_mut(RHS).copy_from(&residual.transpose());
        self.centre = *coefficients.basis();
    }

    /// Rotate the row `new`, zero before column `first`, into the triangle: one Givens rotation for each of its
    /// columns. What is left of it on the right-hand side, nT.
    ///
    /// By hand: `nalgebra` has no rotation that carries a right-hand side. `f32`; elementwise, so that no sum has an
    /// order. The rotations have norm one: nothing grows beyond the length of a column of `R`, sqrt(number of rows).
    /// Squares underflow below 1e-19, where the rotation is skipped or not a number: [`LEAST_DIAGONAL`] keeps the
    /// diagonal above.
    fn givens_update(&mut self, new: &mut [f32; WIDTH], first: usize) -> f32 {
        for (i, row) in self.rows.data.0.iter_mut().enumerate().skip(first) {
            let (diagonal, incoming) = (row[i], new[i]);
            if incoming == 0.0 {
                continue;
            }
            let inverse = 1.0 / libm::sqrtf(diagonal * diagonal + incoming * incoming);
            let (cosine, sine) = (diagonal * inverse, incoming * inverse);
            // Whole groups of four from the one that holds the diagonal: what lies left of it is zero in both.
            let aligned = i & !3;
            for (old, new) in row[aligned..].iter_mut().zip(&mut new[aligned..]) {
                (*old, *new) = (cosine * *old + sine * *new, cosine * *new - sine * *old);
            }
        }
        new[RHS]
    }

    /// The coefficients that minimise the sum of squares plus `dual' theta`: eq. (16), with `z` as the dual. Without
    /// information, a coefficient stays at the centre.
    pub fn solve(&self, dual: &TermVector) -> TermVector {
        let mut w = *dual;
        solve_transposed(&self.rows, &mut w);
        let mut change = self.right_hand_side() - w;
        solve(&self.rows, &mut change);
        self.centre + change
    }

    /// The coefficients that minimise the sum of squares alone.
    pub(super) fn least_squares(&self) -> TermVector {
        let mut change = self.right_hand_side();
        solve(&self.rows, &mut change);
        self.centre + change
    }

    fn right_hand_side(&self) -> TermVector {
        self.rows.row(RHS).transpose()
    }

    /// `x' (R' R)^-1 x`: variance of the model value for these columns, for independent residuals of one nT.
    pub(super) fn leverage(&self, columns: &TermVector) -> f32 {
        let mut w = *columns;
        solve_transposed(&self.rows, &mut w);
        dot(&w, &w)
    }

    /// `R'`.
    pub(super) fn transposed(&self) -> Transposed<'_> {
        self.rows.fixed_rows::<TERMS>(0)
    }

    /// Trace of `R' R`: the squares of all columns that came in, less what was forgotten.
    pub(super) fn trace(&self) -> f32 {
        self.rows.data.0.iter().flat_map(|row| &row[..TERMS]).map(|value| value * value).sum()
    }

    /// Standard deviation of the coefficient of each term, nT, for independent residuals of one nT: square roots of the
    /// diagonal of `T (R' R)^-1 T'`. Infinity where there is no information.
    pub fn unit_std(&self) -> TermVector {
        let mut variance = ZEROS;
        for j in 0..TERMS {
            let mut column = ZEROS;
            column[j] = 1.0;
            solve(&self.rows, &mut column);
            let column = to_terms(&column);
            variance += column.component_mul(&column);
        }
        let has_information = |i: usize| self.rows[(i, i)] != 0.0;
        let is_known = |i: usize| has_information(i) && partner(i).is_none_or(has_information);
        TermVector::from_fn(|i, _| if is_known(i) { libm::sqrtf(variance[i]) } else { f32::INFINITY })
    }

    /// `(R T^-1)'`, column by column: the factor of the scaled terms of eq. (4), for their condition number.
    pub fn transposed_of_terms(&self) -> SMatrix<f32, TERMS, TERMS> {
        let mut of_terms = self.transposed().into_owned();
        for mut column in of_terms.column_iter_mut() {
            let moved = columns_to_terms(&column.clone_owned());
            column.copy_from(&moved);
        }
        of_terms
    }

    /// The part of the residual that depends on the coefficients, nT: `s - R (theta - centre)`.
    pub fn residual_vector(&self, coefficients: &Coefficients) -> TermVector {
        let ArrayStorage([change]) = (coefficients.basis() - self.centre).data;
        let mut residual = self.right_hand_side();
        // With `dot`, whose order of summation is kept: see there.
        for (residual, row) in residual.iter_mut().zip(&self.rows.data.0) {
            *residual -= row.first_chunk().map_or(0.0, |terms| dot_arrays(terms, &change));
        }
        residual
    }

    /// `R' value`: with the residual vector, the gradient of the fit.
    pub fn transpose_times(&self, value: &TermVector) -> TermVector {
        self.transposed() * value
    }

    /// The same information when only the terms in `active` may differ from zero. The others are fixed at zero: their
    /// columns are gone, and a diagonal one that is zero takes its share out of the column of the sum.
    pub fn restricted(&self, active: &[bool; TERMS]) -> Self {
        let mut restricted = Self::EMPTY;
        for (i, active) in active.iter().enumerate() {
            restricted.rows[(i, i)] = if *active { 0.0 } else { 1.0 };
        }
        for row in 0..TERMS {
            restricted.givens_update(&mut self.restricted_row(row, active), 0);
        }
        restricted
    }

    /// A row of `R` and its right-hand side without the columns that are not active.
    fn restricted_row(&self, row: usize, active: &[bool; TERMS]) -> [f32; WIDTH] {
        let row = &self.rows.data.0[row];
        let mut new = *row;
        // Fixed at zero, not at the centre.
        new[RHS] += dot(&TermVector::from_column_slice(&row[..TERMS]), &self.centre);
        for term in (0..TERMS).filter(|&term| !active[term]) {
            if let Some(sum) = partner(term).filter(|&sum| active[sum]) {
                new[sum] -= row[term];
            }
            new[term] = 0.0;
        }
        new
    }
}

/// A row of weight `weight` for the coefficient of `term`.
fn penalty_row(term: usize, weight: f32) -> [f32; WIDTH] {
    let mut row = [0.0; WIDTH];
    row[term] = libm::sqrtf(weight);
    if let Some(sum) = partner(term) {
        row[sum] = row[term];
    }
    row
}

//! Square-root information factor: the normal equations of eq. (16) without ever squaring their condition number.

use crate::model::basis::{columns_to_terms, partner, to_terms};
use crate::model::{Coefficients, Row, TERMS, TermVector, dot};
use crate::policy::LEAST_DIAGONAL;

/// Terms, right-hand side, and one spare so that a row fills whole vector registers.
const WIDTH: usize = TERMS + 2;
const RHS: usize = TERMS;

/// Upper triangular `R` and right-hand side `s` with `R' R = sum w x x'` and `R' s = sum w (y - x' centre) x`, kept by
/// Givens rotations (Bierman, "Factorization Methods for Discrete Sequential Estimation", 1977, ch. IV). In f32 the
/// covariance recursion of eq. (17) diverges and Cholesky of the normal equations loses 0.03 nT. The centre is what
/// makes a day in f32 as good as an hour: rounding errors pile up in proportion to what `s` holds, and that is what
/// the centre leaves of the signal, not the signal.
#[derive(Clone, Debug, PartialEq)]
pub struct SquareRootInformation {
    rows: [[f32; WIDTH]; TERMS],
    centre: TermVector,
}

impl SquareRootInformation {
    /// No information at all. Its solution is zero.
    pub const EMPTY: Self = Self { rows: [[0.0; WIDTH]; TERMS], centre: [0.0; TERMS] };

    /// Independent information `weights` (per term of eq. (4), >= 0) about `coefficients`:
    /// `R = diag(sqrt(weights)) T`, centred on them.
    pub fn independent(weights: &TermVector, coefficients: &Coefficients) -> Self {
        Self { rows: core::array::from_fn(|term| penalty_row(term, weights[term])), centre: *coefficients.basis() }
    }

    /// The triangle `rows`, centred on its own solution.
    pub(super) fn centred(rows: &[TermVector; TERMS], solution: &Coefficients) -> Self {
        let mut factor = Self { centre: *solution.basis(), ..Self::EMPTY };
        for (row, given) in factor.rows.iter_mut().zip(rows) {
            row[..TERMS].copy_from_slice(given);
        }
        factor
    }

    /// A share (0 to 1) of the same information, but about `centre`.
    pub(super) fn discounted(&self, share: f32, centre: &Coefficients) -> Self {
        let mut factor = self.clone();
        let root = libm::sqrtf(share);
        for row in &mut factor.rows {
            row.iter_mut().for_each(|value| *value *= root);
            row[RHS] = 0.0;
        }
        Self { centre: *centre.basis(), ..factor }
    }

    /// Multiply all information by the square of `sqrt_forgetting`, unless some of it would vanish.
    pub fn forget(&mut self, sqrt_forgetting: f32) {
        let least = self.rows.iter().enumerate().map(|(i, row)| row[i]).fold(f32::INFINITY, f32::min);
        if least * sqrt_forgetting < LEAST_DIAGONAL {
            return;
        }
        for row in &mut self.rows {
            for value in row {
                *value *= sqrt_forgetting;
            }
        }
    }

    /// Add one observation of weight one. Returns what of it no coefficients can explain: the squares of all of
    /// them sum to the least-squares residual.
    pub fn add(&mut self, row: &Row) -> f32 {
        let mut new = [0.0; WIDTH];
        new[..TERMS].copy_from_slice(&row.terms);
        new[RHS] = row.scalar_nt - dot(&row.terms, &self.centre);
        self.givens_update(&mut new, 0)
    }

    /// Add one observation of a weight from 0 to 1.
    pub(super) fn add_weighted(&mut self, row: &Row, weight: f32) {
        let root = libm::sqrtf(weight);
        let mut new = [0.0; WIDTH];
        for (new, term) in new.iter_mut().zip(&row.terms) {
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
        for (row, residual) in self.rows.iter_mut().zip(residual) {
            row[RHS] = residual;
        }
        self.centre = *coefficients.basis();
    }

    /// Rotate `new`, zero before column `first`, into the triangle.
    fn givens_update(&mut self, new: &mut [f32; WIDTH], first: usize) -> f32 {
        for (i, row) in self.rows.iter_mut().enumerate().skip(first) {
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
        let mut right = self.forward(dual);
        for (right, row) in right.iter_mut().zip(&self.rows) {
            *right = row[RHS] - *right;
        }
        let change = self.backward(right);
        core::array::from_fn(|i| self.centre[i] + change[i])
    }

    /// The coefficients that minimise the sum of squares alone.
    pub(super) fn least_squares(&self) -> TermVector {
        let change = self.backward(core::array::from_fn(|i| self.rows[i][RHS]));
        core::array::from_fn(|i| self.centre[i] + change[i])
    }

    /// `x' (R' R)^-1 x`: variance of the model value for these columns, for independent residuals of one nT.
    pub(super) fn leverage(&self, columns: &TermVector) -> f32 {
        let w = self.forward(columns);
        dot(&w, &w)
    }

    /// Trace of `R' R`: the squares of all columns that came in, less what was forgotten.
    pub(super) fn trace(&self) -> f32 {
        self.rows.iter().flat_map(|row| &row[..TERMS]).map(|value| value * value).sum()
    }

    /// Solve `R' w = value`, row by row of `R`: each step is an elementwise update, the same bits on any machine.
    fn forward(&self, value: &TermVector) -> TermVector {
        let mut w = *value;
        for (i, row) in self.rows.iter().enumerate() {
            w[i] = ratio(w[i], row[i]);
            let known = w[i];
            for (w, r) in w[i + 1..].iter_mut().zip(&row[i + 1..TERMS]) {
                *w -= known * r;
            }
        }
        w
    }

    /// Solve `R b = value`.
    fn backward(&self, value: TermVector) -> TermVector {
        let mut b = value;
        for i in (0..TERMS).rev() {
            let row = &self.rows[i];
            let mut rest = b[i];
            for (b, r) in b[i + 1..].iter().zip(&row[i + 1..TERMS]) {
                rest -= b * r;
            }
            b[i] = ratio(rest, row[i]);
        }
        b
    }

    /// Standard deviation of the coefficient of each term, nT, for independent residuals of one nT: square roots of the
    /// diagonal of `T (R' R)^-1 T'`. Infinity where there is no information.
    pub fn unit_std(&self) -> TermVector {
        let mut variance = [0.0_f32; TERMS];
        for j in 0..TERMS {
            let mut unit = [0.0; TERMS];
            unit[j] = 1.0;
            for (variance, value) in variance.iter_mut().zip(to_terms(&self.backward(unit))) {
                *variance += value * value;
            }
        }
        let known = |i: usize| self.rows[i][i] != 0.0 && partner(i).is_none_or(|sum| self.rows[sum][sum] != 0.0);
        core::array::from_fn(|i| if known(i) { libm::sqrtf(variance[i]) } else { f32::INFINITY })
    }

    /// `R T^-1`, row by row: the factor of the scaled terms of eq. (4), for their condition number.
    pub fn of_terms(&self) -> [TermVector; TERMS] {
        core::array::from_fn(|i| columns_to_terms(&self.columns(i)))
    }

    /// The part of the residual that depends on the coefficients, nT: `s - R (theta - centre)`.
    pub fn residual_vector(&self, coefficients: &Coefficients) -> TermVector {
        let theta = coefficients.basis();
        let change: TermVector = core::array::from_fn(|i| theta[i] - self.centre[i]);
        core::array::from_fn(|i| self.rows[i][RHS] - dot(&self.columns(i), &change))
    }

    /// One row of `R`.
    pub(super) fn columns(&self, row: usize) -> TermVector {
        core::array::from_fn(|j| self.rows[row][j])
    }

    /// `R' value`: with the residual vector, the gradient of the fit.
    pub fn transpose_times(&self, value: &TermVector) -> TermVector {
        let mut product = [0.0; TERMS];
        for (row, value) in self.rows.iter().zip(value) {
            for (product, r) in product.iter_mut().zip(&row[..TERMS]) {
                *product += r * value;
            }
        }
        product
    }

    /// The same information when only the terms in `active` may differ from zero. The others are fixed at zero: their
    /// columns are gone, and a diagonal one that is zero takes its share out of the column of the sum.
    pub fn restricted(&self, active: &[bool; TERMS]) -> Self {
        let mut restricted = Self::EMPTY;
        for (i, row) in restricted.rows.iter_mut().enumerate() {
            row[i] = if active[i] { 0.0 } else { 1.0 };
        }
        for (i, row) in self.rows.iter().enumerate() {
            let mut new = *row;
            // Fixed at zero, not at the centre.
            new[RHS] += dot(&self.columns(i), &self.centre);
            for term in (0..TERMS).filter(|&term| !active[term]) {
                if let Some(sum) = partner(term).filter(|&sum| active[sum]) {
                    new[sum] -= row[term];
                }
            }
            for (new, active) in new.iter_mut().zip(active) {
                if !active {
                    *new = 0.0;
                }
            }
            restricted.givens_update(&mut new, 0);
        }
        restricted
    }
}

fn penalty_row(term: usize, weight: f32) -> [f32; WIDTH] {
    let mut row = [0.0; WIDTH];
    row[term] = libm::sqrtf(weight);
    if let Some(sum) = partner(term) {
        row[sum] = row[term];
    }
    row
}

/// `value / diagonal`, or zero where there is no information.
fn ratio(value: f32, diagonal: f32) -> f32 {
    if diagonal == 0.0 { 0.0 } else { value / diagonal }
}

//! Square-root information factor: the normal equations of eq. (16) without ever squaring their condition number.

use super::{TERMS, TermVector};

/// Terms, right-hand side, and one spare so that a row fills whole vector registers.
const WIDTH: usize = TERMS + 2;
const RHS: usize = TERMS;

/// Least diagonal that forgetting may leave. Below it, nothing is forgotten until something is learnt: without
/// excitation, the information in an unpenalised factor would decay until it underflows.
const LEAST_DIAGONAL: f32 = 1e-12;

/// One observation: band-passed columns and band-passed scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Band-passed scaled columns, without unit.
    pub terms: TermVector,
    /// Band-passed scalar reading, nT.
    pub scalar_nt: f32,
}

/// Upper triangular `R` and right-hand side `s` with `R' R = sum w x x'` and `R' s = sum w y x`, kept by Givens
/// rotations (Bierman, "Factorization Methods for Discrete Sequential Estimation", 1977, ch. IV). In f32 the
/// covariance recursion of eq. (17) diverges and Cholesky of the normal equations loses 0.03 nT; this stays within
/// 0.001 nT of the exact f64 recursion.
#[derive(Clone, Debug, PartialEq)]
pub struct InformationFactor {
    rows: [[f32; WIDTH]; TERMS],
}

impl InformationFactor {
    /// No information at all. Its `solve` is zero.
    pub const EMPTY: Self = Self { rows: [[0.0; WIDTH]; TERMS] };

    /// Independent information `weights` (per term, >= 0) about `coefficients`:
    /// `R = diag(sqrt(weights))`, `s = R coefficients`.
    pub fn diagonal(weights: &TermVector, coefficients: &TermVector) -> Self {
        let mut factor = Self::EMPTY;
        for (i, row) in factor.rows.iter_mut().enumerate() {
            row[i] = libm::sqrtf(weights[i]);
            row[RHS] = row[i] * coefficients[i];
        }
        factor
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
        new[RHS] = row.scalar_nt;
        self.rotate_in(&mut new, 0)
    }

    /// Add the information `weight` that the coefficient `term` is zero: one row of a ridge penalty.
    pub fn add_penalty(&mut self, term: usize, weight: f32) {
        let mut new = [0.0; WIDTH];
        new[term] = libm::sqrtf(weight);
        self.rotate_in(&mut new, term);
    }

    /// Rotate `new`, zero before column `first`, into the triangle.
    fn rotate_in(&mut self, new: &mut [f32; WIDTH], first: usize) -> f32 {
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

    /// `argmin |s - R b|^2 / 2 + dual' b`, that is `(R' R)^-1 (R' s - dual)`: eq. (16), with `dual` = `z`. A term
    /// without information gets zero.
    pub fn solve(&self, dual: &TermVector) -> TermVector {
        let mut right = self.forward(dual);
        for (right, row) in right.iter_mut().zip(&self.rows) {
            *right = row[RHS] - *right;
        }
        self.backward(right)
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

    /// Standard deviation of each coefficient for residuals of one nT: square roots of the diagonal of `(R' R)^-1`.
    /// A term without information gets infinity.
    pub fn unit_std(&self) -> TermVector {
        let mut variance = [0.0_f32; TERMS];
        for j in 0..TERMS {
            let mut unit = [0.0; TERMS];
            unit[j] = 1.0;
            for (variance, value) in variance.iter_mut().zip(self.backward(unit)) {
                *variance += value * value;
            }
        }
        core::array::from_fn(|i| if self.rows[i][i] == 0.0 { f32::INFINITY } else { libm::sqrtf(variance[i]) })
    }

    /// The triangle `R`, row by row.
    pub fn triangle(&self) -> [TermVector; TERMS] {
        self.rows.map(|row| core::array::from_fn(|j| row[j]))
    }

    /// The right-hand side `s`, nT.
    pub fn right_hand_side(&self) -> TermVector {
        core::array::from_fn(|i| self.rows[i][RHS])
    }

    /// `s - R b`, nT: the part of the residual that depends on the coefficients.
    pub fn misfit(&self, coefficients: &TermVector) -> TermVector {
        core::array::from_fn(|i| {
            let row = &self.rows[i];
            row[i..TERMS].iter().zip(&coefficients[i..]).fold(row[RHS], |rest, (r, b)| rest - r * b)
        })
    }

    /// `R' value`: with the misfit, the gradient of the fit.
    pub fn transpose_times(&self, value: &TermVector) -> TermVector {
        let mut product = [0.0; TERMS];
        for (row, value) in self.rows.iter().zip(value) {
            for (product, r) in product.iter_mut().zip(&row[..TERMS]) {
                *product += r * value;
            }
        }
        product
    }

    /// The same information when only the terms in `active` may differ from zero; the others are fixed at zero.
    pub fn restricted(&self, active: &[bool; TERMS]) -> Self {
        let mut restricted = Self::EMPTY;
        for (i, row) in restricted.rows.iter_mut().enumerate() {
            row[i] = if active[i] { 0.0 } else { 1.0 };
        }
        for row in &self.rows {
            let mut new = *row;
            for (new, active) in new.iter_mut().zip(active) {
                if !active {
                    *new = 0.0;
                }
            }
            restricted.rotate_in(&mut new, 0);
        }
        restricted
    }
}

/// `value / diagonal`, or zero where there is no information.
fn ratio(value: f32, diagonal: f32) -> f32 {
    if diagonal == 0.0 { 0.0 } else { value / diagonal }
}

//! The 18 coefficients, and the two sets of units that they are used in.

use super::basis::DIAGONALS;
use super::{NT_PER_UNIT, TERMS, TermVector, ZEROS, dot};

/// Coefficients in the core's [basis](super::Terms), all in nT, so that the interference is their dot product with the
/// columns. Finite by construction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients(TermVector);

impl Coefficients {
    /// All zero: no compensation.
    pub const ZERO: Self = Self(ZEROS);

    /// From coefficients in the core's basis, nT; `None` when one of them is not finite.
    pub fn from_basis(theta: impl Into<TermVector>) -> Option<Self> {
        let theta = theta.into();
        theta.iter().all(|value| value.is_finite()).then_some(Self(theta))
    }

    /// From the units of eq. (4): permanent in nT, induced without unit, eddy in seconds. `None` when one of them is
    /// not finite.
    pub fn from_paper_units(paper: [f64; TERMS]) -> Option<Self> {
        let mut theta: [f64; TERMS] = core::array::from_fn(|i| paper[i] * NT_PER_UNIT[i]);
        for [xx, yy, sum] in DIAGONALS {
            theta[xx] -= theta[sum];
            theta[yy] -= theta[sum];
        }
        Self::from_basis(theta.map(|value| value as f32))
    }

    /// In the units of eq. (4); `from_paper_units` of it gives the same bits back.
    pub fn to_paper_units(&self) -> [f64; TERMS] {
        let mut scaled = <[f32; TERMS]>::from(self.0).map(f64::from);
        for [xx, yy, sum] in DIAGONALS {
            scaled[xx] += scaled[sum];
            scaled[yy] += scaled[sum];
        }
        core::array::from_fn(|i| scaled[i] / NT_PER_UNIT[i])
    }

    /// Coefficients in the core's basis, nT.
    pub fn basis(&self) -> &TermVector {
        &self.0
    }

    /// Model value for band-passed columns, nT.
    pub fn predict_nt(&self, columns: &TermVector) -> f32 {
        dot(&self.0, columns)
    }

    /// Model value for columns that are not band-passed, nT: with the constant that the induced sum leaves out. That
    /// constant can be 15,000 nT and more, and most of it cancels against the level: hence f64.
    pub fn interference_nt(&self, columns: &TermVector) -> f64 {
        let [[.., induced_sum], _] = DIAGONALS;
        f64::from(self.predict_nt(columns)) + f64::from(self.0[induced_sum])
    }

    /// What changes when `other` takes the place of these, nT.
    pub fn change_to(&self, other: &Self) -> Self {
        Self(other.0 - self.0)
    }
}

impl AsRef<Self> for Coefficients {
    fn as_ref(&self) -> &Self {
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paper_units_return_the_same_bits() {
        let mut scaled = [0.0; TERMS];
        for (i, value) in scaled.iter_mut().enumerate() {
            *value = (i as f32 - 7.3) * 1234.567 / (i + 1) as f32;
        }
        let coefficients = Coefficients::from_basis(scaled).unwrap();
        assert_eq!(Coefficients::from_paper_units(coefficients.to_paper_units()), Some(coefficients));
    }

    #[test]
    fn not_finite_is_refused() {
        let mut paper = [1.0; TERMS];
        paper[17] = f64::NAN;
        assert_eq!(Coefficients::from_paper_units(paper), None);
    }
}

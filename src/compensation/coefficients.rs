//! The 18 coefficients, and the two sets of units that they are used in.

use super::{NT_PER_UNIT, TERMS, TermVector};

/// Coefficients of the scaled columns (see [`Terms`](super::Terms)): all in nT, so that the interference is their dot
/// product with the columns. Finite by construction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients(TermVector);

impl Coefficients {
    /// All zero: no compensation.
    pub const ZERO: Self = Self([0.0; TERMS]);

    /// From coefficients of the scaled columns, nT; `None` when one of them is not finite.
    pub fn from_scaled(scaled: TermVector) -> Option<Self> {
        scaled.iter().all(|value| value.is_finite()).then_some(Self(scaled))
    }

    /// From the units of eq. (4): permanent in nT, induced without unit, eddy in seconds. `None` when one of them is
    /// not finite.
    pub fn from_paper_units(paper: [f64; TERMS]) -> Option<Self> {
        let mut scaled = [0.0; TERMS];
        for ((scaled, paper), nt_per_unit) in scaled.iter_mut().zip(paper).zip(NT_PER_UNIT) {
            *scaled = (paper * nt_per_unit) as f32;
        }
        Self::from_scaled(scaled)
    }

    /// In the units of eq. (4), exactly: `from_paper_units` of it gives the same bits back.
    pub fn to_paper_units(&self) -> [f64; TERMS] {
        let mut paper = [0.0; TERMS];
        for ((paper, scaled), nt_per_unit) in paper.iter_mut().zip(self.0).zip(NT_PER_UNIT) {
            *paper = f64::from(scaled) / nt_per_unit;
        }
        paper
    }

    /// Coefficients of the scaled columns, nT.
    pub fn scaled(&self) -> &TermVector {
        &self.0
    }

    /// Model value for a set of columns, raw or band-passed, nT.
    pub fn predict_nt(&self, terms: &TermVector) -> f32 {
        dot(&self.0, terms)
    }
}

/// Dot product in four interleaved partial sums, always added in the same order: fast on a vector unit, and the
/// same bits everywhere.
fn dot(a: &TermVector, b: &TermVector) -> f32 {
    let mut partial = [0.0_f32; 4];
    for (i, (a, b)) in a.iter().zip(b).enumerate() {
        partial[i % 4] += a * b;
    }
    (partial[0] + partial[1]) + (partial[2] + partial[3])
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
        let coefficients = Coefficients::from_scaled(scaled).unwrap();
        assert_eq!(Coefficients::from_paper_units(coefficients.to_paper_units()), Some(coefficients));
    }

    #[test]
    fn not_finite_is_refused() {
        let mut paper = [1.0; TERMS];
        paper[17] = f64::NAN;
        assert_eq!(Coefficients::from_paper_units(paper), None);
    }
}

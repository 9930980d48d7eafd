//! One value per term, and the one way in which such values are multiplied and added.

/// Number of Tolles-Lawson terms: 3 permanent, 6 induced, 9 eddy.
pub const TERMS: usize = 18;

/// One value per Tolles-Lawson term, in the order of [`TERM_NAMES`](super::TERM_NAMES).
pub type TermVector = [f32; TERMS];

/// Dot product in four interleaved partial sums, always added in the same order: fast on a vector unit, and the
/// same bits everywhere.
pub(crate) fn dot(a: &TermVector, b: &TermVector) -> f32 {
    let mut partial = [0.0_f32; 4];
    for (i, (a, b)) in a.iter().zip(b).enumerate() {
        partial[i % 4] += a * b;
    }
    (partial[0] + partial[1]) + (partial[2] + partial[3])
}

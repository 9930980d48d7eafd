//! One value per term, in the storage and with the products of `nalgebra`.

use nalgebra::{ArrayStorage, SVector};

/// Number of Tolles-Lawson terms: 3 permanent, 6 induced, 9 eddy.
pub const TERMS: usize = 18;

/// One value per Tolles-Lawson term, in the order of [`TERM_NAMES`](super::TERM_NAMES).
///
/// The estimators multiply and add such values with `dot` alone.
pub type TermVector = SVector<f32, TERMS>;

/// All zero, for constants.
pub(crate) const ZEROS: TermVector = TermVector::from_array_storage(ArrayStorage([[0.0; TERMS]]));

/// Scalar product in four interleaved partial sums, always added in the same order: fast on a vector unit, and the same
/// bits everywhere. Not `nalgebra`'s, which has eight: in `f32` another order moves combinations of coefficients that are
/// barely determined, and with them the level of `compensated_nT`, by 0.01 nT on flights and 0.1 nT on the sample. Every
/// product that reaches a coefficient goes through this one.
pub(crate) fn dot(a: &TermVector, b: &TermVector) -> f32 {
    let (ArrayStorage([a]), ArrayStorage([b])) = (&a.data, &b.data);
    dot_arrays(a, b)
}

/// The same of arrays: over `nalgebra`'s own iterators the loop takes a tenth more instructions on the microcontroller, over
/// a column of a view three times as many.
pub(crate) fn dot_arrays(a: &[f32; TERMS], b: &[f32; TERMS]) -> f32 {
    let mut partial = [0.0_f32; 4];
    for (i, (a, b)) in a.iter().zip(b).enumerate() {
        partial[i % 4] += a * b;
    }
    (partial[0] + partial[1]) + (partial[2] + partial[3])
}

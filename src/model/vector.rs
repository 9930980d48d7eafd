//! One value per term, in the storage and with the products of `nalgebra`.

use nalgebra::{ArrayStorage, SVector};

/// Number of Tolles-Lawson terms: 3 permanent, 6 induced, 9 eddy.
pub const TERMS: usize = 18;

/// One value per Tolles-Lawson term, in the order of [`TERM_NAMES`](super::TERM_NAMES).
///
/// A dot product sums in eight interleaved partial sums, then adds these, then the last two products: always in this
/// order, so that the bits are the same everywhere.
pub type TermVector = SVector<f32, TERMS>;

/// All zero, for constants.
pub(crate) const ZEROS: TermVector = TermVector::from_array_storage(ArrayStorage([[0.0; TERMS]]));

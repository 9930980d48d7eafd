//! Where all chance of a trial comes from.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The same numbers for a seed and a stream on every platform and with every release.
pub(crate) type Random = ChaCha8Rng;

/// Stream `number` of a seed; streams know nothing of each other.
pub(crate) fn stream(seed: u64, number: u64) -> Random {
    let mut random = Random::seed_from_u64(seed);
    random.set_stream(number);
    random
}

/// Any number between two, even in the logarithm.
pub(crate) fn log_uniform([low, high]: [f64; 2], draw: &mut Random) -> f64 {
    low * libm::pow(high / low, draw.random::<f64>())
}

//! What noise alone would leave: tests that know no effect.

mod coherence;
pub(crate) mod finding;
pub(crate) mod omnibus;
mod tails;

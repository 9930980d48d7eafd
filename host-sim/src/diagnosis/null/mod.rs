//! What noise alone would leave: tests that know no effect.

mod coherence;
mod doubt;
pub(crate) mod finding;
mod inputs;
mod kurtosis;
mod loudness;
pub(crate) mod omnibus;
mod periodogram;
mod rhythm;
mod squares;
pub(crate) mod tails;

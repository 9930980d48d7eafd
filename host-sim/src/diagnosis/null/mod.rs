//! What noise alone would leave: tests that know no effect.

pub(crate) mod omnibus;
mod tails;

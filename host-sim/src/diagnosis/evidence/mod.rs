//! How sure it is, how large, and where: probabilities, intervals, shares of the gap that close on held-out parts.

pub(crate) mod accounted;
mod bootstrap;
pub(crate) mod folds;
pub(crate) mod identifiable;
pub(crate) mod interval;
pub(crate) mod jackknife;
pub(crate) mod localise;
pub(crate) mod posterior;
pub(crate) mod shrink;

//! What an estimator learns from.

use super::TermVector;

/// One observation: band-passed columns and band-passed scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Band-passed columns, without unit.
    pub terms: TermVector,
    /// Band-passed scalar reading, nT.
    pub scalar_nt: f32,
}

//! Who tries a card.

use super::clock::Clock;
use super::effort::Effort;
use crate::Progress;

/// Who does the work, and is told how far it is.
pub struct Trial<'a> {
    /// How much is tried.
    pub effort: Effort,
    /// Tells what was written in this trial from what was written before.
    pub seed: u64,
    /// Times the writes.
    pub clock: &'a dyn Clock,
    /// Is told.
    pub progress: &'a dyn Progress,
}

//! What a file of any kind is read into.

use towmag_live::Sample;

/// A row that is shown again.
pub(super) struct Shown {
    pub(super) sample: Sample,
    pub(super) is_valid: bool,
    /// What was noted before it.
    pub(super) notes: Vec<String>,
}

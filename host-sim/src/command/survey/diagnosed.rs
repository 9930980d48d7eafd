//! What a diagnosis said of a recording that is surveyed.

use crate::diagnosis::NamedChange;

/// What was found in a recording.
#[derive(Clone, Debug, Default)]
pub(super) struct Diagnosed {
    /// What the named effects do; `None` where nothing was looked for.
    pub(super) change: Option<NamedChange>,
    /// Why there is no diagnosis although one was asked for.
    pub(super) refusal: Option<String>,
}

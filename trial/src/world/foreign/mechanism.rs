//! What one mechanism is.

use super::super::{Change, World};
use crate::random::Random;

/// A mechanism that is not in the library.
pub(crate) struct Mechanism {
    /// Not that of an effect.
    pub(crate) name: &'static str,
    /// At unit size; without a change where the world has not what it acts on.
    pub(crate) change: fn(&World, &mut Random) -> Change,
}

/// One with a name.
pub(super) const fn mechanism(name: &'static str, change: fn(&World, &mut Random) -> Change) -> Mechanism {
    Mechanism { name, change }
}

//! What one mechanism is.

use super::super::{Change, World};
use crate::random::Random;

/// A mechanism that is not in the library.
pub(crate) struct Mechanism {
    /// Not that of an effect.
    pub(crate) name: &'static str,
    /// Recorded inputs that drive it, any of which is right: written down before any diagnosis was held against them. Empty where it lives
    /// in time or by chance alone.
    pub(crate) drivers: &'static [&'static str],
    /// Whether those say no more than how large it is, and chance says the rest.
    pub(crate) is_random: bool,
    /// At unit size; without a change where the world has not what it acts on.
    pub(crate) change: fn(&World, &mut Random) -> Change,
}

/// One that nothing recorded drives.
pub(super) const fn mechanism(name: &'static str, change: fn(&World, &mut Random) -> Change) -> Mechanism {
    driven(name, &[], change)
}

/// One that an input drives.
pub(super) const fn driven(
    name: &'static str,
    drivers: &'static [&'static str],
    change: fn(&World, &mut Random) -> Change,
) -> Mechanism {
    Mechanism { name, drivers, is_random: false, change }
}

/// One by chance, which is as large as an input makes it.
pub(super) const fn louder_with(
    name: &'static str,
    drivers: &'static [&'static str],
    change: fn(&World, &mut Random) -> Change,
) -> Mechanism {
    Mechanism { name, drivers, is_random: true, change }
}

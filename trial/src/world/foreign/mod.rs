//! Mechanisms that are not in the library, for what the diagnosis says of the unknown.

mod body;
mod outside;

use super::{Change, World};
use crate::random::Random;

/// One of them.
pub(crate) struct Mechanism {
    /// Not that of an effect.
    pub(crate) name: &'static str,
    /// At unit size.
    pub(crate) change: fn(&World, &mut Random) -> Change,
}

/// All of them.
pub(crate) static ALL: [Mechanism; 7] = [
    Mechanism { name: "wandering_tone", change: outside::wandering_tone },
    Mechanism { name: "passing_iron", change: outside::passing_iron },
    Mechanism { name: "uneven_noise", change: outside::uneven_noise },
    Mechanism { name: "telegraph_current", change: body::telegraph_current },
    Mechanism { name: "fin_with_backlash", change: body::fin_with_backlash },
    Mechanism { name: "hysteresis", change: body::hysteresis },
    Mechanism { name: "moving_part", change: body::moving_part },
];

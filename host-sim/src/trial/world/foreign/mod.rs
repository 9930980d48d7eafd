//! Mechanisms that are not in the library, for what the diagnosis says of the unknown.

mod body;
mod outside;

use super::{Change, Draw, World};

/// One of them.
pub(in crate::trial) struct Mechanism {
    /// Not that of an effect.
    pub(in crate::trial) name: &'static str,
    /// At unit size.
    pub(in crate::trial) change: fn(&World, &mut Draw) -> Change,
}

/// All of them.
pub(in crate::trial) static ALL: [Mechanism; 7] = [
    Mechanism { name: "wandering_tone", change: outside::wandering_tone },
    Mechanism { name: "passing_iron", change: outside::passing_iron },
    Mechanism { name: "uneven_noise", change: outside::uneven_noise },
    Mechanism { name: "telegraph_current", change: body::telegraph_current },
    Mechanism { name: "fin_with_backlash", change: body::fin_with_backlash },
    Mechanism { name: "hysteresis", change: body::hysteresis },
    Mechanism { name: "moving_part", change: body::moving_part },
];

fn of_scalar(scalar_nt: Vec<f64>) -> Change {
    Change { scalar_nt, ..Change::default() }
}

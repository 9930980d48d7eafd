//! Mechanisms that a diagnosis may be tuned with.

mod body;
mod outside;

use super::mechanism::{Mechanism, mechanism};

pub(super) static ALL: [Mechanism; 6] = [
    mechanism("wandering_tone", outside::wandering_tone),
    mechanism("uneven_noise", outside::uneven_noise),
    mechanism("telegraph_current", body::telegraph_current),
    mechanism("fin_with_backlash", body::fin_with_backlash),
    mechanism("hysteresis", body::hysteresis),
    mechanism("moving_part", body::moving_part),
];

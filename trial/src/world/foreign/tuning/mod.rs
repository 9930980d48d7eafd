//! Mechanisms that a diagnosis may be tuned with.

mod body;
mod outside;
mod sensor;

use super::mechanism::{Mechanism, mechanism};

pub(super) static ALL: [Mechanism; 11] = [
    mechanism("wandering_tone", outside::wandering_tone),
    mechanism("uneven_noise", outside::uneven_noise),
    mechanism("telegraph_current", body::telegraph_current),
    mechanism("fin_with_backlash", body::fin_with_backlash),
    mechanism("hysteresis", body::hysteresis),
    mechanism("moving_part", body::moving_part),
    mechanism("strumming_cable", outside::strumming_cable),
    mechanism("popcorn_noise", sensor::popcorn_noise),
    mechanism("noise_by_angle", sensor::noise_by_angle),
    mechanism("late_row_of_several", sensor::late_row_of_several),
    mechanism("late_in_turns", sensor::late_in_turns),
];

//! Mechanisms that a diagnosis may be tuned with.

mod body;
mod edges;
mod outside;
mod sensor;

use super::mechanism::{Mechanism, driven, louder_with, mechanism};

pub(super) static ALL: [Mechanism; 15] = [
    mechanism("wandering_tone", outside::wandering_tone),
    mechanism("uneven_noise", outside::uneven_noise),
    mechanism("telegraph_current", body::telegraph_current),
    driven("fin_with_backlash", &["attitude_rate", "attitude_history"], body::fin_with_backlash),
    driven("hysteresis", &["attitude_history"], body::hysteresis),
    driven("falling_flap", &["attitude_history"], edges::falling_flap),
    driven("sticking_joint", &["attitude_history"], edges::sticking_joint),
    driven("flipping_domains", &["attitude_history"], edges::flipping_domains),
    driven("turned_swivel", &["attitude_history", "attitude_rate"], edges::turned_swivel),
    mechanism("moving_part", body::moving_part),
    mechanism("strumming_cable", outside::strumming_cable),
    mechanism("popcorn_noise", sensor::popcorn_noise),
    louder_with("noise_by_angle", &["attitude"], sensor::noise_by_angle),
    mechanism("late_row_of_several", sensor::late_row_of_several),
    driven("late_in_turns", &["attitude_rate"], sensor::late_in_turns),
];

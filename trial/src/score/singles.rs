//! Single effects by strength.

use serde::Serialize;

use super::judged::{Judged, alone, is_alarm, is_right};
use super::names::is_wrong_and_claimed;
use super::rate::Rate;

/// Single effects of about one strength.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Bin {
    /// Effect rms over noise rms, about.
    pub strength: f64,
    /// Some gap was seen.
    pub detected: Rate,
    /// The effect was named, or stands in the indistinguishable set of what was.
    pub right_or_in_set: Rate,
    /// The effect was named, and nothing else.
    pub alone_right: Rate,
    /// `explained` was claimed, first of all by an effect that is not it, nor has it in its set.
    pub wrong_and_claimed: Rate,
}

pub(super) fn bin(strength: f64, own: &[Judged<'_>]) -> Bin {
    Bin {
        strength,
        detected: Rate::count(own, is_alarm),
        right_or_in_set: Rate::count(own, |(answer, result)| is_right(result.diagnosis.said(), &answer.hidden[0])),
        alone_right: Rate::count(own, |(answer, result)| alone(result.diagnosis.said(), &answer.hidden[0]).is_some()),
        wrong_and_claimed: Rate::count(own, is_wrong_and_claimed),
    }
}

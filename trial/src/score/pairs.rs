//! Two effects at once, by strength.

use serde::Serialize;

use super::judged::{Judged, is_right};
use super::rate::Rate;

/// Pairs of about one strength.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PairBin {
    /// Effect rms over noise rms, about, of each.
    pub strength: f64,
    /// Both are named or in a set.
    pub both: Rate,
    /// At least one is.
    pub one: Rate,
}

pub(super) fn bin(strength: f64, own: &[Judged<'_>]) -> PairBin {
    let found = |(answer, result): &Judged<'_>| {
        answer.hidden.iter().filter(|hidden| is_right(result.diagnosis.said(), &hidden.name)).count()
    };
    PairBin {
        strength,
        both: Rate::count(own, |judged| found(judged) == 2),
        one: Rate::count(own, |judged| found(judged) >= 1),
    }
}

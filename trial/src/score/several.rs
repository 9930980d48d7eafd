//! Several effects at once.

use serde::Serialize;

use super::judged::{Judged, is_right};
use super::rate::Rate;

/// Recordings that hide as many effects of such strengths.
#[derive(Clone, Debug, Serialize)]
pub struct Several {
    /// "Two effects, strength 3".
    pub what: String,
    /// All are named or in a set.
    pub all: Rate,
    /// At least one is.
    pub one: Rate,
}

pub(super) fn of(what: impl Into<String>, own: &[Judged<'_>]) -> Several {
    let found = |(answer, result): &Judged<'_>| {
        answer.hidden.iter().filter(|hidden| is_right(result.diagnosis.said(), hidden)).count()
    };
    Several {
        what: what.into(),
        all: Rate::count(own, |judged| found(judged) == judged.0.hidden.len()),
        one: Rate::count(own, |judged| found(judged) >= 1),
    }
}

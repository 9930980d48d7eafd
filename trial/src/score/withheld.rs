//! An effect that was taken out of the library, and put back.

use serde::Serialize;

use super::judged::{Judged, is_noticed, is_right, median};
use super::rate::Rate;
use crate::answer::Hidden;
use crate::reply::TrialResult;
use crate::said::{Said, Verdict};

/// Recordings with the withheld effect.
#[derive(Clone, Debug, Serialize)]
pub struct WithheldScore {
    /// The effect.
    pub name: String,
    /// Answered `unknown` or `partly_explained` without it.
    pub noticed: Rate,
    /// Answered `explained`, by other effects, without it.
    pub explained_by_others: Rate,
    /// Named, or in the set, with it back.
    pub named_when_back: Rate,
    /// Verdict `explained` with it back.
    pub explained_when_back: Rate,
    /// Median share of the excess that goes with it, held out, where it is named; none where it never is.
    pub median_gap_closed: Option<f64>,
}

pub(super) fn of(name: &str, own: &[Judged<'_>]) -> WithheldScore {
    let back = |result: &TrialResult, is: &dyn Fn(&Said) -> bool| {
        result.put_back.as_ref().is_some_and(|reply| is(reply.said()))
    };
    let closed = own
        .iter()
        .filter_map(|(_, result)| result.put_back.as_ref()?.said().effects.iter().find(|effect| effect.name == name))
        .map(|effect| effect.gap_closed.fraction);
    WithheldScore {
        name: name.into(),
        noticed: Rate::count(own, |(_, result)| is_noticed(result.diagnosis.said())),
        explained_by_others: Rate::count(own, |(_, result)| result.diagnosis.said().verdict == Verdict::Explained),
        named_when_back: Rate::count(own, |(answer, result)| {
            let is_it = |hidden: &&Hidden| hidden.name == name;
            back(result, &|said| answer.hidden.iter().find(is_it).is_some_and(|hidden| is_right(said, hidden)))
        }),
        explained_when_back: Rate::count(own, |(_, result)| back(result, &|said| said.verdict == Verdict::Explained)),
        median_gap_closed: median(closed.collect()),
    }
}

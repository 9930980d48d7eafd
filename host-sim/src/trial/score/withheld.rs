//! An effect that was taken out of the library, and put back.

use serde::Serialize;

use super::{Pair, Rate, is_noticed, is_right, median};
use crate::diagnosis::{Diagnosis, Verdict};
use crate::trial::Said;

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

pub(super) fn of(name: &str, own: &[Pair<'_>]) -> WithheldScore {
    let back = |said: &Said, is: &dyn Fn(&Diagnosis) -> bool| said.put_back.as_ref().is_some_and(is);
    let closed = own
        .iter()
        .filter_map(|(_, said)| said.put_back.as_ref()?.effects.iter().find(|effect| effect.name == name))
        .map(|effect| effect.gap_closed.fraction);
    WithheldScore {
        name: name.into(),
        noticed: Rate::count(own, |(_, said)| is_noticed(&said.diagnosis)),
        explained_by_others: Rate::count(own, |(_, said)| said.diagnosis.verdict == Verdict::Explained),
        named_when_back: Rate::count(own, |(_, said)| back(said, &|diagnosis| is_right(diagnosis, name))),
        explained_when_back: Rate::count(own, |(_, said)| {
            back(said, &|diagnosis| diagnosis.verdict == Verdict::Explained)
        }),
        median_gap_closed: median(closed.collect()),
    }
}

//! Names that should not have been said.

use super::judged::{Judged, stands_for};
use crate::said::Verdict;

/// From here on an effect is claimed to be at work.
const CLAIMED: f64 = 0.5;

/// Explained, and first of all by an effect that is neither hidden nor has one of the hidden in its set.
pub(super) fn is_wrong_and_claimed((answer, result): &Judged<'_>) -> bool {
    let said = result.diagnosis.said();
    let is_wrong = |effect| !answer.hidden.iter().any(|hidden| stands_for(effect, hidden));
    said.verdict == Verdict::Explained && said.effects.first().is_some_and(is_wrong)
}

/// An effect is claimed that is neither hidden nor has one of the hidden in its set.
pub(super) fn has_false_name((answer, result): &Judged<'_>) -> bool {
    let mut claimed = result.diagnosis.said().effects.iter().filter(|effect| effect.probability >= CLAIMED);
    claimed.any(|effect| !answer.hidden.iter().any(|hidden| stands_for(effect, hidden)))
}

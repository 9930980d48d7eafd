//! One recording judged: its answer beside what was said of it.

use crate::answer::{Answer, Hidden};
use crate::reply::TrialResult;
use crate::said::{Said, SaidEffect, Verdict};
use crate::strength::nearest;

/// An answer and what was said.
pub(super) type Judged<'a> = (&'a Answer, &'a TrialResult);

/// Some gap is seen.
pub(super) fn is_alarm((_, result): &Judged<'_>) -> bool {
    result.diagnosis.said().verdict != Verdict::NoGap
}

/// Something is seen that no effect of the library is the cause of.
pub(super) fn is_noticed(said: &Said) -> bool {
    matches!(said.verdict, Verdict::Unknown | Verdict::PartlyExplained)
}

/// Named, or in the set of what was.
pub(super) fn is_right(said: &Said, hidden: &Hidden) -> bool {
    said.effects.iter().any(|effect| stands_for(effect, hidden))
}

/// It is this effect, with the load that drives it, or one that the recording does not tell from it.
pub(super) fn stands_for(effect: &SaidEffect, hidden: &Hidden) -> bool {
    is_it(effect, hidden) || effect.indistinguishable_from.contains(&hidden.name)
}

/// The only effect that was named, if it is this one.
pub(super) fn alone<'a>(said: &'a Said, hidden: &Hidden) -> Option<&'a SaidEffect> {
    let [effect] = &said.effects[..] else { return None };
    is_it(effect, hidden).then_some(effect)
}

/// By its name, and by the load that drives it.
fn is_it(effect: &SaidEffect, hidden: &Hidden) -> bool {
    effect.name == hidden.name && (hidden.load.is_none() || effect.load == hidden.load)
}

/// The strength that was drawn about, of the mean of what is hidden.
pub(super) fn level((answer, _): &Judged<'_>) -> f64 {
    nearest(answer.hidden.iter().map(|hidden| hidden.strength.ln()).sum::<f64>() / answer.hidden.len() as f64)
}

/// Those of about one strength.
pub(super) fn at<'a>(strength: f64, of: &[Judged<'a>]) -> Vec<Judged<'a>> {
    of.iter().copied().filter(|judged| level(judged) == strength).collect()
}

/// The middle one; none of none.
pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

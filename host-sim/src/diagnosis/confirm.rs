//! Findings tried on a second recording: parameters frozen, 18 terms and background fitted anew.

use super::evidence::shrink::frozen;
use super::findings::Findings;
use super::result::Diagnosis;

/// The diagnosis with what each effect closes on a second recording, on which nothing was searched. `there` has the
/// effects of the first, in the same order.
pub(super) fn confirm(diagnosis: Diagnosis, found: &Findings<'_>, there: &Findings<'_>) -> Diagnosis {
    let mut diagnosis = diagnosis;
    for (channel, other) in found.channels().into_iter().zip(there.channels()) {
        let other = &other.selection;
        for term in &channel.named_from().fit.terms {
            let effect = &found.library[term.effect];
            if !effect.spec().portable || !effect.applies_to(&other.problem.signals) {
                continue;
            }
            let closed = frozen(&other.problem, &other.fit, term, other.variance);
            if let Some(named) = diagnosis.effects.iter_mut().find(|named| named.name == effect.spec().name) {
                named.confirmed = Some(closed);
            }
        }
    }
    diagnosis
}

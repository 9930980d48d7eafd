//! What to sail next, so that what is still confounded comes apart, and for how long.
//!
//! Each of a handful of manoeuvres is simulated with what this recording says of body, place and noise, and the one is
//! chosen that tells the named effect and its rivals apart in the least time (T-criterion, Atkinson and Fedorov 1975).

mod criterion;
mod design;
pub(crate) mod kind;

use crate::diagnosis::evidence::localise::channel_name;
use crate::diagnosis::findings::{ChannelFindings, Findings};
use crate::diagnosis::policy::{INDISTINGUISHABLE, MANOEUVRE_MINUTES as MINUTES};
use crate::diagnosis::result::{EffectFound, NextManoeuvre, Verdict};
use crate::diagnosis::selection::Selection;
pub(crate) use criterion::Pair as Confounded;
use criterion::Pair;
pub(crate) use criterion::left as left_by;
use design::{MANOEUVRES, Manoeuvre, Place};
use kind::ManoeuvreKind;

/// Rivals that a manoeuvre is asked to tell apart from an effect.
const RIVALS: usize = 2;
/// The evidence expected, over that which tells two effects apart: with just as much, noise would hide it every other time.
pub(crate) const SAFETY: f64 = 2.0;

/// The manoeuvre for the first effect that has rivals, or for a gap without a name.
pub(crate) fn next_manoeuvre(verdict: Verdict, effects: &[EffectFound], found: &Findings<'_>) -> Option<NextManoeuvre> {
    if let Some(effect) = effects.iter().find(|effect| !effect.indistinguishable_from.is_empty()) {
        let of_effect =
            |channel: &&ChannelFindings<'_>| channel_name(channel.selection.problem.channel) == effect.channel;
        let selection = found.channels().into_iter().find(of_effect)?.named_from();
        return for_pair(&pair(effect, selection)?);
    }
    (verdict == Verdict::Unknown).then(|| NextManoeuvre {
        separates: vec!["unknown"],
        kind: ManoeuvreKind::OneThingChanged,
        repeats_event: false,
        is_enough: true,
        minutes: half_minutes(found.scalar.selection.problem.duration_s() / 60.0, MINUTES[0], MINUTES[1]),
    })
}

/// An effect as it was fitted, and its first rivals.
fn pair<'a>(effect: &EffectFound, selection: &'a Selection<'_>) -> Option<Pair<'a>> {
    let library = selection.problem.library;
    let is_it = |index: usize| {
        library[index].spec().name == effect.name && library[index].load().map(String::from) == effect.load
    };
    let term = selection.fit.terms.iter().find(|term| is_it(term.effect))?;
    let rivals = &effect.indistinguishable_from[..effect.indistinguishable_from.len().min(RIVALS)];
    Some(Pair {
        library,
        term,
        rivals: (0..library.len()).filter(|&index| rivals.contains(&library[index].spec().name)).collect(),
        recorded: &selection.problem,
        variance: selection.variance,
    })
}

/// A manoeuvre, and for how long.
pub(crate) struct Proposed {
    pub(crate) kind: ManoeuvreKind,
    /// What it takes, minutes, however long.
    pub(crate) needed_min: f64,
    /// A shorter one would not have all its headings, minutes.
    pub(crate) least_min: f64,
}

/// What tells an effect from its rivals soonest, were it sailed where the recording was made.
pub(crate) fn proposed(pair: &Pair<'_>) -> Option<Proposed> {
    let (manoeuvre, minutes) = quickest(pair, &Place::of(&pair.recorded.signals))?;
    Some(Proposed { kind: manoeuvre.kind, needed_min: minutes, least_min: manoeuvre.least_minutes() })
}

fn for_pair(pair: &Pair<'_>) -> Option<NextManoeuvre> {
    let Proposed { kind, needed_min, least_min } = proposed(pair)?;
    let mut separates = vec![pair.term.name(pair.library)];
    separates.extend(pair.rivals.iter().map(|&rival| pair.library[rival].spec().name));
    separates.dedup();
    let mut effects = std::iter::once(pair.term.effect).chain(pair.rivals.iter().copied());
    Some(NextManoeuvre {
        separates,
        kind,
        repeats_event: effects.any(|effect| pair.library[effect].spec().is_momentary()),
        is_enough: needed_min <= MINUTES[1],
        minutes: half_minutes(needed_min, least_min, MINUTES[1]),
    })
}

/// The manoeuvre that separates soonest, and in how many minutes.
fn quickest(pair: &Pair<'_>, place: &Place) -> Option<(&'static Manoeuvre, f64)> {
    let minutes = |manoeuvre| SAFETY * INDISTINGUISHABLE / criterion::per_minute(pair, manoeuvre, place);
    MANOEUVRES
        .iter()
        .filter(|manoeuvre| place.allows(manoeuvre))
        .map(|manoeuvre| (manoeuvre, minutes(manoeuvre)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Up to the next half minute.
pub(crate) fn half_minutes(minutes: f64, least: f64, most: f64) -> f64 {
    ((2.0 * minutes).ceil() / 2.0).clamp(least, most)
}

#[cfg(test)]
mod tests;

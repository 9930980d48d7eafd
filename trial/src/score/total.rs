//! The score of a trial of recordings that were made.

use std::collections::BTreeMap;

use serde::Serialize;

use super::calibration::{self, Calibration};
use super::confusion;
use super::drivers::{self, DriverScore};
use super::judged::{Judged, at, is_alarm, is_noticed, level};
use super::names::{has_false_name, is_wrong_and_claimed};
use super::parameters;
use super::rate::Rate;
use super::several::{self, Several};
use super::shrink::{self, Shrink};
use super::singles::{self, Bin};
use super::targets::{self, TargetScore};
use super::withheld::{self, WithheldScore};
use crate::answer::{Answer, Kind};
use crate::reply::TrialResult;
use crate::said::Verdict;
use crate::strength::STRENGTHS;

/// Below this an effect of the library is not scored: noise could do it.
const IDENTIFIABLE: f64 = 5.0;

/// The score of a trial. Everything in it was counted.
#[derive(Clone, Debug, Serialize)]
pub struct Score {
    /// Recordings without an effect whose verdict is not `no_gap`.
    pub false_alarms: Rate,
    /// The same by whether there are targets: `with targets`, `without targets`.
    pub false_alarms_by_targets: BTreeMap<String, Rate>,
    /// The same by the colour of the noise.
    pub false_alarms_by_noise: BTreeMap<String, Rate>,
    /// And by the motion.
    pub false_alarms_by_motion: BTreeMap<String, Rate>,
    /// And by how the recorder rounds.
    pub false_alarms_by_recorder: BTreeMap<String, Rate>,
    /// Single effects by strength: those that are identifiable, without the withheld.
    pub singles: Vec<Bin>,
    /// Of all those, explained, and first of all by an effect that is neither hidden nor alike.
    pub wrong_and_claimed: Rate,
    /// Of all recordings, those with an effect of probability 0.5 and more that is neither hidden nor alike.
    pub false_names: Rate,
    /// Pairs of strength 1 and 3, unequal pairs, triples: those all of whose effects are identifiable.
    pub several: Vec<Several>,
    /// Mechanisms outside the library answered `explained`.
    pub foreign_explained: Rate,
    /// Answered with any effect.
    pub foreign_named: Rate,
    /// Of strength 3 and more, answered `unknown` or `partly_explained`.
    pub foreign_noticed_from_3: Rate,
    /// The same of those that are identifiable: the 18 terms may take all of a mechanism.
    pub foreign_identifiable_noticed_from_3: Rate,
    /// Of strength 1, answered so.
    pub foreign_noticed_at_1: Rate,
    /// Parameters of effects named alone and rightly whose 95 % interval holds the true value.
    pub intervals_cover: Rate,
    /// The same by effect.
    pub intervals_cover_by_effect: BTreeMap<String, Rate>,
    /// Targets.
    pub targets: TargetScore,
    /// How far the gap shrinks, predicted and realised.
    pub shrink: Shrink,
    /// Whether probabilities are kept.
    pub calibration: Calibration,
    /// Hidden, then said, then how often.
    pub confusion: BTreeMap<String, BTreeMap<String, usize>>,
    /// What drives what has no name; none where nothing of strength 3 and more has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drivers: Option<DriverScore>,
    /// The withheld effect.
    pub withheld: Option<WithheldScore>,
}

/// Count everything.
pub(crate) fn score(answers: &[Answer], results: &[TrialResult], withheld: Option<&str>) -> Score {
    let all: Vec<Judged<'_>> = answers.iter().zip(results).collect();
    let has = |answer: &Answer| withheld.is_some_and(|name| answer.hidden.iter().any(|hidden| hidden.name == name));
    let kind = |kind: Kind| -> Vec<Judged<'_>> {
        all.iter().copied().filter(|(answer, _)| answer.kind == kind && !has(answer)).collect()
    };
    let (none, foreign) = (kind(Kind::None), kind(Kind::Foreign));
    let is_identifiable =
        |(answer, _): &Judged<'_>| answer.hidden.iter().all(|hidden| hidden.identifiable > IDENTIFIABLE);
    let identifiable = |of: Kind| -> Vec<Judged<'_>> { kind(of).into_iter().filter(is_identifiable).collect() };
    let singles = identifiable(Kind::Single);
    let judged: Vec<Judged<'_>> = all.iter().copied().filter(|(answer, _)| !has(answer)).collect();
    let intervals = parameters::coverage(&singles);
    let foreign_at = |is_in: &dyn Fn(&Judged<'_>) -> bool| -> Rate {
        let own: Vec<Judged<'_>> = foreign.iter().copied().filter(|judged| is_in(judged)).collect();
        Rate::count(&own, |(_, result)| is_noticed(result.diagnosis.said()))
    };
    Score {
        false_alarms: Rate::count(&none, is_alarm),
        false_alarms_by_targets: by(
            &none,
            |answer| {
                if answer.targets.is_empty() { "without targets" } else { "with targets" }
            },
        ),
        false_alarms_by_noise: by(&none, |answer| &answer.noise),
        false_alarms_by_motion: by(&none, |answer| &answer.motion),
        false_alarms_by_recorder: by(&none, |answer| &answer.recorder),
        singles: STRENGTHS.map(|strength| singles::bin(strength, &at(strength, &singles))).into(),
        wrong_and_claimed: Rate::count(&singles, is_wrong_and_claimed),
        false_names: Rate::count(&judged, has_false_name),
        several: several(&identifiable),
        foreign_explained: Rate::count(&foreign, |(_, result)| result.diagnosis.said().verdict == Verdict::Explained),
        foreign_named: Rate::count(&foreign, |(_, result)| !result.diagnosis.said().effects.is_empty()),
        foreign_noticed_from_3: foreign_at(&|judged| level(judged) >= STRENGTHS[1]),
        foreign_identifiable_noticed_from_3: foreign_at(&|judged| {
            level(judged) >= STRENGTHS[1] && is_identifiable(judged)
        }),
        foreign_noticed_at_1: foreign_at(&|judged| level(judged) < STRENGTHS[1]),
        intervals_cover: Rate::total(intervals.values()),
        intervals_cover_by_effect: intervals,
        targets: targets::of(&judged),
        shrink: shrink::of(&singles),
        calibration: calibration::of(&all, withheld),
        confusion: confusion::of(&all),
        drivers: drivers::of(&all, withheld),
        withheld: withheld.map(|name| {
            withheld::of(name, &all.iter().copied().filter(|(answer, _)| has(answer)).collect::<Vec<Judged<'_>>>())
        }),
    }
}

/// All kinds that hide more than one effect.
fn several<'a>(identifiable: &impl Fn(Kind) -> Vec<Judged<'a>>) -> Vec<Several> {
    let pairs = identifiable(Kind::Pair);
    let pair = |strength: &f64| several::of(format!("Two effects, strength {strength}"), &at(*strength, &pairs));
    let mut all: Vec<Several> = STRENGTHS[..2].iter().map(pair).collect();
    all.push(several::of("Two effects, strength 1 beside 10", &identifiable(Kind::UnequalPair)));
    all.push(several::of("Three effects, strength 3", &identifiable(Kind::Triple)));
    all
}

fn by(none: &[Judged<'_>], of: impl Fn(&Answer) -> &str) -> BTreeMap<String, Rate> {
    let mut groups: BTreeMap<String, Vec<Judged<'_>>> = BTreeMap::new();
    none.iter().for_each(|judged| groups.entry(of(judged.0).into()).or_default().push(*judged));
    groups.into_iter().map(|(name, own)| (name, Rate::count(&own, is_alarm))).collect()
}

//! What was said against what was hidden.

mod calibration;
mod confusion;
mod figure;
mod parameters;
mod rate;
mod shrink;
mod singles;
mod withheld;

use std::collections::BTreeMap;

use serde::Serialize;

use super::draw::STRENGTHS;
use super::{Answer, Kind, Said};
use crate::diagnosis::{Diagnosis, EffectFound, Verdict};

pub use calibration::{Calibration, Promise};
pub use figure::{Figure, State, figures, on_figure};
pub use rate::Rate;
pub use shrink::Shrink;
pub use singles::Bin;
pub use withheld::WithheldScore;

/// Below this an effect of the library is not scored: noise could do it.
pub(super) const IDENTIFIABLE: f64 = 5.0;

/// The score of a trial. Everything in it was counted.
#[derive(Clone, Debug, Serialize)]
pub struct Score {
    /// Recordings without an effect whose verdict is not `no_gap`.
    pub false_alarms: Rate,
    /// The same by the colour of the noise.
    pub false_alarms_by_noise: BTreeMap<String, Rate>,
    /// And by the motion.
    pub false_alarms_by_motion: BTreeMap<String, Rate>,
    /// Single effects by strength: those that are identifiable, without the withheld.
    pub singles: Vec<Bin>,
    /// Of all those, wrong and claimed.
    pub wrong_and_claimed: Rate,
    /// Pairs by strength.
    pub pairs: Vec<PairBin>,
    /// Mechanisms outside the library answered `explained`.
    pub foreign_explained: Rate,
    /// Of strength 3 and more, answered `unknown` or `partly_explained`.
    pub foreign_noticed_from_3: Rate,
    /// Of strength 1, answered so.
    pub foreign_noticed_at_1: Rate,
    /// Parameters of effects named alone and rightly whose 95 % interval holds the true value.
    pub intervals_cover: Rate,
    /// How far the gap shrinks, predicted and realised.
    pub shrink: Shrink,
    /// Whether probabilities are kept.
    pub calibration: Calibration,
    /// Hidden, then said, then how often.
    pub confusion: BTreeMap<String, BTreeMap<String, usize>>,
    /// The withheld effect.
    pub withheld: Option<WithheldScore>,
}

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

/// An answer and what was said.
type Pair<'a> = (&'a Answer, &'a Said);

pub(super) fn of(answers: &[Answer], said: &[Said], withheld: Option<&str>) -> Score {
    let all: Vec<Pair<'_>> = answers.iter().zip(said).collect();
    let has = |answer: &Answer| withheld.is_some_and(|name| answer.hidden.iter().any(|hidden| hidden.name == name));
    let kind = |kind: Kind| -> Vec<Pair<'_>> {
        all.iter().copied().filter(|(answer, _)| answer.kind == kind && !has(answer)).collect()
    };
    let (none, foreign) = (kind(Kind::None), kind(Kind::Foreign));
    let is_identifiable = |(answer, _): &Pair<'_>| answer.hidden[0].identifiable > IDENTIFIABLE;
    let singles: Vec<Pair<'_>> = kind(Kind::Single).into_iter().filter(is_identifiable).collect();
    let foreign_at = |is_in: &dyn Fn(f64) -> bool| -> Rate {
        let own: Vec<Pair<'_>> = foreign.iter().copied().filter(|pair| is_in(level(pair))).collect();
        Rate::count(&own, |(_, said)| is_noticed(&said.diagnosis))
    };
    Score {
        false_alarms: Rate::count(&none, is_alarm),
        false_alarms_by_noise: by(&none, |answer| &answer.noise),
        false_alarms_by_motion: by(&none, |answer| &answer.motion),
        singles: STRENGTHS.map(|strength| singles::bin(strength, &at(strength, &singles))).into(),
        wrong_and_claimed: Rate::count(&singles, singles::is_wrong_and_claimed),
        pairs: STRENGTHS[..2].iter().map(|&strength| pair_bin(strength, &at(strength, &kind(Kind::Pair)))).collect(),
        foreign_explained: Rate::count(&foreign, |(_, said)| said.diagnosis.verdict == Verdict::Explained),
        foreign_noticed_from_3: foreign_at(&|level| level >= STRENGTHS[1]),
        foreign_noticed_at_1: foreign_at(&|level| level < STRENGTHS[1]),
        intervals_cover: parameters::coverage(&singles),
        shrink: shrink::of(&singles),
        calibration: calibration::of(&all, withheld),
        confusion: confusion::of(&all),
        withheld: withheld.map(|name| {
            withheld::of(name, &all.iter().copied().filter(|(answer, _)| has(answer)).collect::<Vec<Pair<'_>>>())
        }),
    }
}

fn is_alarm((_, said): &Pair<'_>) -> bool {
    said.diagnosis.verdict != Verdict::NoGap
}

fn by(none: &[Pair<'_>], of: impl Fn(&Answer) -> &String) -> BTreeMap<String, Rate> {
    let mut groups: BTreeMap<String, Vec<Pair<'_>>> = BTreeMap::new();
    none.iter().for_each(|pair| groups.entry(of(pair.0).clone()).or_default().push(*pair));
    groups.into_iter().map(|(name, own)| (name, Rate::count(&own, is_alarm))).collect()
}

/// The strength that was drawn about, of the mean of what is hidden.
fn level((answer, _): &Pair<'_>) -> f64 {
    let mean = answer.hidden.iter().map(|hidden| hidden.strength.ln()).sum::<f64>() / answer.hidden.len() as f64;
    let far = |strength: &f64| (strength.ln() - mean).abs();
    STRENGTHS.into_iter().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(STRENGTHS[0])
}

fn at<'a>(strength: f64, of: &[Pair<'a>]) -> Vec<Pair<'a>> {
    of.iter().copied().filter(|pair| level(pair) == strength).collect()
}

fn pair_bin(strength: f64, own: &[Pair<'_>]) -> PairBin {
    let found = |(answer, said): &Pair<'_>| {
        answer.hidden.iter().filter(|hidden| is_right(&said.diagnosis, &hidden.name)).count()
    };
    PairBin {
        strength,
        both: Rate::count(own, |pair| found(pair) == 2),
        one: Rate::count(own, |pair| found(pair) >= 1),
    }
}

/// Named, or in the set of what was.
fn is_right(diagnosis: &Diagnosis, name: &str) -> bool {
    diagnosis.effects.iter().any(|effect| stands_for(effect, name))
}

pub(super) fn stands_for(effect: &EffectFound, name: &str) -> bool {
    effect.name == name || effect.indistinguishable_from.contains(&name)
}

fn is_noticed(diagnosis: &Diagnosis) -> bool {
    matches!(diagnosis.verdict, Verdict::Unknown | Verdict::PartlyExplained)
}

/// The only effect that was named, if it is this one.
fn alone<'a>(diagnosis: &'a Diagnosis, name: &str) -> Option<&'a EffectFound> {
    let [effect] = &diagnosis.effects[..] else { return None };
    (effect.name == name).then_some(effect)
}

/// The middle one; none of none.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

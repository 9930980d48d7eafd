//! What was said against what was hidden.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Answer, Hidden, Kind, Said};
use crate::gap::{Diagnosis, EffectFound, Verdict, wilson};

/// Edges of the strengths that are scored apart: effect rms over noise rms.
const EDGES: [f64; 4] = [0.5, 1.0, 3.0, 10.1];
/// Bins of the probabilities for the calibration error.
const BINS: usize = 10;

/// A share, with its interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// How many of them.
    pub hits: usize,
    /// How many there were.
    pub of: usize,
    /// Wilson's 95 % interval of the share; 0 to 1 where there were none.
    pub ci95: [f64; 2],
}

/// Single effects of a range of strengths.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Bin {
    /// Effect rms over noise rms, from and up to.
    pub strength: [f64; 2],
    /// Some gap was seen.
    pub detected: Rate,
    /// The effect was named, or stands in the indistinguishable set of what was.
    pub right_or_in_set: Rate,
    /// The effect was named, and nothing else.
    pub alone_right: Rate,
    /// `explained` was claimed by effects of which none is it, in the set or not.
    pub wrong_and_claimed: Rate,
}

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

/// The score of a trial. Everything in it was counted.
#[derive(Clone, Debug, Serialize)]
pub struct Score {
    /// Recordings without an effect whose verdict is not `no_gap`.
    pub false_alarms: Rate,
    /// Recordings with an effect or a mechanism whose verdict is not `no_gap`.
    pub detected: Rate,
    /// Single effects by strength; without those that are withheld.
    pub singles: Vec<Bin>,
    /// Pairs of which both are named or in a set.
    pub pairs_both: Rate,
    /// Pairs of which at least one is.
    pub pairs_one: Rate,
    /// Mechanisms outside the library answered `unknown` or `partly_explained`.
    pub foreign_noticed: Rate,
    /// Mechanisms outside the library of strength 3 and more answered so.
    pub foreign_noticed_from_3: Rate,
    /// Mechanisms outside the library answered `explained`.
    pub foreign_explained: Rate,
    /// Parameters of effects named alone and rightly whose 95 % interval holds the true value.
    pub intervals_cover: Rate,
    /// Expected calibration error of the top candidate's probability.
    pub calibration_error: f64,
    /// Hidden, then said, then how often.
    pub confusion: BTreeMap<String, BTreeMap<String, usize>>,
    /// The withheld effect.
    pub withheld: Option<WithheldScore>,
}

type Pairs<'a> = Vec<(&'a Answer, &'a Said)>;

pub(super) fn of(answers: &[Answer], said: &[Said], withheld: Option<&str>) -> Score {
    let all: Pairs<'_> = answers.iter().zip(said).collect();
    let kind = |kind: Kind| -> Pairs<'_> { all.iter().copied().filter(|(answer, _)| answer.kind == kind).collect() };
    let has = |answer: &Answer| withheld.is_some_and(|name| answer.hidden.iter().any(|hidden| hidden.name == name));
    let foreign = kind(Kind::Foreign);
    let strong: Pairs<'_> = foreign.iter().copied().filter(|(answer, _)| answer.hidden[0].strength >= 3.0).collect();
    let known = |of: Kind| -> Pairs<'_> { kind(of).into_iter().filter(|(answer, _)| !has(answer)).collect() };
    let (singles, pairs) = (known(Kind::Single), known(Kind::Pair));
    let hidden: Pairs<'_> = all.iter().copied().filter(|(answer, _)| answer.kind != Kind::None).collect();
    let found_of = |(answer, said): &(&Answer, &Said)| {
        answer.hidden.iter().filter(|hidden| is_right(&said.diagnosis, &hidden.name)).count()
    };
    Score {
        false_alarms: rate(&kind(Kind::None), |(_, said)| said.diagnosis.verdict != Verdict::NoGap),
        detected: rate(&hidden, |(_, said)| said.diagnosis.verdict != Verdict::NoGap),
        singles: EDGES.windows(2).map(|edge| bin([edge[0], edge[1]], &singles)).collect(),
        pairs_both: rate(&pairs, |pair| found_of(pair) == 2),
        pairs_one: rate(&pairs, |pair| found_of(pair) >= 1),
        foreign_noticed: rate(&foreign, |(_, said)| is_noticed(&said.diagnosis)),
        foreign_noticed_from_3: rate(&strong, |(_, said)| is_noticed(&said.diagnosis)),
        foreign_explained: rate(&foreign, |(_, said)| said.diagnosis.verdict == Verdict::Explained),
        intervals_cover: coverage(&singles),
        calibration_error: calibration_error(&all, withheld),
        confusion: confusion(&all),
        withheld: withheld
            .map(|name| withheld_score(name, &all.iter().copied().filter(|(answer, _)| has(answer)).collect())),
    }
}

impl Rate {
    /// `hits` of `of`.
    pub fn new(hits: usize, of: usize) -> Self {
        let ci95 = if of == 0 { [0.0, 1.0] } else { wilson(hits as f64 / of as f64, of as f64) };
        Self { hits, of, ci95 }
    }
}

fn rate<'a>(pairs: &Pairs<'a>, is_hit: impl Fn(&(&'a Answer, &'a Said)) -> bool) -> Rate {
    Rate::new(pairs.iter().filter(|pair| is_hit(pair)).count(), pairs.len())
}

fn is_right(diagnosis: &Diagnosis, name: &str) -> bool {
    diagnosis.effects.iter().any(|effect| effect.name == name || effect.indistinguishable_from.contains(&name))
}

fn is_noticed(diagnosis: &Diagnosis) -> bool {
    matches!(diagnosis.verdict, Verdict::Unknown | Verdict::PartlyExplained)
}

fn alone<'a>(diagnosis: &'a Diagnosis, name: &str) -> Option<&'a EffectFound> {
    let [effect] = &diagnosis.effects[..] else { return None };
    (effect.name == name).then_some(effect)
}

fn bin(strength: [f64; 2], singles: &Pairs<'_>) -> Bin {
    let is_in = |hidden: &Hidden| (strength[0]..strength[1]).contains(&hidden.strength);
    // A strength is met to a tenth: the lowest bin takes what fell short.
    let is_in = |hidden: &Hidden| is_in(hidden) || (strength[0] == EDGES[0] && hidden.strength < strength[0]);
    let own: Pairs<'_> = singles.iter().copied().filter(|(answer, _)| is_in(&answer.hidden[0])).collect();
    let name = |answer: &Answer| answer.hidden[0].name.clone();
    Bin {
        strength,
        detected: rate(&own, |(_, said)| said.diagnosis.verdict != Verdict::NoGap),
        right_or_in_set: rate(&own, |(answer, said)| is_right(&said.diagnosis, &name(answer))),
        alone_right: rate(&own, |(answer, said)| alone(&said.diagnosis, &name(answer)).is_some()),
        wrong_and_claimed: rate(&own, |(answer, said)| {
            said.diagnosis.verdict == Verdict::Explained && !is_right(&said.diagnosis, &name(answer))
        }),
    }
}

/// Of parameters with one meaning: an axis and its opposite are the same, and so are turns of a phase.
fn coverage(singles: &Pairs<'_>) -> Rate {
    let (mut hits, mut of) = (0, 0);
    for (answer, said) in singles {
        let hidden = &answer.hidden[0];
        let Some(effect) = alone(&said.diagnosis, &hidden.name) else { continue };
        if hidden.parameters.contains_key("axis_azimuth_deg") {
            continue;
        }
        for estimate in &effect.parameters {
            let cyclic = ["phase", "phase_rad"].contains(&estimate.name.as_str());
            let truth = hidden.parameters.get(&estimate.name);
            let (Some(truth), Some([low, high]), false) = (truth, estimate.ci95, cyclic) else { continue };
            of += 1;
            hits += usize::from((low..=high).contains(truth));
        }
    }
    Rate::new(hits, of)
}

/// Mean distance between what was promised and what came, weighted by how often it was promised.
fn calibration_error(all: &Pairs<'_>, withheld: Option<&str>) -> f64 {
    let mut bins = [(0.0, 0.0); BINS];
    for (answer, said) in all {
        let candidates = said.diagnosis.candidates.iter();
        let Some(top) = candidates.max_by(|a, b| a.probability.total_cmp(&b.probability)) else { continue };
        let is_withheld = |hidden: &&Hidden| withheld == Some(hidden.name.as_str());
        let is_right = match answer.kind {
            Kind::None => top.name == "none",
            Kind::Foreign => top.name == "unknown",
            _ if answer.hidden.iter().any(|hidden| hidden.name == top.name) => true,
            _ => top.name == "unknown" && answer.hidden.iter().any(|hidden| is_withheld(&hidden)),
        };
        let bin = &mut bins[((top.probability * BINS as f64) as usize).min(BINS - 1)];
        bin.0 += top.probability;
        bin.1 += f64::from(u8::from(is_right));
    }
    bins.iter().map(|(promised, came)| (promised - came).abs()).sum::<f64>() / all.len().max(1) as f64
}

fn confusion(all: &Pairs<'_>) -> BTreeMap<String, BTreeMap<String, usize>> {
    let joined = |mut names: Vec<&str>| {
        names.sort_unstable();
        names.join(" + ")
    };
    let mut table: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for (answer, said) in all {
        let hidden = match answer.kind {
            Kind::None => "none".into(),
            _ => joined(answer.hidden.iter().map(|hidden| hidden.name.as_str()).collect()),
        };
        let diagnosis = &said.diagnosis;
        let answered = match diagnosis.verdict {
            Verdict::NoGap => "none".into(),
            Verdict::Unknown => "unknown".into(),
            verdict => {
                let rest = if verdict == Verdict::PartlyExplained { " + unknown" } else { "" };
                joined(diagnosis.effects.iter().map(|effect| effect.name).collect()) + rest
            }
        };
        *table.entry(hidden).or_default().entry(answered).or_default() += 1;
    }
    table
}

fn withheld_score(name: &str, own: &Pairs<'_>) -> WithheldScore {
    let back = |said: &Said, is: &dyn Fn(&Diagnosis) -> bool| said.put_back.as_ref().is_some_and(is);
    let mut closed: Vec<f64> = own
        .iter()
        .filter_map(|(_, said)| said.put_back.as_ref()?.effects.iter().find(|effect| effect.name == name))
        .map(|effect| effect.gap_closed.fraction)
        .collect();
    closed.sort_by(f64::total_cmp);
    WithheldScore {
        name: name.into(),
        noticed: rate(own, |(_, said)| is_noticed(&said.diagnosis)),
        explained_by_others: rate(own, |(_, said)| said.diagnosis.verdict == Verdict::Explained),
        named_when_back: rate(own, |(_, said)| back(said, &|diagnosis| is_right(diagnosis, name))),
        explained_when_back: rate(own, |(_, said)| back(said, &|diagnosis| diagnosis.verdict == Verdict::Explained)),
        median_gap_closed: closed.get(closed.len() / 2).copied(),
    }
}

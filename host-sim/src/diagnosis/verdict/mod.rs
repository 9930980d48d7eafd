//! What the findings of both channels come to.

mod channels;
mod effects;

use rand_chacha::ChaCha8Rng;

use crate::diagnosis::diagnose::Found;
use crate::diagnosis::evidence::localise::{channel_name, shares};
use crate::diagnosis::evidence::posterior::{EvidenceSummary, main_cause};
use crate::diagnosis::manoeuvre::next_manoeuvre;
use crate::diagnosis::null::omnibus::Finding;
use crate::diagnosis::result::{CandidateShare, ChannelGap, Diagnosis, EffectFound, Unexplained, Verdict};
use crate::diagnosis::selection::Analysis;
use crate::effects::FIRMWARE_MISMATCH;
use crate::text::diagnosis as words;
use channels::{cells_of, channel_gap, gap, pictures};
use effects::{effects_of, exact_effects};

/// Chance of a finding without a cause, both channels and all tests together, about; and how many these are.
const FALSE_ALARM: f64 = 0.002;
const TESTS: f64 = 12.0;
/// Logarithm of a chance at which what goes with the attitude is no imperfection of what was found.
const LOG_BY_ATTITUDE: f64 = -34.0;
/// Share of the excess that may stay significant without the verdict being partial.
const SMALL_REST: f64 = 0.08;
/// Effects in a channel from which on none of it may stay; and what counts as left then, at least.
const MANY: usize = 3;
const PIECED: f64 = 0.5;
/// Share of the excess that the best of the named effects closes on held-out parts at least, or the gap is not explained
/// even though no test finds what is left.
const LEAST_CLOSED: f64 = 0.5;

/// Everything of a channel that the verdict needs.
struct Side<'a, 'b> {
    analysis: &'b Analysis<'a>,
    findings: &'b [Finding],
}

/// The verdict on both channels.
pub(crate) fn of(found: &Found<'_>, draw: &mut ChaCha8Rng) -> Diagnosis {
    let sides = [
        Side { analysis: &found.scalar, findings: &found.scalar_findings },
        Side { analysis: &found.fluxgate, findings: &found.fluxgate_findings },
    ];
    let mut effects: Vec<EffectFound> = sides.iter().flat_map(|side| effects_of(side, draw)).collect();
    effects.extend(exact_effects(found));
    let unexplained: Vec<Unexplained> = sides.iter().flat_map(unexplained).collect();
    let closed = effects.iter().map(|effect| effect.gap_closed.fraction).reduce(f64::max);
    let stays = closed.filter(|closed| *closed < LEAST_CLOSED).map_or(0.0, |closed| 1.0 - closed.max(0.0));
    let rest_share = sides.iter().map(rest_share).fold(stays, f64::max);
    let has_rest = !unexplained.is_empty() || stays > 0.0;
    let verdict = match (effects.is_empty(), has_rest) {
        (true, false) => Verdict::NoGap,
        (true, true) => Verdict::Unknown,
        (false, true) if rest_share > SMALL_REST => Verdict::PartlyExplained,
        (false, _) => Verdict::Explained,
    };
    let summary = summary(found, &sides, &effects, has_rest, rest_share);
    let (shares_of, at_work) = main_cause(&summary);
    for (effect, probability) in effects.iter_mut().zip(at_work) {
        effect.probability = probability;
    }
    effects.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let channels: Vec<ChannelGap> = sides.iter().map(channel_gap).collect();
    let cells = shares(sides.iter().flat_map(|side| cells_of(side, found)).collect());
    let next_manoeuvre = next_manoeuvre(verdict, &effects, found);
    let mut diagnosis = Diagnosis {
        schema: 1,
        verdict,
        summary: String::new(),
        gap: gap(&sides, found, &channels),
        cells,
        candidates: candidates(found, shares_of),
        next_manoeuvre,
        unexplained,
        channels,
        exact_replay: Vec::new(),
        specs: found.specs.clone(),
        pictures: sides.iter().map(|side| pictures(side, found)).collect(),
        effects,
    };
    diagnosis.summary = words::sentence(&diagnosis);
    diagnosis
}

/// Findings of a channel, as they are told.
fn unexplained(side: &Side<'_, '_>) -> Vec<Unexplained> {
    let of = |finding: &Finding| Unexplained {
        channel: channel_name(side.analysis.problem.channel),
        what: finding.what,
        p_value: finding.log_p.exp(),
    };
    significant(side).map(of).collect()
}

/// Findings that noise alone would hardly make.
fn significant<'b>(side: &Side<'_, 'b>) -> impl Iterator<Item = &'b Finding> {
    let limit = (FALSE_ALARM / TESTS).ln();
    side.findings.iter().filter(move |finding| finding.log_p < limit)
}

/// How much of all excess of a channel is left: what the tests found over that and what was explained.
fn rest_share(side: &Side<'_, '_>) -> f64 {
    let rest = significant(side).map(|finding| finding.excess).fold(0.0, f64::max);
    let gains: f64 = side.analysis.named.iter().map(|named| named.candidate.glrt / side.analysis.variance).sum();
    let share = rest / (rest + gains).max(1e-9);
    if is_pieced_together(side) { share.max(PIECED) } else { share }
}

/// Whether what was named are as likely as not pieces of an effect that nobody knows: so many in a channel that still
/// shows a rest, or a rest that surely goes with the attitude.
fn is_pieced_together(side: &Side<'_, '_>) -> bool {
    let is_by_attitude = |finding: &Finding| ["attitude", "memory"].contains(&finding.what);
    let many = side.analysis.named.len() >= MANY && significant(side).next().is_some();
    many || side.findings.iter().any(|finding| is_by_attitude(finding) && finding.log_p < LOG_BY_ATTITUDE)
}

fn summary(
    found: &Found<'_>,
    sides: &[Side<'_, '_>],
    effects: &[EffectFound],
    has_rest: bool,
    rest_share: f64,
) -> EvidenceSummary {
    let mut rivals: Vec<(&'static str, f64)> = Vec::new();
    let mut none: Vec<(&'static str, f64)> = Vec::new();
    for side in sides {
        let library = side.analysis.problem.library;
        for named in &side.analysis.named {
            let own = library[named.candidate.term.effect].spec().name;
            rivals.extend(
                named
                    .rivals
                    .iter()
                    .map(|(effect, evidence)| (library[*effect].spec().name, evidence - named.evidence))
                    .filter(|(name, _)| *name != own),
            );
        }
        none.extend(
            side.analysis.last_scan.iter().map(|(effect, evidence, _)| (library[*effect].spec().name, *evidence)),
        );
    }
    let strongest_rest = sides.iter().flat_map(|side| side.findings).map(|finding| finding.log_p).fold(0.0, f64::min);
    EvidenceSummary {
        library: names(found),
        named: effects.iter().map(|effect| (effect.name, effect.strength)).collect(),
        rivals,
        scanned: none,
        rest_log_p: strongest_rest,
        has_rest,
        rest_share,
    }
}

/// Every effect of the program once, in the order of the library, and the one without a forward model.
fn names(found: &Found<'_>) -> Vec<&'static str> {
    found.specs.iter().map(|spec| spec.name).chain([FIRMWARE_MISMATCH]).collect()
}

fn candidates(found: &Found<'_>, shares: Vec<(&'static str, f64)>) -> Vec<CandidateShare> {
    let mut out: Vec<CandidateShare> = shares
        .into_iter()
        .map(|(name, probability)| CandidateShare {
            name,
            probability,
            identifiable_fraction: crate::diagnosis::evidence::identifiable::fraction(found, name),
        })
        .collect();
    out.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    out
}

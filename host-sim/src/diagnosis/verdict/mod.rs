//! What the findings of both channels come to.

mod channels;
mod effects;
mod rest;
mod rounding;

use rand_chacha::ChaCha8Rng;

use super::evidence::identifiable;
use super::evidence::localise::{channel_name, shares};
use super::evidence::posterior::{EvidenceSummary, main_cause};
use super::findings::{ChannelFindings, Findings};
use super::manoeuvre::next_manoeuvre;
use super::policy::SMALL_REST;
use super::result::{CandidateShare, ChannelGap, Diagnosis, EffectFound, TargetFound, Verdict};
use super::targets::{Lobe, Target};
use crate::effects::FIRMWARE_MISMATCH;
use channels::{cells_of, channel_gap, gap, residuals};
use effects::{effects_of, exact_effects};
use rest::Rest;
use rounding::rounding_found;

/// The verdict on both channels.
pub(super) fn of(found: &Findings<'_>, draw: &mut ChaCha8Rng) -> Diagnosis {
    let mut effects: Vec<EffectFound> =
        found.channels().into_iter().flat_map(|channel| effects_of(channel, draw)).collect();
    effects.extend(exact_effects(found));
    let rest = Rest::of(&found.channels(), &effects);
    let (shares_of, at_work) = main_cause(&summary(found, &effects, &rest));
    for (effect, probability) in effects.iter_mut().zip(at_work) {
        effect.probability = probability;
    }
    let verdict = verdict(&effects, &rest);
    effects.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let channel = |channel| channel_gap(channel, verdict_on(channel, &effects));
    let channels: Vec<ChannelGap> = found.channels().into_iter().map(channel).collect();
    Diagnosis {
        verdict,
        gap: gap(found, &channels),
        cells: shares(found.channels().into_iter().flat_map(|channel| cells_of(channel, found)).collect()),
        candidates: candidates(found, shares_of),
        next_manoeuvre: next_manoeuvre(verdict, &effects, found),
        unexplained: rest.unexplained,
        targets: targets(found),
        rounding: Some(rounding_found(found)),
        channels,
        exact_replay: Vec::new(),
        specs: found.specs.clone(),
        residuals: found.channels().into_iter().map(|channel| residuals(channel, found)).collect(),
        effects,
    }
}

/// The targets, as they are listed.
fn targets(found: &Findings<'_>) -> Vec<TargetFound> {
    let first_s = found.table.time_s.first().copied().unwrap_or(0.0);
    let listed = |target: Target| {
        let Lobe { epoch_s, peak_nt, width_s } = target.dipole.largest_lobe();
        TargetFound { time_s: first_s + epoch_s, peak_nT: peak_nt, width_s, probability: target.probability }
    };
    found.targets.listed().into_iter().map(listed).collect()
}

fn verdict(effects: &[EffectFound], rest: &Rest) -> Verdict {
    match (effects.is_empty(), rest.is_significant) {
        (true, false) => Verdict::NoGap,
        (true, true) => Verdict::Unknown,
        (false, true) if rest.share > SMALL_REST => Verdict::PartlyExplained,
        (false, _) => Verdict::Explained,
    }
}

/// The verdict on a channel by itself.
fn verdict_on(channel: &ChannelFindings<'_>, effects: &[EffectFound]) -> Verdict {
    let name = channel_name(channel.selection.problem.channel);
    let own: Vec<EffectFound> = effects.iter().filter(|effect| effect.channel == name).cloned().collect();
    verdict(&own, &Rest::of(&[channel], &own))
}

fn summary(found: &Findings<'_>, effects: &[EffectFound], rest: &Rest) -> EvidenceSummary {
    let name = |effect: usize| found.library[effect].spec().name;
    let selections = || found.channels().into_iter().map(|channel| &channel.selection);
    let accepted = selections().flat_map(|selection| &selection.accepted);
    let rivals = accepted.flat_map(|accepted| {
        let own = name(accepted.candidate.term.effect);
        let over = move |&(effect, evidence): &(usize, f64)| (name(effect), evidence - accepted.evidence);
        accepted.rivals.iter().map(over).filter(move |(other, _)| *other != own)
    });
    let scanned = selections().flat_map(|selection| &selection.last_scan);
    let tests = found.channels().into_iter().flat_map(|channel| &channel.tests);
    EvidenceSummary {
        library: found.specs.iter().map(|spec| spec.name).chain([FIRMWARE_MISMATCH]).collect(),
        named: effects.iter().map(|effect| (effect.name, effect.strength)).collect(),
        rivals: rivals.collect(),
        scanned: scanned.map(|scanned| (name(scanned.effect), scanned.evidence)).collect(),
        rest_log_p: tests.map(|test| test.log_p).fold(0.0, f64::min),
        has_rest: rest.is_significant,
        rest_share: rest.share,
    }
}

fn candidates(found: &Findings<'_>, shares: Vec<(&'static str, f64)>) -> Vec<CandidateShare> {
    let candidate = |(name, probability): (&'static str, f64)| CandidateShare {
        name,
        probability,
        identifiable_fraction: identifiable::fraction(found, name),
    };
    let mut candidates: Vec<CandidateShare> = shares.into_iter().map(candidate).collect();
    candidates.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    candidates
}

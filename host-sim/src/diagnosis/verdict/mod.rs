//! What the findings of both channels come to.

mod channels;
mod effects;
mod rest;
mod rounding;

use rand_chacha::ChaCha8Rng;

use super::evidence::identifiable;
use super::evidence::localise::{channel_name, shares};
use super::evidence::posterior::{EvidenceSummary, Named, main_cause};
use super::findings::{ChannelFindings, Findings};
use super::manoeuvre::next_manoeuvre;
use super::policy::{TARGET_LISTED, TARGET_WIDEST_S};
use super::result::{CandidateShare, ChannelGap, ChannelResiduals, Diagnosis, EffectFound, TargetFound, Verdict};
use super::targets::{Lobe, Target};
use crate::effects::FIRMWARE_MISMATCH;
use channels::{cells_of, channel_gap, gap, gap_log_p, residuals};
use effects::{column_effects, effects_of, exact_effects};
use rest::Rest;
use rounding::rounding_found;

/// The verdict on both channels.
pub(super) fn of(found: &Findings<'_>, draw: &mut ChaCha8Rng) -> Diagnosis {
    let told = told(found, draw);
    let (mut effects, shares_of) = effects_at_work(found, &told);
    let verdict = verdict(!effects.is_empty(), told.iter().map(|told| &told.rest));
    effects.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let (residuals, channels): (Vec<ChannelResiduals>, Vec<ChannelGap>) =
        found.channels().into_iter().zip(&told).map(|(channel, told)| measured(channel, told.verdict(), found)).unzip();
    Diagnosis {
        verdict,
        gap: gap(found, &channels),
        cells: shares(found.channels().into_iter().flat_map(|channel| cells_of(channel, found)).collect()),
        candidates: candidates(found, shares_of),
        next_manoeuvre: next_manoeuvre(verdict, &effects, found),
        unexplained: told.into_iter().flat_map(|told| told.rest.unexplained).collect(),
        description: None,
        targets: targets(found),
        rounding: Some(rounding_found(found)),
        residuals,
        channels,
        is_cut_short: found.channels().into_iter().any(|channel| channel.selection.is_cut_short),
        consequence: None,
        simulation: None,
        exact_replay: Vec::new(),
        bad_rows: Default::default(),
        provenance: None,
        specs: found.specs.clone(),
        effects,
    }
}

/// The effects that are named, each with the probability that it is at work; and what of the scalar has no name, where there is such a
/// rest.
pub(super) fn named_effects(found: &Findings<'_>, draw: &mut ChaCha8Rng) -> (Vec<EffectFound>, Option<ChannelGap>) {
    let told = told(found, draw);
    let verdict = told[0].verdict();
    let has_rest = matches!(verdict, Verdict::Unknown | Verdict::PartlyExplained);
    let rest = has_rest.then(|| measured(&found.scalar, verdict, found).1);
    (effects_at_work(found, &told).0, rest)
}

/// What is told of both channels, the scalar first.
fn told(found: &Findings<'_>, draw: &mut ChaCha8Rng) -> Vec<Told> {
    let exact: Vec<EffectFound> = exact_effects(found).into_iter().chain(column_effects(found)).collect();
    found.channels().into_iter().map(|channel| Told::of(channel, &exact, draw)).collect()
}

/// The effects that are named, each with its probability; and the share of each possible main cause.
fn effects_at_work(found: &Findings<'_>, told: &[Told]) -> (Vec<EffectFound>, Vec<(&'static str, f64)>) {
    let (mut effects, surest): (Vec<EffectFound>, Vec<f64>) = told.iter().flat_map(Told::named).unzip();
    let (shares_of, at_work) = main_cause(&summary(found, told, &effects, &surest));
    for (effect, probability) in effects.iter_mut().zip(at_work) {
        effect.probability = probability;
    }
    (effects, shares_of)
}

/// What a channel leaves, and how much that is.
fn measured(channel: &ChannelFindings<'_>, verdict: Verdict, found: &Findings<'_>) -> (ChannelResiduals, ChannelGap) {
    let residuals = residuals(channel, verdict, found);
    let gap = channel_gap(channel, verdict, &residuals);
    (residuals, gap)
}

/// What is told of a channel.
struct Told {
    /// Every effect that was found.
    effects: Vec<EffectFound>,
    rest: Rest,
}

impl Told {
    /// `exact` are the effects of any channel that need no fit.
    fn of(channel: &ChannelFindings<'_>, exact: &[EffectFound], draw: &mut ChaCha8Rng) -> Self {
        let name = channel_name(channel.selection.problem.channel);
        let mut effects = if channel.is_outdone { Vec::new() } else { effects_of(channel, draw) };
        // The last noise model may see it otherwise than the one before, by which it was taken.
        effects.retain(|effect| effect.gap_closed.ci95[0] > 0.0);
        effects.extend(exact.iter().filter(|effect| effect.channel == name).cloned());
        Self { rest: Rest::of(channel, &effects), effects }
    }

    /// The effects that are named, each with the probability that it may have at most.
    fn named(&self) -> impl Iterator<Item = (EffectFound, f64)> + '_ {
        let named = self.effects.iter().filter(|effect| self.rest.leaves(effect));
        named.map(|effect| (effect.clone(), self.rest.surest(effect)))
    }

    fn verdict(&self) -> Verdict {
        verdict(self.named().next().is_some(), std::iter::once(&self.rest))
    }
}

/// The targets, as they are listed.
fn targets(found: &Findings<'_>) -> Vec<TargetFound> {
    let first_s = found.table.time_s.first().copied().unwrap_or(0.0);
    let listed = |target: Target| {
        let Lobe { epoch_s, peak_nt, width_s } = target.dipole.largest_lobe();
        TargetFound { time_s: first_s + epoch_s, peak_nT: peak_nt, width_s, probability: target.probability }
    };
    let is_told = |target: &TargetFound| target.probability >= TARGET_LISTED && target.width_s < TARGET_WIDEST_S;
    found.targets.listed().into_iter().map(listed).filter(is_told).collect()
}

fn verdict<'b>(is_any_named: bool, rests: impl Iterator<Item = &'b Rest>) -> Verdict {
    let (is_left, is_large) =
        rests.fold((false, false), |(left, large), rest| (left || rest.is_significant, large || rest.is_large()));
    match (is_any_named, is_left) {
        (false, false) => Verdict::NoGap,
        (false, true) => Verdict::Unknown,
        (true, _) if is_large => Verdict::PartlyExplained,
        (true, _) => Verdict::Explained,
    }
}

fn summary(found: &Findings<'_>, told: &[Told], effects: &[EffectFound], surest: &[f64]) -> EvidenceSummary {
    let name = |effect: usize| found.library[effect].spec().name;
    let selections = || found.channels().into_iter().map(ChannelFindings::named_from);
    let scanned = selections().flat_map(|selection| &selection.last_scan);
    EvidenceSummary {
        library: found.specs.iter().map(|spec| spec.name).chain([FIRMWARE_MISMATCH]).collect(),
        named: effects.iter().zip(surest).map(|(effect, &surest)| named(found, effect, surest)).collect(),
        scanned: scanned.map(|scanned| (name(scanned.effect), scanned.evidence)).collect(),
        log_p: gap_log_p(found),
        has_rest: told.iter().any(|told| told.rest.is_significant),
    }
}

/// An effect that is named, with what would do in its place.
fn named(found: &Findings<'_>, effect: &EffectFound, surest: f64) -> Named {
    let name = |effect: usize| found.library[effect].spec().name;
    let channels = found
        .channels()
        .into_iter()
        .filter(|channel| channel_name(channel.selection.problem.channel) == effect.channel);
    let accepted = channels.flat_map(|channel| &channel.named_from().accepted);
    let rivals = accepted.filter(|accepted| name(accepted.candidate.term.effect) == effect.name).flat_map(|accepted| {
        let over = |&(other, evidence): &(usize, f64)| (name(other), evidence - accepted.evidence);
        accepted.rivals.iter().map(over).filter(|(other, _)| *other != effect.name)
    });
    Named { name: effect.name, strength: effect.strength, surest, rivals: rivals.collect() }
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

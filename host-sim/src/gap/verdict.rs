//! What the findings of both channels come to.

use rand_chacha::ChaCha8Rng;

use super::accounted;
use super::bench::{Bench, Fit};
use super::diagnose::Found;
use super::diagnosis::{CandidateShare, ChannelGap, Diagnosis, EffectFound, Gap, Pictures, Unexplained, Verdict};
use super::interval::{self, ParameterEstimate, wilson};
use super::localise::{Raw, cells, channel_name, shares};
use super::manoeuvre::next_manoeuvre;
use super::omnibus::Finding;
use super::probability::{Standing, main_cause};
use super::select::{Analysis, INDISTINGUISHABLE};
use super::shrink::gap_closed;
use super::span::dot;
use super::spectrum::welch;
use super::whiten::{Predictor, Whitener};
use super::words;
use crate::simulator::library::FIRMWARE_MISMATCH;

/// Chance of a finding without a cause, both channels and all tests together, about.
const FALSE_ALARM: f64 = 0.004;
/// Share of the excess that may stay significant without the verdict being partial.
const SMALL_REST: f64 = 0.08;
/// Effects in a channel from which on none of it may stay.
const MANY: usize = 3;
/// Share of the excess that the best of the named effects closes on held-out parts at least, or the gap is not explained
/// even though no test finds what is left.
const LEAST_CLOSED: f64 = 0.5;
/// Effects that are listed as indistinguishable at most.
const MOST_RIVALS: usize = 5;

/// Everything of a channel that the verdict needs.
struct Side<'a, 'b> {
    analysis: &'b Analysis<'a>,
    findings: &'b [Finding],
}

/// The verdict on both channels.
pub(super) fn of(found: &Found<'_>, draw: &mut ChaCha8Rng) -> Diagnosis {
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
        (false, true) if rest_share > SMALL_REST || sides.iter().any(is_pieced_together) => Verdict::PartlyExplained,
        (false, _) => Verdict::Explained,
    };
    let standing = standing(found, &sides, &effects, has_rest, rest_share);
    let (shares_of, at_work) = main_cause(&standing);
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
        gap: gap(&sides, &effects, &channels),
        cells,
        candidates: candidates(found, shares_of),
        next_manoeuvre,
        unexplained,
        channels,
        exact_replay: Vec::new(),
        pictures: sides.iter().map(|side| pictures(side, found)).collect(),
        effects,
    };
    diagnosis.summary = words::sentence(&diagnosis);
    diagnosis
}

fn effects_of(side: &Side<'_, '_>, draw: &mut ChaCha8Rng) -> Vec<EffectFound> {
    let analysis = side.analysis;
    let (bench, fit) = (&analysis.bench, &analysis.fit);
    let mut additive = 0;
    analysis
        .named
        .iter()
        .map(|named| {
            let candidate = &named.candidate;
            let spec = bench.library[candidate.term.effect].spec();
            let (parameters, gap_closed) = if let Some(fitted) = &candidate.variance {
                let parameters = interval::of_random(bench.library, candidate, bench.whitener.samples() as f64);
                (parameters, accounted::by_variance(analysis, fitted, draw))
            } else {
                let index = additive;
                additive += 1;
                let parameters = interval::of_term(bench, fit, index, analysis.variance, draw);
                (parameters, gap_closed(bench, fit, index, analysis.variance, draw))
            };
            let mut rivals: Vec<(usize, f64)> = named
                .rivals
                .iter()
                .copied()
                .filter(|(_, evidence)| *evidence > named.evidence - INDISTINGUISHABLE)
                .collect();
            rivals.sort_by(|a, b| b.1.total_cmp(&a.1));
            let mut names: Vec<&'static str> =
                rivals.iter().map(|(effect, _)| bench.library[*effect].spec().name).collect();
            names.dedup();
            names.retain(|name| *name != spec.name);
            names.truncate(MOST_RIVALS);
            EffectFound {
                name: spec.name,
                probability: 0.0,
                parameters,
                gap_closed,
                confirmed: None,
                indistinguishable_from: names,
                load: bench.library[candidate.term.effect].load().map(String::from),
                channel: channel_name(bench.channel),
                strength: (candidate.gain / analysis.variance).max(0.0).sqrt(),
            }
        })
        .collect()
}

fn exact_effects(found: &Found<'_>) -> Vec<EffectFound> {
    let mut effects = Vec::new();
    if let Some((index, repeats)) = &found.repeats {
        let value = repeats.probability;
        let ci95 = Some(wilson(value, repeats.chances as f64));
        effects.push(EffectFound {
            name: found.library[*index].spec().name,
            probability: 0.0,
            parameters: vec![ParameterEstimate { name: "probability".into(), value: Some(value), ci95 }],
            gap_closed: accounted::by_repeats(repeats),
            confirmed: None,
            indistinguishable_from: Vec::new(),
            load: None,
            channel: "scalar",
            strength: repeats.gain.sqrt(),
        });
    }
    if let Some((index, grid)) = &found.grid {
        let step = grid.step_nt;
        let error = found.table.flux_resolution_nt * 1e-3 + 1e-6 * step;
        effects.push(EffectFound {
            name: found.library[*index].spec().name,
            probability: 0.0,
            parameters: vec![ParameterEstimate {
                name: "step_nT".into(),
                value: Some(step),
                ci95: Some([step - error, step + error]),
            }],
            gap_closed: accounted::by_grid(grid),
            confirmed: None,
            indistinguishable_from: Vec::new(),
            load: None,
            channel: "fluxgate",
            strength: (found.table.len() as f64).sqrt(),
        });
    }
    effects
}

/// Findings that noise alone would hardly make.
fn unexplained(side: &Side<'_, '_>) -> Vec<Unexplained> {
    let limit = (FALSE_ALARM / 10.0).ln();
    let of = |finding: &Finding| Unexplained {
        channel: channel_name(side.analysis.bench.channel),
        what: finding.what,
        p_value: finding.log_p.exp(),
    };
    side.findings.iter().filter(|finding| finding.log_p < limit).map(of).collect()
}

/// How much of all excess of a channel is left: what the tests found over that and what was explained.
fn rest_share(side: &Side<'_, '_>) -> f64 {
    let limit = (FALSE_ALARM / 10.0).ln();
    let rest =
        side.findings.iter().filter(|finding| finding.log_p < limit).map(|finding| finding.excess).fold(0.0, f64::max);
    let gains: f64 = side.analysis.named.iter().map(|named| named.candidate.gain / side.analysis.variance).sum();
    rest / (rest + gains).max(1e-9)
}

/// Whether so many effects were named in a channel that still shows a rest: as likely as not they are pieces of one that
/// nobody knows.
fn is_pieced_together(side: &Side<'_, '_>) -> bool {
    side.analysis.named.len() >= MANY && !unexplained(side).is_empty()
}

fn standing(
    found: &Found<'_>,
    sides: &[Side<'_, '_>],
    effects: &[EffectFound],
    has_rest: bool,
    rest_share: f64,
) -> Standing {
    let mut rivals: Vec<(&'static str, f64)> = Vec::new();
    let mut none: Vec<(&'static str, f64)> = Vec::new();
    for side in sides {
        let library = side.analysis.bench.library;
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
    Standing {
        library: names(found),
        named: effects.iter().map(|effect| (effect.name, effect.strength)).collect(),
        rivals,
        scanned: none,
        rest_log_p: strongest_rest,
        has_rest,
        rest_share,
    }
}

/// Every effect once, in the order of the library, and the one without a forward model.
fn names(found: &Found<'_>) -> Vec<&'static str> {
    let mut names: Vec<&'static str> =
        crate::simulator::library::library().iter().map(|effect| effect.spec().name).collect();
    names.push(FIRMWARE_MISMATCH);
    debug_assert!(found.library.iter().all(|effect| names.contains(&effect.spec().name)));
    names
}

fn channel_gap(side: &Side<'_, '_>) -> ChannelGap {
    let analysis = side.analysis;
    ChannelGap {
        channel: channel_name(analysis.bench.channel),
        residual_rms_nT: rms_nt(&analysis.bench, &analysis.before),
        residual_after_rms_nT: rms_nt(&analysis.bench, &analysis.fit),
        noise_floor_rms_nT: analysis.spectrum.as_ref().map_or(0.0, super::spectrum::Spectrum::std_nt),
    }
}

/// Rms of the residual of a fit with the background of each block taken out, nT.
fn rms_nt(bench: &Bench<'_>, fit: &Fit) -> f64 {
    let projected = projected_nt(bench, fit);
    (dot(&projected, &projected) / projected.len().max(1) as f64).sqrt()
}

fn projected_nt(bench: &Bench<'_>, fit: &Fit) -> Vec<f64> {
    Whitener::new(bench.whitener.blocks(), Predictor::white(1.0), None).apply(&bench.residual_nt(fit))
}

fn gap(sides: &[Side<'_, '_>], effects: &[EffectFound], channels: &[ChannelGap]) -> Gap {
    let over = |side: &Side<'_, '_>| {
        let squares = dot(&side.analysis.before.rest, &side.analysis.before.rest) / side.analysis.variance;
        squares - side.analysis.bench.whitener.freedom()
    };
    let largest = if over(&sides[1]) > over(&sides[0]) { 1 } else { 0 };
    let channel = &channels[largest];
    let excess = (channel.residual_rms_nT.powi(2) - channel.noise_floor_rms_nT.powi(2)).max(0.0).sqrt();
    let log_p = sides.iter().map(strongest).fold(0.0, f64::min);
    let exact = effects.iter().any(|effect| effect.name == "stale_sample" || effect.name == "fluxgate_quantisation");
    Gap {
        residual_rms_nT: channel.residual_rms_nT,
        noise_floor_rms_nT: channel.noise_floor_rms_nT,
        excess_rms_nT: excess,
        p_value: if exact { 0.0 } else { log_p.exp() },
        channel: channel.channel,
    }
}

/// Logarithm of the smallest chance in a channel, all tries counted.
fn strongest(side: &Side<'_, '_>) -> f64 {
    let named = side.analysis.named.iter().map(|named| named.log_p);
    let scanned = side.analysis.last_scan.iter().map(|(_, _, log_p)| *log_p);
    let tests = side.findings.iter().map(|finding| finding.log_p);
    let least = named.chain(scanned).chain(tests).fold(0.0, f64::min);
    (least + 50.0_f64.ln()).min(0.0)
}

fn cells_of(side: &Side<'_, '_>, found: &Found<'_>) -> Vec<Raw> {
    let analysis = side.analysis;
    let weights = analysis.bench.whitener.weights();
    let by_effects = weights.iter().zip(&analysis.noise_weights).map(|(all, noise)| all / noise);
    let whitened: Vec<f64> =
        analysis.before.rest.iter().zip(by_effects).map(|(z, weight)| z / weight / analysis.variance.sqrt()).collect();
    cells(&analysis.bench, found.table, &whitened)
}

fn candidates(found: &Found<'_>, shares: Vec<(&'static str, f64)>) -> Vec<CandidateShare> {
    let mut out: Vec<CandidateShare> = shares
        .into_iter()
        .map(|(name, probability)| CandidateShare {
            name,
            probability,
            identifiable_fraction: super::identifiable::fraction(found, name),
        })
        .collect();
    out.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    out
}

fn pictures(side: &Side<'_, '_>, found: &Found<'_>) -> Pictures {
    let analysis = side.analysis;
    let bench = &analysis.bench;
    let (before, after) = (projected_nt(bench, &analysis.before), projected_nt(bench, &analysis.fit));
    let rows: Vec<usize> = bench.whitener.rows().collect();
    let on_rows = |values: &[f64]| {
        let mut all = vec![0.0; found.table.len()];
        rows.iter().zip(values).for_each(|(row, value)| all[*row] = *value);
        welch(&all, bench.whitener.blocks())
    };
    let noise = analysis.spectrum.as_ref().map_or_else(Vec::new, |spectrum| {
        (1..250).map(|k| [0.02 * f64::from(k), spectrum.at(0.02 * f64::from(k))]).collect()
    });
    Pictures {
        channel: channel_name(bench.channel),
        time_s: rows.iter().map(|&row| found.table.time_s[row]).collect(),
        spectrum_before: on_rows(&before),
        spectrum_after: on_rows(&after),
        spectrum_noise: noise,
        before_nt: before,
        after_nt: after,
        rows,
    }
}

//! From evidence to probabilities: of all answers given with 0.9, nine in ten shall be right.

use crate::diagnosis::policy::{
    EVIDENCE_PER_NAT, LEAST_OF_NONE, NONE_LESS_PER_DECADE, NONE_SIGN_DECADES, SHARPNESS, SUREST_OF_NONE,
};

/// Where everything stands after the search.
pub(crate) struct EvidenceSummary {
    /// Every name that may be a cause.
    pub(crate) library: Vec<&'static str>,
    /// What was named, with its strength in standard deviations, and the probability that it has without rivals.
    pub(crate) named: Vec<(&'static str, f64, f64)>,
    /// What would do instead, with its evidence over that of the effect named (mostly negative).
    pub(crate) rivals: Vec<(&'static str, f64)>,
    /// What was looked for in the end, with its evidence over nothing.
    pub(crate) scanned: Vec<(&'static str, f64)>,
    /// Logarithm of the chance that noise alone shows as much, whatever it is, all tries counted.
    pub(crate) log_p: f64,
    /// Whether something significant is left.
    pub(crate) has_rest: bool,
}

/// Probability of each name to be the main cause, and of each named effect to be at work.
pub(crate) fn main_cause(summary: &EvidenceSummary) -> (Vec<(&'static str, f64)>, Vec<f64>) {
    let mut shares: Vec<(&'static str, f64)> = summary.library.iter().map(|name| (*name, 0.0)).collect();
    shares.extend([("none", 0.0), ("unknown", 0.0)]);
    let at_work: Vec<f64> = summary.named.iter().map(|named| posterior(summary, named)).collect();
    if summary.named.is_empty() {
        nothing_named(summary, &mut shares);
    } else {
        something_named(summary, &at_work, &mut shares);
    }
    let total: f64 = shares.iter().map(|(_, share)| share).sum();
    shares.iter_mut().for_each(|(_, share)| *share /= total);
    let at_work = match summary.named.as_slice() {
        [(name, ..)] => vec![share_of(&shares, name)],
        _ => at_work,
    };
    (shares, at_work)
}

fn share_of(shares: &[(&'static str, f64)], name: &str) -> f64 {
    shares.iter().find(|(other, _)| *other == name).map_or(0.0, |(_, share)| *share)
}

/// That a named effect is at work: by how far it stands out, and by its rivals.
fn posterior(summary: &EvidenceSummary, (name, strength, surest): &(&'static str, f64, f64)) -> f64 {
    let rivals: f64 = summary
        .rivals
        .iter()
        .filter(|(other, _)| other != name)
        .map(|(_, evidence)| (evidence / EVIDENCE_PER_NAT).min(0.0).exp())
        .sum();
    let weak = 1.0 / (1.0 + (-(strength - 3.5)).exp());
    surest * weak / (1.0 + rivals)
}

fn something_named(summary: &EvidenceSummary, at_work: &[f64], shares: &mut [(&'static str, f64)]) {
    let strongest = summary.named.iter().map(|(_, strength, _)| *strength).fold(1e-9, f64::max);
    let weight = |strength: f64| (strength / strongest).powi(SHARPNESS);
    let all: f64 = summary.named.iter().map(|(_, strength, _)| weight(*strength)).sum();
    let mut left = 1.0;
    for ((name, strength, _), probability) in summary.named.iter().zip(at_work) {
        let share = if summary.named.len() == 1 { *probability } else { probability * weight(*strength) / all };
        add(shares, name, share);
        left -= share;
    }
    let weights: Vec<f64> =
        summary.rivals.iter().map(|(_, evidence)| (evidence / EVIDENCE_PER_NAT).min(0.0).exp()).collect();
    let total: f64 = weights.iter().sum::<f64>() + 0.3;
    for ((name, _), weight) in summary.rivals.iter().zip(&weights) {
        add(shares, name, left * 0.9 * weight / total);
    }
    add(shares, "unknown", left * (0.9 * 0.3 / total + 0.08));
    add(shares, "none", left * 0.02);
}

fn nothing_named(summary: &EvidenceSummary, shares: &mut [(&'static str, f64)]) {
    let (none, unknown) = if summary.has_rest {
        (0.02, 0.9)
    } else {
        let none = none_of(summary.log_p);
        (none, 0.5 * (1.0 - none))
    };
    add(shares, "none", none);
    add(shares, "unknown", unknown);
    let left = 1.0 - none - unknown;
    let weights: Vec<f64> =
        summary.scanned.iter().map(|(_, evidence)| (0.5 * evidence).clamp(-20.0, 10.0).exp()).collect();
    let total: f64 = weights.iter().sum::<f64>();
    for ((name, _), weight) in summary.scanned.iter().zip(&weights) {
        add(shares, name, left * weight / total.max(1e-12));
    }
}

/// Probability of `none` where nothing is named: less, where there is something that only just was not enough.
fn none_of(log_p: f64) -> f64 {
    let decades = -log_p / std::f64::consts::LN_10 - NONE_SIGN_DECADES;
    (SUREST_OF_NONE - NONE_LESS_PER_DECADE * decades.max(0.0)).max(LEAST_OF_NONE)
}

fn add(shares: &mut [(&'static str, f64)], name: &str, share: f64) {
    if let Some((_, sum)) = shares.iter_mut().find(|(other, _)| *other == name) {
        *sum += share.max(0.0);
    }
}

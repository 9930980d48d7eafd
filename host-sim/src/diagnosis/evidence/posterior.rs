//! From evidence to probabilities: of all answers given with 0.9, nine in ten shall be right.

use crate::diagnosis::policy::{
    EVIDENCE_PER_NAT, LEAST_OF_NONE, NONE_LESS_PER_DECADE, NONE_SIGN_DECADES, SHARPNESS, SUREST_OF_NONE,
};

/// Where everything stands after the search.
pub(crate) struct EvidenceSummary {
    /// Every name that may be a cause.
    pub(crate) library: Vec<&'static str>,
    /// What was named.
    pub(crate) named: Vec<Named>,
    /// What was looked for in the end, with its evidence over nothing.
    pub(crate) scanned: Vec<(&'static str, f64)>,
    /// Logarithm of the chance that noise alone shows as much, whatever it is, all tries counted.
    pub(crate) log_p: f64,
    /// Whether something significant is left.
    pub(crate) has_rest: bool,
}

/// An effect that was named.
pub(crate) struct Named {
    pub(crate) name: &'static str,
    /// In standard deviations.
    pub(crate) strength: f64,
    /// The probability that it has without rivals.
    pub(crate) surest: f64,
    /// What would do in its place, the other effects staying, with its evidence over that of this one (mostly negative).
    pub(crate) rivals: Vec<(&'static str, f64)>,
}

/// Probability of each name to be the main cause, and of each named effect to be at work.
pub(crate) fn main_cause(summary: &EvidenceSummary) -> (Vec<(&'static str, f64)>, Vec<f64>) {
    let mut shares: Vec<(&'static str, f64)> = summary.library.iter().map(|name| (*name, 0.0)).collect();
    shares.extend([("none", 0.0), ("unknown", 0.0)]);
    if summary.named.is_empty() {
        nothing_named(summary, &mut shares);
    } else {
        something_named(&summary.named, &mut shares);
    }
    let total: f64 = shares.iter().map(|(_, share)| share).sum();
    shares.iter_mut().for_each(|(_, share)| *share /= total);
    let at_work = match summary.named.as_slice() {
        [named] => vec![share_of(&shares, named.name)],
        several => several.iter().map(Named::posterior).collect(),
    };
    (shares, at_work)
}

fn share_of(shares: &[(&'static str, f64)], name: &str) -> f64 {
    shares.iter().find(|(other, _)| *other == name).map_or(0.0, |(_, share)| *share)
}

impl Named {
    /// That it is at work: by how far it stands out, and by its rivals.
    fn posterior(&self) -> f64 {
        let rivals: f64 = self.rivals.iter().map(|&(_, evidence)| odds(evidence)).sum();
        let weak = 1.0 / (1.0 + (-(self.strength - 3.5)).exp());
        self.surest * weak / (1.0 + rivals)
    }

    /// Share out the probability that the main cause is this one, or what is taken for it.
    fn share_out(&self, mass: f64, shares: &mut [(&'static str, f64)]) {
        let own = mass * self.posterior();
        let left = mass - own;
        add(shares, self.name, own);
        let total: f64 = self.rivals.iter().map(|&(_, evidence)| odds(evidence)).sum::<f64>() + 0.3;
        for &(name, evidence) in &self.rivals {
            add(shares, name, left * 0.9 * odds(evidence) / total);
        }
        add(shares, "unknown", left * (0.9 * 0.3 / total + 0.08));
        add(shares, "none", left * 0.02);
    }
}

/// Of another effect against the one that was named, from its evidence over that of this one.
fn odds(evidence: f64) -> f64 {
    (evidence / EVIDENCE_PER_NAT).min(0.0).exp()
}

/// The strongest is the main cause, the more likely the more it stands out of the others.
fn something_named(named: &[Named], shares: &mut [(&'static str, f64)]) {
    let strongest = named.iter().map(|named| named.strength).fold(1e-9, f64::max);
    let weight = |named: &Named| (named.strength / strongest).powi(SHARPNESS);
    let all: f64 = named.iter().map(weight).sum();
    for one in named {
        one.share_out(weight(one) / all, shares);
    }
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

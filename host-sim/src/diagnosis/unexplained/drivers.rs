//! Which input drives what is left, with what probability.

use std::collections::BTreeMap;

use super::judged::Judged;
use super::loudness::{Louder, comes_back};
use crate::diagnosis::policy::{
    DRIVER_BEHIND, DRIVER_BEYOND_CHANCE, DRIVER_LOUDNESS_WEIGHT, DRIVER_MOST_CLOSED, DRIVER_NONE_SHARE,
    DRIVER_SHARPNESS, DRIVER_TIME_LOUDNESS_WEIGHT, DRIVER_TIME_START, DRIVER_UNSURE,
};
use crate::diagnosis::result::DriverShare;

/// How much an input explains, and the logarithm of how much likelier it makes the residual.
#[derive(Clone, Copy, Default)]
struct Standing {
    /// On parts held out.
    closed: f64,
    /// That, or what the evidence alone says: a fit that does harm on one part of four has not shown that nothing is there.
    share: f64,
    gain: Option<f64>,
}

/// Every input with its probability, most probable first. `excess` is the sum of squares above noise; `is_in_time` says whether
/// something beside the drivers shows that the rest comes and goes: bursts, hops, tones.
pub(super) fn drivers(judged: &[Judged], louder: &[Louder], excess: f64, is_in_time: bool) -> Vec<DriverShare> {
    let mut inputs: BTreeMap<&str, Standing> = BTreeMap::new();
    for judged in judged {
        let own = inputs.entry(&judged.group.input).or_default();
        let closed = if is_beyond_chance(judged) { judged.taken / excess } else { 0.0 };
        let gain = judged.gain_of_rest();
        own.gain = Some(own.gain.map_or(gain, |most: f64| most.max(gain)));
        own.closed = own.closed.max(closed);
        let by_evidence = judged.share_by_evidence() * judged.folded.all.zz / excess.max(f64::MIN_POSITIVE);
        own.share = own.share.max(closed).max(if is_beyond_chance(judged) { by_evidence } else { 0.0 });
    }
    let most = inputs.values().map(|own| own.share).fold(0.0, f64::max).min(1.0);
    for louder in louder {
        // A temperature mostly goes one way over a recording: what is louder later is louder where it is warmer, too.
        let weight = if comes_back(&louder.input) { DRIVER_LOUDNESS_WEIGHT } else { DRIVER_TIME_LOUDNESS_WEIGHT };
        // What is left of a course is louder where that is large, and more so what is left beside its shapes: only what no course
        // explains is told of loudness.
        let share = louder.share * weight * (1.0 - most).powi(2);
        raise(inputs.entry(&louder.input).or_default(), share);
    }
    for input in ["none", "time_irregular"] {
        let start = if (input == "none") != is_in_time { DRIVER_TIME_START } else { DRIVER_NONE_SHARE };
        raise(inputs.entry(input).or_default(), start);
    }
    let best_gain = inputs.values().filter_map(|own| own.gain).fold(0.0, f64::max);
    let odds = |own: &Standing| {
        let behind = own.gain.map_or(0.0, |gain| (best_gain - gain.max(0.0)).sqrt());
        let by_share = -DRIVER_SHARPNESS * (1.0 - own.share.clamp(0.0, DRIVER_MOST_CLOSED)).ln();
        (by_share - DRIVER_BEHIND * behind).exp()
    };
    let total: f64 = inputs.values().map(odds).sum();
    let even = 1.0 / inputs.len() as f64;
    let share = |(input, own): (&&str, &Standing)| DriverShare {
        input: (*input).to_string(),
        probability: (1.0 - DRIVER_UNSURE) * odds(own) / total + DRIVER_UNSURE * even,
        closed: own.closed,
    };
    let mut drivers: Vec<DriverShare> = inputs.iter().map(share).collect();
    drivers.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    drivers
}

/// Whether a group does more than it would turned round in time.
pub(super) fn is_beyond_chance(judged: &Judged) -> bool {
    judged.beyond_chance() > DRIVER_BEYOND_CHANCE && judged.net_gain() > 0.0
}

/// What is known by its share alone is not held back by its evidence; nor is it closed by that.
fn raise(own: &mut Standing, share: f64) {
    if share > own.share {
        *own = Standing { share, gain: None, ..*own };
    }
}

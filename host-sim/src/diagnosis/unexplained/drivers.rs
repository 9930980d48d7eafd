//! Which input drives what is left, with what probability.

use std::collections::BTreeMap;

use super::group::Judged;
use super::loudness::Louder;
use crate::diagnosis::policy::{
    DRIVER_BEYOND_CHANCE, DRIVER_LOUDNESS_WEIGHT, DRIVER_MOST_CLOSED, DRIVER_NONE_SHARE, DRIVER_SHARPNESS,
    DRIVER_TIME_START,
};
use crate::diagnosis::result::DriverShare;

/// Inputs that no column of the recording has.
pub(crate) const IN_TIME: [&str; 2] = ["time_periodic", "time_irregular"];

/// Every input with its probability, most probable first. `is_in_time` says whether something beside the drivers shows that the rest
/// comes and goes: bursts, hops, tones.
pub(super) fn drivers(judged: &[Judged], louder: &[Louder], is_in_time: bool) -> Vec<DriverShare> {
    let mut closed: BTreeMap<&str, f64> = BTreeMap::new();
    for judged in judged {
        let is_beyond = judged.beyond_chance() > DRIVER_BEYOND_CHANCE && judged.net_gain() > 0.0;
        raise(&mut closed, &judged.group.input, if is_beyond { judged.closed } else { 0.0 });
    }
    let least_of_mean = closed.values().copied().fold(0.0, f64::max);
    for louder in louder {
        // What is left of a course is louder where that is large: only what no course explains is told of loudness.
        raise(&mut closed, &louder.input, louder.share * DRIVER_LOUDNESS_WEIGHT * (1.0 - least_of_mean));
    }
    for input in ["none", "time_irregular"] {
        let start = if (input == "none") != is_in_time { DRIVER_TIME_START } else { DRIVER_NONE_SHARE };
        raise(&mut closed, input, start);
    }
    let odds = |share: f64| (-DRIVER_SHARPNESS * (1.0 - share.clamp(0.0, DRIVER_MOST_CLOSED)).ln()).exp();
    let total: f64 = closed.values().map(|share| odds(*share)).sum();
    let share = |(input, closed): (&&str, &f64)| DriverShare {
        input: (*input).to_string(),
        probability: odds(*closed) / total,
        closed: *closed,
    };
    let mut drivers: Vec<DriverShare> = closed.iter().map(share).collect();
    drivers.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    drivers
}

fn raise<'b>(closed: &mut BTreeMap<&'b str, f64>, input: &'b str, share: f64) {
    let best = closed.entry(input).or_insert(0.0);
    *best = best.max(share);
}

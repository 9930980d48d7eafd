//! Whether of all answers given with nine tenths, nine in ten are right.

use serde::Serialize;

use super::judged::Judged;
use super::rate::Rate;
use crate::answer::Kind;

/// Bins, with as many recordings in each.
const BINS: usize = 10;

/// Of the most probable candidate of each recording.
#[derive(Clone, Debug, Serialize)]
pub struct Calibration {
    /// Mean distance between what was promised and what came.
    pub expected_error: f64,
    /// Least probable first.
    pub bins: Vec<Promise>,
}

/// Answers of about one probability.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Promise {
    /// Mean probability that was given.
    pub promised: f64,
    /// Share that was right.
    pub came: Rate,
}

pub(super) fn of(all: &[Judged<'_>], withheld: Option<&str>) -> Calibration {
    let mut said: Vec<(f64, bool)> = all.iter().filter_map(|judged| top(judged, withheld)).collect();
    said.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = said.len();
    let bin = |k: usize| &said[k * count / BINS..(k + 1) * count / BINS];
    let promise = |own: &[(f64, bool)]| Promise {
        promised: own.iter().map(|(promised, _)| promised).sum::<f64>() / own.len() as f64,
        came: Rate::count(own, |(_, is_right)| *is_right),
    };
    let bins: Vec<Promise> = (0..BINS).map(bin).filter(|own| !own.is_empty()).map(promise).collect();
    let off = |bin: &Promise| (bin.promised - bin.came.share().unwrap_or(0.0)).abs() * bin.came.of as f64;
    Calibration { expected_error: bins.iter().map(off).sum::<f64>() / count.max(1) as f64, bins }
}

/// Probability of the most probable candidate, and whether it is right.
fn top((answer, result): &Judged<'_>, withheld: Option<&str>) -> Option<(f64, bool)> {
    let candidates = result.diagnosis.said().candidates.iter();
    let top = candidates.max_by(|a, b| a.probability.total_cmp(&b.probability))?;
    let is_hidden = |name: &str| answer.hidden.iter().any(|hidden| hidden.name == name);
    let is_right = match answer.kind {
        Kind::None => top.name == "none",
        Kind::Foreign => top.name == "unknown",
        _ => is_hidden(&top.name) || (top.name == "unknown" && withheld.is_some_and(is_hidden)),
    };
    Some((top.probability, is_right))
}

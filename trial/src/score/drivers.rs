//! What is said to drive what has no name.

use std::collections::BTreeMap;

use serde::Serialize;

use super::judged::{Judged, level, median};
use super::rate::Rate;
use crate::answer::Kind;
use crate::said::{SaidDriver, SaidRest};
use crate::strength::STRENGTHS;

/// Inputs that no column of a recording has.
const NOT_RECORDED: [&str; 3] = ["none", "time_periodic", "time_irregular"];
/// Bins of the calibration, with as many recordings in each.
const BINS: usize = 10;

/// Recordings that hide one thing that has no name, of strength 3 and more.
#[derive(Clone, Debug, Serialize)]
pub struct DriverScore {
    /// Driven by something recorded: whether the rest is described at all.
    pub recorded_described: Rate,
    /// Of those, the right driver first.
    pub recorded_right: Rate,
    /// Driven by nothing recorded, described: `none` or a driver in time first.
    pub unrecorded_right: Rate,
    /// Of those, with an effect proposed all the same.
    pub proposed_without_driver: Rate,
    /// Driven by something recorded, and not by chance: with an effect proposed.
    pub proposed_with_driver: Rate,
    /// The same: share of the excess that the proposal closes on parts held out, 0 where there is none; the true term would close all
    /// of it.
    pub median_closed: Option<f64>,
    /// Mean distance between the probability of the first driver and how often it is right.
    pub calibration_error: Option<f64>,
    /// Right drivers first, by what is hidden.
    pub right_by_name: BTreeMap<String, Rate>,
    /// What is hidden, then the first driver said, then how often.
    pub said_by_name: BTreeMap<String, BTreeMap<String, usize>>,
}

/// `withheld` is the effect that was taken out.
pub(super) fn of(all: &[Judged<'_>], withheld: Option<&str>) -> Option<DriverScore> {
    let is_nameless = |(answer, _): &Judged<'_>| match &answer.hidden[..] {
        [one] => answer.kind == Kind::Foreign || withheld == Some(&one.name),
        _ => false,
    };
    let strong = |judged: &Judged<'_>| level(judged) >= STRENGTHS[1];
    let own: Vec<Judged<'_>> = all.iter().copied().filter(is_nameless).filter(strong).collect();
    if own.is_empty() {
        return None;
    }
    let (recorded, unrecorded): (Vec<Judged<'_>>, Vec<Judged<'_>>) =
        own.iter().copied().partition(|(answer, _)| !answer.drivers.is_empty());
    let (described_recorded, described_unrecorded) = (described(&recorded), described(&unrecorded));
    let determined: Vec<Judged<'_>> =
        described_recorded.iter().copied().filter(|(answer, _)| !answer.is_random).collect();
    let closed = |judged: &Judged<'_>| rest(judged).and_then(|rest| rest.gap_closed).map(|closed| closed.fraction);
    let all_described = described(&own);
    Some(DriverScore {
        recorded_described: Rate::count(&recorded, |judged| first(judged).is_some()),
        recorded_right: Rate::count(&described_recorded, is_right),
        unrecorded_right: Rate::count(&described_unrecorded, is_right),
        proposed_without_driver: Rate::count(&described_unrecorded, |judged| closed(judged).is_some()),
        proposed_with_driver: Rate::count(&determined, |judged| closed(judged).is_some()),
        median_closed: median(determined.iter().map(|judged| closed(judged).unwrap_or(0.0)).collect()),
        calibration_error: calibration_error(&all_described),
        right_by_name: by_name(&all_described),
        said_by_name: said_by_name(&all_described),
    })
}

fn described<'a>(of: &[Judged<'a>]) -> Vec<Judged<'a>> {
    of.iter().copied().filter(|judged| first(judged).is_some()).collect()
}

fn rest<'a>((_, result): &Judged<'a>) -> Option<&'a SaidRest> {
    result.diagnosis.said().unexplained.as_ref()
}

fn first<'a>(judged: &Judged<'a>) -> Option<&'a SaidDriver> {
    rest(judged)?.drivers.first()
}

fn is_right(judged: &Judged<'_>) -> bool {
    let Some(first) = first(judged) else { return false };
    match &judged.0.drivers[..] {
        [] => NOT_RECORDED.contains(&first.input.as_str()),
        drivers => drivers.contains(&first.input),
    }
}

/// Of what counts as one answer together: all that is right.
fn promised(judged: &Judged<'_>) -> Option<f64> {
    let (drivers, first) = (&rest(judged)?.drivers, first(judged)?);
    let is_as_first = |driver: &&SaidDriver| match NOT_RECORDED.contains(&first.input.as_str()) {
        true => NOT_RECORDED.contains(&driver.input.as_str()),
        false => driver.input == first.input,
    };
    Some(drivers.iter().filter(is_as_first).map(|driver| driver.probability).sum())
}

fn calibration_error(described: &[Judged<'_>]) -> Option<f64> {
    let mut said: Vec<(f64, bool)> =
        described.iter().filter_map(|judged| Some((promised(judged)?, is_right(judged)))).collect();
    said.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = said.len();
    let off = |k: usize| {
        let bin = &said[k * count / BINS..(k + 1) * count / BINS];
        let promised: f64 = bin.iter().map(|(promised, _)| promised).sum();
        (promised - bin.iter().filter(|(_, is_right)| *is_right).count() as f64).abs()
    };
    (count > 0).then(|| (0..BINS).map(off).sum::<f64>() / count as f64)
}

fn by_name(described: &[Judged<'_>]) -> BTreeMap<String, Rate> {
    let mut groups: BTreeMap<String, Vec<Judged<'_>>> = BTreeMap::new();
    described.iter().for_each(|judged| groups.entry(judged.0.hidden[0].name.clone()).or_default().push(*judged));
    groups.into_iter().map(|(name, own)| (name, Rate::count(&own, is_right))).collect()
}

fn said_by_name(described: &[Judged<'_>]) -> BTreeMap<String, BTreeMap<String, usize>> {
    let mut said: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for judged in described {
        let input = first(judged).map_or_else(String::new, |first| first.input.clone());
        *said.entry(judged.0.hidden[0].name.clone()).or_default().entry(input).or_default() += 1;
    }
    said
}

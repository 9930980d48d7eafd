//! The positions that a receiver gave, without those that it made up.

use super::fix::{Fix, limit_m};
use super::jumps::{ReceiverFault, between_jumps};
use super::projection::Projection;
use crate::statistics::median;

/// What is left of the positions of a recording.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fixes {
    /// In the order of time; those of one part have no step between them.
    pub(crate) kept: Vec<Vec<Fix>>,
    /// How many the kept ones are made from.
    pub(crate) used: usize,
    /// What the receiver did that no body can.
    pub(crate) faults: Vec<ReceiverFault>,
    /// Zeros, places that are not on Earth, those far off their neighbours, and what a receiver that hangs repeats.
    pub(crate) dropped: usize,
}

/// Columns of positions.
#[derive(Clone, Copy)]
pub(crate) struct Degrees<'a> {
    pub(crate) time_s: &'a [f64],
    pub(crate) latitude_deg: &'a [f64],
    pub(crate) longitude_deg: &'a [f64],
}

/// A position that stays the same to its last digit for longer is that of a receiver that hangs, s: the noise of one that stands changes
/// 1e-5 degrees in less, and a body on tow goes as far in 10 s.
const FROZEN_S: f64 = 30.0;
/// Neighbours of a fix lie within this time, s: a ship, and a drone too, turns steadily in it, and a receiver that has lost
/// its satellites is often back by then.
const NEIGHBOURS_S: f64 = 5.0;
/// Neighbours on each side that there are at most: no more is needed of a fast receiver.
const MOST_NEIGHBOURS: usize = 50;

/// The fixes of a recording, on this projection; times are moved by the lag.
///
/// A recorder at 10 Hz repeats the last position of a slower receiver: only the row in which it is new counts.
pub(crate) fn fixes(columns: &Degrees<'_>, lag_s: f64, projection: &Projection) -> Fixes {
    let placed = placed(columns);
    let hold_s = hold_s(&placed);
    let (mut all, mut dropped): (Vec<Fix>, usize) = (Vec::new(), 0);
    for same in placed.chunk_by(|a, b| a[1..] == b[1..]) {
        let is_frozen = same[same.len() - 1][0] - same[0][0] > FROZEN_S;
        let mut since_s: Option<f64> = None;
        for &[time_s, latitude_deg, longitude_deg] in same {
            if since_s.is_some_and(|since_s| time_s - since_s < hold_s) {
                continue;
            }
            let is_place = is_place(latitude_deg, longitude_deg) && !(is_frozen && since_s.is_some());
            since_s = Some(time_s);
            match projection.plane(latitude_deg, longitude_deg).filter(|_| is_place) {
                Some(place_m) => all.push(Fix { time_s: time_s - lag_s, place_m }),
                None => dropped += 1,
            }
        }
    }
    let kept = near_neighbours(&all);
    let (parts, faults) = between_jumps(&kept);
    let used = parts.iter().map(Vec::len).sum();
    Fixes { used, dropped: dropped + all.len() - used, faults, kept: parts.iter().map(|part| means(part)).collect() }
}

/// Fixes that come faster are averaged over this, s. What comes at 10 Hz is most often a receiver of 1 Hz, led straight from
/// fix to fix, whose noise is anything but white from row to row; of a receiver that is as fast nothing is lost but 4 mm
/// in a turn at 0.1 m/s2 (a T^2 / 24).
const MEAN_S: f64 = 1.0;

/// The mean time and place of each second; of a slower receiver the fixes themselves.
fn means(fixes: &[Fix]) -> Vec<Fix> {
    let second = |fix: &Fix| (fix.time_s / MEAN_S).floor();
    let mean = |fixes: &[Fix]| {
        // About the first: sums of northings would lose digits.
        let (first, count) = (fixes[0], fixes.len() as f64);
        let about =
            |of: fn(&Fix) -> f64| of(&first) + fixes.iter().map(|fix| of(fix) - of(&first)).sum::<f64>() / count;
        Fix { time_s: about(|fix| fix.time_s), place_m: [about(|fix| fix.place_m[0]), about(|fix| fix.place_m[1])] }
    };
    fixes.chunk_by(|a, b| second(a) == second(b)).map(mean).collect()
}

/// Whether a receiver can be there. Zero and zero is what many write before they know.
pub(crate) fn is_place(latitude_deg: f64, longitude_deg: f64) -> bool {
    latitude_deg.abs() <= 90.0 && longitude_deg.abs() <= 180.0 && (latitude_deg, longitude_deg) != (0.0, 0.0)
}

/// Time, latitude and longitude of the rows that have them, in the order of time.
fn placed(columns: &Degrees<'_>) -> Vec<[f64; 3]> {
    let rows = columns.time_s.iter().zip(columns.latitude_deg).zip(columns.longitude_deg);
    let mut latest_s = f64::NEG_INFINITY;
    let mut is_later = |time_s: f64| {
        let is_later = time_s > latest_s;
        latest_s = latest_s.max(time_s);
        is_later
    };
    let known = rows.map(|((&time_s, &latitude_deg), &longitude_deg)| [time_s, latitude_deg, longitude_deg]);
    known.filter(|row| row.iter().all(|value| value.is_finite())).filter(|[time_s, ..]| is_later(*time_s)).collect()
}

/// How long a position that is the same is the same fix: one and a half times the usual time between changes.
fn hold_s(placed: &[[f64; 3]]) -> f64 {
    let changes = placed.windows(2).filter(|pair| pair[0][1..] != pair[1][1..]).map(|pair| pair[1][0]);
    let times: Vec<f64> = changes.collect();
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    1.5 * median(&mut steps).unwrap_or(f64::INFINITY)
}

/// The fixes that lie where those around them say.
fn near_neighbours(all: &[Fix]) -> Vec<Fix> {
    let off_m: Vec<f64> = (0..all.len()).map(|at| off_m(all, at)).collect();
    let limit_m = limit_m(&mut off_m.clone());
    all.iter().zip(off_m).filter(|(_, off_m)| *off_m <= limit_m).map(|(fix, _)| *fix).collect()
}

/// How far a fix lies off an even or steadily turning way through its neighbours, which medians find though some are wrong.
fn off_m(all: &[Fix], at: usize) -> f64 {
    let fix = &all[at];
    let is_near = |other: &&Fix| (other.time_s - fix.time_s).abs() <= NEIGHBOURS_S;
    let before: Vec<&Fix> = all[..at].iter().rev().take(MOST_NEIGHBOURS).take_while(is_near).collect();
    let after: Vec<&Fix> = all[at + 1..].iter().take(MOST_NEIGHBOURS).take_while(is_near).collect();
    // Of one side alone nothing can be said but by extrapolating.
    if before.len() < 2 || after.len() < 2 {
        return 0.0;
    }
    let of_axis = |axis: usize| {
        let pairs = before.iter().zip(&after);
        let speed = |(a, b): (&&Fix, &&Fix)| (b.place_m[axis] - a.place_m[axis]) / (b.time_s - a.time_s);
        let speed_m_per_s = median(&mut pairs.map(speed).collect::<Vec<_>>()).unwrap_or(0.0);
        // Without the speed: the squared time and the place, those before and after in turn, the nearest first.
        let still = |other: &Fix| {
            let time_s = other.time_s - fix.time_s;
            [time_s * time_s, other.place_m[axis] - speed_m_per_s * time_s]
        };
        let still: Vec<[f64; 2]> = before.iter().zip(&after).flat_map(|(a, b)| [still(a), still(b)]).collect();
        fix.place_m[axis] - at_the_middle(&still)
    };
    of_axis(0).hypot(of_axis(1))
}

/// The place at time zero of a parabola through places at squared times: its curvature is the median of those from the
/// nearer half to the further one.
fn at_the_middle(still: &[[f64; 2]]) -> f64 {
    let (near, far) = still.split_at(still.len() / 2);
    let mut curvatures: Vec<f64> = near
        .iter()
        .zip(far)
        .map(|([s, place], [t, further])| (further - place) / (t - s))
        .filter(|c| c.is_finite())
        .collect();
    let curvature = median(&mut curvatures).unwrap_or(0.0);
    median(&mut still.iter().map(|[square, place]| place - curvature * square).collect::<Vec<_>>()).unwrap_or(0.0)
}

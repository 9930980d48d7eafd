//! The way along the track, and its shape.

use std::ops::Range;

use nalgebra::Vector3;

use super::dipole::Dipole;
use super::levelled::{Levelled, RATE_HZ, WayBy};
use super::shape::Shape;

/// The way along the track of every row, in metres where a track is known, else in seconds.
#[derive(Clone, Debug)]
pub(super) struct Way {
    /// Of every row; finite everywhere.
    pub(super) at: Vec<f64>,
    /// Way a second, of every row.
    pub(super) per_s: Vec<f64>,
    /// Whether it is in metres.
    pub(super) is_metres: bool,
    /// `None` where nothing tells it from a straight line.
    pub(super) shape: Option<Shape>,
}

/// A point of the way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) at: f64,
    /// East, north, down, m; along the way alone where its shape is not known.
    pub(super) place: Vector3<f64>,
}

/// Speeds below this are no passing, m/s.
pub(super) const LEAST_SPEED_M_PER_S: f64 = 0.2;

impl Way {
    /// By what is asked for, or by positions where nothing else tells the way.
    pub(super) fn by(way_by: WayBy, levelled: &Levelled<'_>) -> Self {
        let steady = if way_by == WayBy::Heading { Self::by_heading(levelled) } else { None };
        steady.unwrap_or_else(|| Self::by_positions(levelled))
    }

    /// A dipole of another way, at the same time.
    pub(super) fn taken_over(&self, dipole: &Dipole, from: &Self) -> Dipole {
        let row = from.row_at(dipole.at);
        let ratio = self.per_s[row] / from.per_s[row];
        let at = self.at[row] + ratio * (dipole.at - from.at[row]);
        Dipole { at, distance: dipole.distance * ratio, ..*dipole }
    }

    pub(super) fn by_positions(levelled: &Levelled<'_>) -> Self {
        let time_s = filled(levelled.time_s);
        let Some(track) = levelled.track else { return Self::of_time(time_s, levelled) };
        if track.along_m.iter().filter(|m| m.is_finite()).count() < 2 {
            return Self::of_time(time_s, levelled);
        }
        let at = filled(&track.along_m);
        // Over two seconds: the speed over ground of one row is as noisy as its position.
        let span = RATE_HZ as usize;
        let slope = |row: usize| {
            let (from, to) = (row.saturating_sub(span), (row + span).min(at.len() - 1));
            ((at[to] - at[from]) / (time_s[to] - time_s[from])).max(LEAST_SPEED_M_PER_S)
        };
        let per_s = (0..at.len()).map(|row| Some(slope(row)).filter(|v| v.is_finite()).unwrap_or(1.0)).collect();
        let shape = Shape::of(&at, levelled, true);
        Self { at, per_s, is_metres: true, shape }
    }

    /// The first row that is no nearer than this, or the last.
    pub(super) fn row_at(&self, at: f64) -> usize {
        self.at.partition_point(|way| *way < at).min(self.at.len() - 1)
    }

    /// The rows within so many distances of a dipole along the way.
    pub(super) fn rows_about(&self, dipole: &Dipole, distances: f64) -> Range<usize> {
        let reach = distances * dipole.distance;
        let from = self.at.partition_point(|at| *at < dipole.at - reach);
        from..self.at.partition_point(|at| *at <= dipole.at + reach).max(from)
    }

    /// Where one is so far along.
    pub(super) fn spot(&self, at: f64) -> Spot {
        let Some(shape) = &self.shape else { return Spot { at, place: Vector3::new(at, 0.0, 0.0) } };
        let after = self.row_at(at).max(1);
        let [from, to] = [self.at[after - 1], self.at[after]];
        let share = if to > from { ((at - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        let place = shape.places_m[after - 1].lerp(&shape.places_m[after], share);
        Spot { at, place }
    }

    /// Where one is in a row.
    pub(super) fn spot_of_row(&self, row: usize) -> Spot {
        let at = self.at[row];
        let place = self.shape.as_ref().map_or_else(|| Vector3::new(at, 0.0, 0.0), |shape| shape.places_m[row]);
        Spot { at, place }
    }

    /// At one and the same speed.
    fn of_time(time_s: Vec<f64>, levelled: &Levelled<'_>) -> Self {
        let shape = Shape::of(&time_s, levelled, false);
        Self { per_s: vec![1.0; time_s.len()], at: time_s, is_metres: false, shape }
    }
}

/// The values with those that are missing put on a line between their neighbours, at the ends on by the mean step.
fn filled(values: &[f64]) -> Vec<f64> {
    let known: Vec<usize> = (0..values.len()).filter(|&k| values[k].is_finite()).collect();
    let (Some(&first), Some(&last)) = (known.first(), known.last()) else {
        return (0..values.len()).map(|k| k as f64 / RATE_HZ).collect();
    };
    let step = if last > first { (values[last] - values[first]) / (last - first) as f64 } else { 1.0 / RATE_HZ };
    let mut out = values.to_vec();
    (0..first).for_each(|k| out[k] = values[first] - (first - k) as f64 * step);
    (last + 1..values.len()).for_each(|k| out[k] = values[last] + (k - last) as f64 * step);
    for pair in known.windows(2).filter(|pair| pair[1] > pair[0] + 1) {
        let slope = (values[pair[1]] - values[pair[0]]) / (pair[1] - pair[0]) as f64;
        (pair[0] + 1..pair[1]).for_each(|k| out[k] = values[pair[0]] + (k - pair[0]) as f64 * slope);
    }
    out
}

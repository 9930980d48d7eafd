//! The simulator's clean signals, reconstructed from a recording.

use std::ops::Range;

use crate::diagnosis::numerics::lagrange;
use crate::diagnosis::policy::{BRIDGED_ROWS, EPOCH_S, LONGEST_PAUSE_S, RATE_HZ, SLOW_FIELD_ROWS, TEMPERATURE_ROWS};
use crate::diagnosis::reconstruct::prepared::{Prepared, fill_holes};
use crate::diagnosis::reconstruct::smooth::{slow, smooth_dense};
use crate::diagnosis::reconstruct::tangent_plane::{TangentPlane, unit};
use crate::simulator::signals::{Grid, LONGEST_STEP_S, Trajectory};

/// Dense points per row.
const FACTOR: usize = 5;
/// Dense points per second.
const DENSE_RATE_HZ: f64 = RATE_HZ * FACTOR as f64;
/// How far the grid goes beyond the rows, s.
const MARGIN_S: f64 = 2.0;
/// Rounds in which missing directions are filled.
const BRIDGING_ROUNDS: usize = 6;
/// Rows whose times are off an even 0.1 s by less count as even, s.
const EVEN_S: f64 = 2e-3;
/// Points that an interpolation on a grid needs.
const LEAST_POINTS: usize = 4;

/// Rows without a pause whose direction is smoothed together.
type Run = Range<usize>;

/// What of a recording stays the same however its fluxgate is corrected.
#[derive(Clone, Debug)]
pub(crate) struct Reconstruction {
    epochs_s: Vec<f64>,
    runs: Vec<Run>,
    grid: Grid,
    depth_m: Option<Vec<f64>>,
    temperature_deg_c: Option<Vec<f64>>,
}

impl Reconstruction {
    pub(crate) fn of(table: &Prepared) -> Self {
        let epochs_s = shortened(table.epochs_s());
        let runs = runs(&epochs_s, table);
        let last_s = epochs_s.last().copied().unwrap_or(0.0);
        let len = ((last_s + 2.0 * MARGIN_S) * DENSE_RATE_HZ).ceil() as usize + 2;
        let grid = Grid { rate_hz: DENSE_RATE_HZ, start_s: -MARGIN_S, len };
        let smooth =
            |column: &Option<Vec<f64>>, window| column.as_ref().map(|column| smooth_rows(column, &runs, window));
        Self {
            depth_m: smooth(&table.depth_m, 0),
            temperature_deg_c: smooth(&table.temperature_deg_c, TEMPERATURE_ROWS),
            epochs_s,
            runs,
            grid,
        }
    }

    /// The trajectory whose direction is that of `flux_nt`, and whose field is the slow part of `field_nt`; both one a row, nT.
    pub(crate) fn trajectory(&self, table: &Prepared, flux_nt: &[[f64; 3]], field_nt: &[f64]) -> Trajectory {
        Trajectory {
            rate_hz: self.grid.rate_hz,
            start_s: self.grid.start_s,
            field_nt: self.dense(&self.slow_field_nt(field_nt)),
            direction: self.direction(flux_nt),
            epochs_s: self.epochs_s.clone(),
            first_row_time_s: table.time_s.first().copied().unwrap_or(0.0),
            depth_m: self.depth_m.clone(),
            temperature_deg_c: self.temperature_deg_c.clone(),
            currents_a: table.currents_a.clone(),
            columns: table.columns.clone(),
        }
    }

    /// The slow part of a field, run by run, nT, one a row; between the runs the field as it is.
    fn slow_field_nt(&self, field_nt: &[f64]) -> Vec<f64> {
        let mut slow_nt = field_nt.to_vec();
        for run in &self.runs {
            let mut part = field_nt[run.clone()].to_vec();
            fill_holes(&mut part);
            slow_nt[run.clone()].copy_from_slice(&slow(&part, SLOW_FIELD_ROWS));
        }
        slow_nt
    }

    /// Direction of the fluxgate vector without its noise, on the grid; straight lines across pauses.
    fn direction(&self, flux_nt: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut components = [0, 1, 2].map(|_| vec![f64::NAN; self.grid.len]);
        for run in &self.runs {
            let Some(of_run) = self.direction_of(run, flux_nt) else { continue };
            for point in self.points(run) {
                let direction = of_run.at(self.grid.time_s(point));
                (0..3).for_each(|i| components[i][point] = direction[i]);
            }
        }
        components.iter_mut().for_each(|component| fill_holes(component));
        (0..self.grid.len).map(|k| unit([0, 1, 2].map(|i| components[i][k]))).collect()
    }

    /// The smooth direction of a run; `None` for one that is too short.
    fn direction_of(&self, run: &Run, flux_nt: &[[f64; 3]]) -> Option<SmoothDirection> {
        let even = [0, 1, 2].map(|i| self.even(&flux_nt.iter().map(|flux| flux[i]).collect::<Vec<_>>(), run));
        let vectors: Vec<[f64; 3]> = (0..even[0].len()).map(|k| [even[0][k], even[1][k], even[2][k]]).collect();
        let plane = TangentPlane::of(&vectors);
        let mut angles: Vec<[f64; 2]> =
            vectors.iter().enumerate().map(|(row, vector)| plane.angles(row, *vector)).collect();
        self.bridge(&mut angles, flux_nt, run);
        let smooth = |i: usize| smooth_dense(&angles.iter().map(|angles| angles[i]).collect::<Vec<_>>(), FACTOR);
        let (first, second) = rayon::join(|| smooth(0), || smooth(1));
        if first.len() < LEAST_POINTS || vectors.len() < LEAST_POINTS {
            return None;
        }
        let start_s = self.epochs_s[run.start];
        Some(SmoothDirection {
            rows: Grid { rate_hz: RATE_HZ, start_s, len: vectors.len() },
            dense: Grid { rate_hz: DENSE_RATE_HZ, start_s, len: first.len() },
            plane,
            angles: [first, second],
        })
    }

    /// Replace the angles of missing rows by the smoothed ones, [`BRIDGING_ROUNDS`] times: the straight lines that stand
    /// there at first have kinks, which the smoothing would take for motion.
    fn bridge(&self, angles: &mut [[f64; 2]], flux_nt: &[[f64; 3]], run: &Run) {
        let holes: Vec<usize> =
            (0..run.len().min(angles.len())).filter(|k| !flux_nt[run.start + k][0].is_finite()).collect();
        if holes.is_empty() {
            return;
        }
        for _ in 0..BRIDGING_ROUNDS {
            for i in 0..2 {
                let smooth = smooth_dense(&angles.iter().map(|angles| angles[i]).collect::<Vec<_>>(), 1);
                holes.iter().for_each(|&k| angles[k][i] = smooth[k]);
            }
        }
    }

    /// Points of the grid for which a run's own values are good: a margin beyond its ends, or half way to its neighbours.
    fn points(&self, run: &Run) -> Range<usize> {
        let point = |time_s: f64| (time_s - self.grid.start_s) * self.grid.rate_hz;
        let (start_s, end_s) = (self.epochs_s[run.start], self.epochs_s[run.end - 1]);
        let before_s =
            self.runs.iter().rev().find(|other| other.end <= run.start).map(|other| self.epochs_s[other.end - 1]);
        let after_s = self.runs.iter().find(|other| other.start >= run.end).map(|other| self.epochs_s[other.start]);
        let reach_s = |pause_s: Option<f64>| pause_s.map_or(MARGIN_S, |pause_s| (0.5 * pause_s).min(MARGIN_S));
        let first = point(start_s - reach_s(before_s.map(|end_s| start_s - end_s))).ceil().max(0.0) as usize;
        let last = point(end_s + reach_s(after_s.map(|start_s| start_s - end_s))).floor().max(0.0) as usize;
        first..(last + 1).min(self.grid.len)
    }

    /// One slow value a row, on the grid.
    fn dense(&self, rows: &[f64]) -> Vec<f64> {
        let mut dense = vec![f64::NAN; self.grid.len];
        for run in &self.runs {
            let values = self.even(rows, run);
            if values.len() < LEAST_POINTS {
                continue;
            }
            let own = Grid { rate_hz: RATE_HZ, start_s: self.epochs_s[run.start], len: values.len() };
            for point in self.points(run) {
                dense[point] = extended(&own, &values, self.grid.time_s(point));
            }
        }
        fill_holes(&mut dense);
        dense
    }

    /// The values of a run every 0.1 s, holes bridged.
    fn even(&self, rows: &[f64], run: &Run) -> Vec<f64> {
        let mut values = rows[run.clone()].to_vec();
        fill_holes(&mut values);
        let times_s = &self.epochs_s[run.clone()];
        let off_s = |k: usize| (times_s[k] - times_s[0] - EPOCH_S * k as f64).abs();
        let is_even = (0..times_s.len()).all(|k| off_s(k) < EVEN_S);
        if is_even { values } else { resampled(times_s, &values) }
    }
}

/// The direction of a run: a slow one at its rows, and two small angles about it on a dense grid.
struct SmoothDirection {
    rows: Grid,
    dense: Grid,
    plane: TangentPlane,
    angles: [Vec<f64>; 2],
}

impl SmoothDirection {
    fn at(&self, time_s: f64) -> [f64; 3] {
        let slow = [0, 1, 2].map(|i| extended(&self.rows, &self.plane.slow()[i], time_s));
        let angles = [0, 1].map(|i| extended(&self.dense, &self.angles[i], time_s));
        self.plane.direction(slow, angles)
    }
}

/// The value at any time; beyond an end by point reflection about it.
fn extended(own: &Grid, values: &[f64], time_s: f64) -> f64 {
    let (start_s, end_s) = (own.start_s, own.end_s());
    if time_s < start_s {
        2.0 * values[0] - own.at(values, 2.0 * start_s - time_s)
    } else if time_s > end_s {
        2.0 * values[values.len() - 1] - own.at(values, 2.0 * end_s - time_s)
    } else {
        own.at(values, time_s)
    }
}

/// Values at uneven times, every 0.1 s: cubics through the four neighbours.
fn resampled(times_s: &[f64], values: &[f64]) -> Vec<f64> {
    let n = times_s.len();
    let count = ((times_s[n - 1] - times_s[0]) * RATE_HZ).floor() as usize + 1;
    let mut at = 0;
    (0..count)
        .map(|k| {
            let time_s = times_s[0] + EPOCH_S * k as f64;
            while at + 2 < n && times_s[at + 1] <= time_s {
                at += 1;
            }
            let first = at.saturating_sub(1).min(n.saturating_sub(4));
            let window = first..(first + 4).min(n);
            window.clone().map(|i| values[i] * lagrange(&times_s[window.clone()], i - first, time_s)).sum()
        })
        .collect()
}

/// Times with every pause cut down to [`LONGEST_PAUSE_S`].
fn shortened(mut epochs_s: Vec<f64>) -> Vec<f64> {
    let mut left_out_s = 0.0;
    for k in 1..epochs_s.len() {
        let step_s = epochs_s[k] - left_out_s - epochs_s[k - 1];
        left_out_s += (step_s - LONGEST_PAUSE_S).max(0.0);
        epochs_s[k] -= left_out_s;
    }
    epochs_s
}

/// The runs of a recording: few missing rows in a row, no step longer than the recording format's.
fn runs(epochs_s: &[f64], table: &Prepared) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (row, &time_s) in epochs_s.iter().enumerate() {
        if !table.flux_nt[row][0].is_finite() {
            continue;
        }
        match runs.last_mut() {
            Some(run) if row <= run.end + BRIDGED_ROWS && continuous(epochs_s, run.end - 1, row) => run.end = row + 1,
            _ => runs.push(row..row + 1),
        }
        debug_assert!(time_s.is_finite());
    }
    runs
}

/// Whether no step between two rows is a pause.
fn continuous(epochs_s: &[f64], from: usize, to: usize) -> bool {
    epochs_s[from..=to].windows(2).all(|pair| pair[1] - pair[0] <= LONGEST_STEP_S + 1e-6)
}

/// A column, one a row, without its noise; averaged over `window` rows as well unless that is 0.
fn smooth_rows(column: &[f64], runs: &[Run], window: usize) -> Vec<f64> {
    let mut smooth = column.to_vec();
    for run in runs {
        let part = smooth_dense(&column[run.clone()], 1);
        smooth[run.clone()].copy_from_slice(&if window > 0 { slow(&part, window) } else { part });
    }
    smooth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pause_of_half_a_second_leaves_the_rows_on_both_sides_as_they_are() {
        let turning = |t: f64| [20_000.0 * (0.3 * t).cos(), 20_000.0 * (0.3 * t).sin(), 40_000.0];
        let time_s: Vec<f64> = (0..1200).map(|k| 0.1 * f64::from(k) + if k < 600 { 0.0 } else { 0.5 }).collect();
        let flux_nt: Vec<[f64; 3]> = time_s.iter().map(|&t| turning(t)).collect();
        let table = Prepared { usable: vec![true; 1200], flux_nt: flux_nt.clone(), time_s, ..Prepared::default() };
        let field_nt: Vec<f64> = (0..1200).map(|k| if k < 600 { 50_000.0 } else { 50_010.0 }).collect();
        let trajectory = Reconstruction::of(&table).trajectory(&table, &flux_nt, &field_nt);
        for k in [570, 590, 599, 600, 610, 630] {
            let point = ((trajectory.epochs_s[k] - trajectory.start_s) * trajectory.rate_hz).round() as usize;
            let off = (0..3).map(|i| (trajectory.direction[point][i] - unit(flux_nt[k])[i]).abs()).fold(0.0, f64::max);
            assert!(off < 1e-4, "{k}: {off}");
            assert!((trajectory.field_nt[point] - field_nt[k]).abs() < 1e-6, "{k}: {}", trajectory.field_nt[point]);
        }
    }
}

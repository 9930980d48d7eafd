//! What contacts are looked for in, and how.

use crate::level::Coefficients;
use crate::navigation::Track;

/// Rows a second of everything that is surveyed.
pub(crate) const RATE_HZ: f64 = 10.0;

/// What contacts are looked for in.
#[derive(Clone, Copy, Debug)]
pub struct Levelled<'a> {
    /// Time, s.
    pub time_s: &'a [f64],
    /// Rows that count.
    pub is_valid: &'a [bool],
    /// Compensated total field at its level, nT, targets untouched; NaN where a row does not count.
    pub field_nt: &'a [f64],
    /// The 18 terms in nT a unit coefficient, one row each: what compensation may have taken along, or left.
    pub terms: &'a [[f64; 18]],
    /// Unit vector of the Earth's field in body axes (forward, starboard, down).
    pub direction: &'a [[f64; 3]],
    /// The track, if positions or at least the speed are known. Without it distances are in seconds only.
    pub track: Option<&'a Track>,
    /// Height above the bottom, m, where it is known.
    pub altitude_m: Option<&'a [f64]>,
}

/// How contacts are looked for.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// False contacts an hour that the threshold stands for.
    pub false_alarms_per_hour: f64,
    /// Shortest and longest distance over speed that is looked for, s.
    pub distances_s: [f64; 2],
    /// Those of the level that is searched. Where they stay as they are they are fitted anew beside the contacts, and what is loud
    /// for a while is a contact that is not fitted well; where they move it is what compensation leaves.
    pub coefficients: Coefficients,
}

impl Default for Options {
    /// One false contact in two hours; 2 m at 4 m/s to 15 m at 1 m/s.
    fn default() -> Self {
        Self { false_alarms_per_hour: 0.5, distances_s: [0.4, 15.0], coefficients: Coefficients::Moving }
    }
}

/// The way along the track of every row, in metres where a track is known, else in seconds.
#[derive(Clone, Debug)]
pub(super) struct Way {
    /// Of every row; finite everywhere.
    pub(super) at: Vec<f64>,
    /// Way a second, of every row.
    pub(super) per_s: Vec<f64>,
    /// Whether it is in metres.
    pub(super) is_metres: bool,
}

/// Speeds below this are no passing, m/s.
const LEAST_SPEED_M_PER_S: f64 = 0.2;

impl Way {
    pub(super) fn of(levelled: &Levelled<'_>) -> Self {
        let time_s = filled(levelled.time_s);
        let Some(track) = levelled.track else { return Self::of_time(time_s) };
        if track.along_m.iter().filter(|m| m.is_finite()).count() < 2 {
            return Self::of_time(time_s);
        }
        let at = filled(&track.along_m);
        // Over two seconds: the speed over ground of one row is as noisy as its position.
        let span = RATE_HZ as usize;
        let slope = |row: usize| {
            let (from, to) = (row.saturating_sub(span), (row + span).min(at.len() - 1));
            ((at[to] - at[from]) / (time_s[to] - time_s[from])).max(LEAST_SPEED_M_PER_S)
        };
        let per_s = (0..at.len()).map(|row| Some(slope(row)).filter(|v| v.is_finite()).unwrap_or(1.0)).collect();
        Self { at, per_s, is_metres: true }
    }

    /// The first row that is no nearer than this, or the last.
    pub(super) fn row_at(&self, at: f64) -> usize {
        self.at.partition_point(|way| *way < at).min(self.at.len() - 1)
    }

    fn of_time(time_s: Vec<f64>) -> Self {
        Self { per_s: vec![1.0; time_s.len()], at: time_s, is_metres: false }
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

//! Filters of a variable over the rows, each run anew after a gap.

use std::ops::Range;

use crate::diagnosis::numerics::low_pass;
use crate::diagnosis::policy::{EPOCH_S, RATE_HZ};

/// What is made of a course in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Filter {
    /// First order, time constant, s; starts settled.
    Lowpass(f64),
    /// What it was so many seconds before, whole rows; before the first row, that.
    Delay(f64),
    /// Central difference, per s.
    Rate,
    /// A quarter of a period behind.
    Hilbert,
    /// How fast an angle in degrees turns, per s, whatever full turns it jumps by.
    Turning,
    /// Follows only once the play is taken up (Prandtl and Ishlinskii's element); the width is in the variable's own unit.
    Play(f64),
}

impl Filter {
    /// Of a course, stretch by stretch.
    pub(crate) fn apply(&self, segments: &[Range<usize>], values: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; values.len()];
        for segment in segments {
            out[segment.clone()].copy_from_slice(&self.of(&values[segment.clone()]));
        }
        out
    }

    fn of(&self, values: &[f64]) -> Vec<f64> {
        let last = values.len().saturating_sub(1);
        match *self {
            Self::Lowpass(time_s) => low_pass(values.iter().copied(), (-1.0 / (RATE_HZ * time_s)).exp()),
            Self::Delay(time_s) => {
                let rows = (time_s * RATE_HZ).round() as usize;
                (0..values.len()).map(|row| values[row.saturating_sub(rows)]).collect()
            }
            Self::Rate => (0..values.len())
                .map(|row| {
                    let (from, to) = (row.saturating_sub(1), (row + 1).min(last));
                    (values[to] - values[from]) / ((to - from).max(1) as f64 * EPOCH_S)
                })
                .collect(),
            Self::Turning => {
                let turned = |row: usize| {
                    let (from, to) = (row.saturating_sub(1), (row + 1).min(last));
                    let by = (values[to] - values[from] + 180.0).rem_euclid(360.0) - 180.0;
                    by / ((to - from).max(1) as f64 * EPOCH_S)
                };
                (0..values.len()).map(turned).collect()
            }
            Self::Hilbert => crate::effects::quarter_period_behind(values),
            Self::Play(width) => {
                let mut at = values.first().copied().unwrap_or(0.0);
                let follow = |&x: &f64| {
                    at = at.clamp(x - width, x + width);
                    at
                };
                values.iter().map(follow).collect()
            }
        }
    }

    /// What effect files call it; none of one that they have not.
    pub(crate) fn word(&self) -> Option<&'static str> {
        match self {
            Self::Lowpass(_) => Some("lowpass"),
            Self::Delay(_) => Some("delay"),
            Self::Rate => Some("rate"),
            Self::Hilbert => Some("hilbert"),
            Self::Play(_) | Self::Turning => None,
        }
    }

    /// Its time, s, if it has one.
    pub(crate) fn time_s(&self) -> Option<f64> {
        match self {
            Self::Lowpass(time_s) | Self::Delay(time_s) => Some(*time_s),
            Self::Rate | Self::Hilbert | Self::Turning | Self::Play(_) => None,
        }
    }

    /// What is added to a name: `lowpass_1p5s`.
    pub(crate) fn suffix(&self) -> String {
        let word = self.word().unwrap_or(if *self == Self::Turning { "turning" } else { "play" });
        self.time_s().map_or_else(|| word.into(), |time_s| format!("{word}_{}s", time_s.to_string().replace('.', "p")))
    }
}

//! Filters of a variable over the rows, each run anew after a gap.

use std::ops::Range;

use crate::diagnosis::numerics::low_pass;
use crate::diagnosis::policy::{EPOCH_S, RATE_HZ};
use crate::effects::{held, played};

/// What is made of a course in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Filter {
    /// First order, time constant, s; starts settled.
    Lowpass(f64),
    /// What it was so many seconds before (or will be after, below 0), whole rows; before the first row, that.
    Delay(f64),
    /// Central difference, per s.
    Rate,
    /// A quarter of a period behind.
    Hilbert,
    /// Follows only once the play is taken up (Prandtl and Ishlinskii's element); the width is in the variable's own unit.
    Play(f64),
    /// Stays as it was until the variable is further away than this, and then jumps to it.
    Hold(f64),
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
                let rows = (time_s * RATE_HZ).round() as isize;
                (0..values.len()).map(|row| values[row.saturating_add_signed(-rows).min(last)]).collect()
            }
            Self::Rate => (0..values.len())
                .map(|row| {
                    let (from, to) = (row.saturating_sub(1), (row + 1).min(last));
                    (values[to] - values[from]) / ((to - from).max(1) as f64 * EPOCH_S)
                })
                .collect(),
            Self::Hilbert => crate::effects::quarter_period_behind(values),
            Self::Play(width) => played(values, width),
            Self::Hold(width) => held(values, width),
        }
    }

    /// What effect files call it.
    pub(crate) fn word(&self) -> &'static str {
        match self {
            Self::Lowpass(_) => "lowpass",
            Self::Delay(_) => "delay",
            Self::Rate => "rate",
            Self::Hilbert => "hilbert",
            Self::Play(_) => "play",
            Self::Hold(_) => "hold",
        }
    }

    /// Its time, s, if it has one.
    pub(crate) fn time_s(&self) -> Option<f64> {
        match self {
            Self::Lowpass(time_s) | Self::Delay(time_s) => Some(*time_s),
            Self::Rate | Self::Hilbert | Self::Play(_) | Self::Hold(_) => None,
        }
    }

    /// Its width, if it has one.
    pub(crate) fn width(&self) -> Option<f64> {
        match self {
            Self::Play(width) | Self::Hold(width) => Some(*width),
            _ => None,
        }
    }

    /// What is added to a name: `lowpass_1p5s`, `play_0p25`.
    pub(crate) fn suffix(&self) -> String {
        let word = self.word();
        let digits = |number: f64| number.to_string().replace('.', "p").replace('-', "m");
        match (self.time_s(), self.width()) {
            (Some(time_s), _) => format!("{word}_{}s", digits(time_s)),
            (_, Some(width)) => format!("{word}_{}", digits(width)),
            _ => word.into(),
        }
    }
}

//! Where a recording is broken: the same rule for every collector.

/// A longer step between samples is a gap, s. The recording format draws the line at 0.15 s; the rest allows for the
/// rounding of times counted from 1970.
const LONGEST_STEP_S: f64 = 0.15 + 1e-6;

/// Remembers the time of the sample before.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Continuity {
    last_time_s: Option<f64>,
}

impl Continuity {
    /// Whether the sample at `time_s` comes after a gap. The first sample does not.
    pub(super) fn after_gap(&mut self, time_s: f64) -> bool {
        self.last_time_s.replace(time_s).is_some_and(|last| time_s - last > LONGEST_STEP_S)
    }
}

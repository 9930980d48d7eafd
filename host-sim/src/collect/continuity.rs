//! Where a recording is broken: the same rule for every collector.

use crate::recording::{LONGEST_STEP_S, TIME_ROUNDING_S};

/// Remembers the time of the sample before.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Continuity {
    last_time_s: Option<f64>,
}

impl Continuity {
    /// Whether the sample at `time_s` comes after a gap. The first sample does not.
    pub(super) fn after_gap(&mut self, time_s: f64) -> bool {
        self.last_time_s.replace(time_s).is_some_and(|last| time_s - last > LONGEST_STEP_S + TIME_ROUNDING_S)
    }
}

//! Whether the compensation has settled: before that it moves the field as no target could, and as every target does.

use crate::run::SETTLED_S;

/// Rows of a recording further apart than this, s, are of two passes through the core.
const LONGEST_HOLE_S: f64 = 1.0;

/// Whether the compensation has settled.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Settled {
    /// When it was last known not to be.
    unsettled_s: Option<f64>,
    last_s: Option<f64>,
}

impl Settled {
    /// At a message of the body, which says itself when its filters start anew; the coefficients follow later.
    pub(super) fn of_message(&mut self, time_s: f64, is_settling: bool) -> bool {
        if is_settling {
            self.unsettled_s = Some(time_s);
        }
        self.is_past(time_s)
    }

    /// At a row of a recording, which does not say it: the first, and those after a gap, are not.
    pub(super) fn of_row(&mut self, time_s: f64) -> bool {
        if self.last_s.is_none_or(|last_s| time_s - last_s > LONGEST_HOLE_S) {
            self.unsettled_s = Some(time_s);
        }
        self.last_s = Some(time_s);
        self.is_past(time_s)
    }

    fn is_past(&self, time_s: f64) -> bool {
        self.unsettled_s.is_none_or(|unsettled_s| time_s - unsettled_s >= SETTLED_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_that_starts_has_to_settle_and_one_that_is_met_on_its_way_has_not() {
        let mut settled = Settled::default();
        assert!(settled.of_message(0.0, false));
        assert!(!settled.of_message(1.0, true) && !settled.of_message(SETTLED_S, false));
        assert!(settled.of_message(SETTLED_S + 1.0, false));
    }

    #[test]
    fn a_recording_settles_at_its_start_and_after_each_gap() {
        let mut settled = Settled::default();
        let rows: Vec<bool> =
            (0..4_000).map(|k| settled.of_row(0.1 * f64::from(k) + if k < 2_000 { 0.0 } else { 5.0 })).collect();
        let first = |from: usize| rows[from..].iter().position(|is_settled| *is_settled);
        assert!(first(0).unwrap().abs_diff((10.0 * SETTLED_S) as usize) <= 1);
        assert!(!rows[2_000] && first(2_000).unwrap().abs_diff((10.0 * SETTLED_S) as usize) <= 1);
    }
}

//! How quiet a channel is where nothing happens: the median of its standard deviation over short windows.

use super::continuity::Continuity;
use super::running_std::RunningStd;

/// Length of a window, s: one period of the lowest frequency of the band.
const WINDOW_S: f64 = 10.0;
/// Samples that a window needs to count: nine tenths of it.
const LEAST_SAMPLES: u64 = 90;

/// Median over time of the standard deviation in windows of 10 s, of a band-passed channel. Targets and turns raise few of
/// them. Four bytes a window are kept.
#[derive(Clone, Debug, Default)]
pub struct NoiseFloor {
    window: RunningStd,
    ends_s: f64,
    continuity: Continuity,
    found: Vec<f32>,
}

impl NoiseFloor {
    /// Take in one sample; a window does not go on across a gap.
    pub fn push(&mut self, time_s: f64, value: f64) {
        if self.continuity.after_gap(time_s) || self.window.count() == 0 || time_s >= self.ends_s {
            self.close();
            self.ends_s = time_s + WINDOW_S;
        }
        self.window.push(value);
    }

    fn close(&mut self) {
        if self.window.count() >= LEAST_SAMPLES {
            self.found.push(self.window.std() as f32);
        }
        self.window = RunningStd::default();
    }

    /// The floor, nT; `None` before the first whole window.
    pub fn median(&self) -> Option<f64> {
        let mut last = self.clone();
        last.close();
        let middle = last.found.len().checked_sub(1)? / 2;
        Some(f64::from(*last.found.select_nth_unstable_by(middle, f32::total_cmp).1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_do_not_raise_it() {
        let mut floor = NoiseFloor::default();
        for i in 0..6_000 {
            let target = if (3_000..3_020).contains(&i) { 50.0 } else { 0.0 };
            floor.push(0.1 * f64::from(i), target + if i % 2 == 0 { 0.2 } else { -0.2 });
        }
        assert!((floor.median().unwrap() - 0.2).abs() < 1e-6);
    }

    #[test]
    fn a_window_that_a_gap_cuts_short_does_not_count() {
        let mut floor = NoiseFloor::default();
        (0..50).for_each(|i| floor.push(0.1 * f64::from(i), f64::from(i)));
        (0..50).for_each(|i| floor.push(100.0 + 0.1 * f64::from(i), f64::from(i)));
        assert_eq!(floor.median(), None);
    }
}

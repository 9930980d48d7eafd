//! Whether the rows come at 10 Hz at all, whatever the single step is.

use std::collections::VecDeque;

use super::rate::{EPOCH_S, RATE_HZ};
use crate::message::number;

/// How far the median step may be from an epoch.
const ALLOWED: f64 = 0.05;

/// Steps below which nothing is said.
const LEAST_STEPS: u64 = 20;

/// Steps after which a rate that is wrong is refused at once: a minute. The rest of the file then need not be waited for.
const EARLY_STEPS: usize = 600;

/// Rows in a span. Times that jitter, or are rounded to sixteenths of a second, have steps of two sizes, neither of them an
/// epoch; the span of ten has ten epochs.
const SPAN_ROWS: usize = 10;

/// How many lengths are shorter than allowed, allowed, longer.
#[derive(Clone, Copy, Debug, Default)]
struct Sides([u64; 3]);

impl Sides {
    fn add(&mut self, step_s: f64) {
        let ratio = step_s / EPOCH_S;
        self.0[usize::from(ratio >= 1.0 - ALLOWED) + usize::from(ratio > 1.0 + ALLOWED)] += 1;
    }

    fn count(&self) -> u64 {
        self.0.iter().sum()
    }

    /// Whether the median is not among those that are allowed.
    fn is_median_off(&self) -> bool {
        2 * self.0[0].max(self.0[2]) > self.count()
    }
}

/// Follows the times of a recording as they are written, good or bad. Its memory does not grow.
#[derive(Clone, Debug, Default)]
pub(super) struct RateCheck {
    times_s: VecDeque<f64>,
    repeated: u64,
    steps: Sides,
    spans: Sides,
    /// The first steps, for the figure.
    first_s: Vec<f64>,
}

impl RateCheck {
    /// The next row's time. What is wrong with the rate, as soon as that is sure.
    pub(super) fn step(&mut self, time_s: f64) -> Option<String> {
        let step_s = self.times_s.back().map(|before_s| time_s - before_s);
        self.times_s.push_back(time_s);
        if self.times_s.len() > SPAN_ROWS {
            let span_s = self.times_s.pop_front().map_or(0.0, |first_s| time_s - first_s);
            if span_s > 0.0 {
                self.spans.add(span_s / SPAN_ROWS as f64);
            }
        }
        let step_s = step_s?;
        self.repeated += u64::from(step_s == 0.0);
        if step_s <= 0.0 {
            return None;
        }
        self.steps.add(step_s);
        if self.first_s.len() < EARLY_STEPS {
            self.first_s.push(step_s);
            return if self.first_s.len() == EARLY_STEPS { self.verdict() } else { None };
        }
        None
    }

    /// What is wrong with the rate of the rows so far. Where most times repeat, the steps between the others tell nothing.
    pub(super) fn verdict(&self) -> Option<String> {
        let steps = self.steps.count();
        let is_known = steps >= LEAST_STEPS && self.repeated <= steps;
        if !is_known || !self.steps.is_median_off() || !self.spans.is_median_off() {
            return None;
        }
        let mut first_s = self.first_s.clone();
        first_s.sort_by(f64::total_cmp);
        let median_s = first_s[first_s.len() / 2];
        let [rate_hz, step_s] = [1.0 / median_s, median_s].map(three_figures);
        Some(format!("the median step is {step_s} s: the recording has {rate_hz} Hz, and {RATE_HZ} Hz are needed"))
    }
}

fn three_figures(value: f64) -> String {
    number(format!("{value:.2e}").parse().unwrap_or(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(times_s: impl IntoIterator<Item = f64>) -> Option<String> {
        let mut check = RateCheck::default();
        let early = times_s.into_iter().find_map(|time_s| check.step(time_s));
        early.or_else(|| check.verdict())
    }

    #[test]
    fn every_other_rate_is_told_with_its_figure() {
        for (rate_hz, figure) in [(20.0, "20 Hz"), (8.0, "8 Hz"), (1.0, "1 Hz"), (160.0, "160 Hz"), (12.5, "12.5 Hz")] {
            for rows in [100, 5000] {
                let said = verdict((0..rows).map(|row| f64::from(row) / rate_hz)).unwrap();
                assert!(said.contains(&format!("the recording has {figure}")), "{said}");
            }
        }
    }

    #[test]
    fn what_jitters_around_ten_has_ten() {
        let exact = |row: u32| f64::from(row) / 10.0;
        let sixteenths = |row: u32| (f64::from(row) * 6.4).floor() / 64.0;
        let drifting = |row: u32| f64::from(row) * 0.104;
        let with_gaps = |row: u32| f64::from(row) / 10.0 + f64::from(row / 4) * 3.0;
        for times in [exact, sixteenths, drifting, with_gaps] {
            assert_eq!(verdict((0..3000).map(times)), None);
        }
        // Whole seconds: what is wrong is that times repeat.
        assert_eq!(verdict((0..3000).map(|row| f64::from(row / 10))), None);
        assert_eq!(verdict((0..15).map(f64::from)), None, "too few to say");
    }
}

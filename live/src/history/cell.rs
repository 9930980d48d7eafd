//! Some time, and what every series was in it.

use crate::sample::SERIES;

/// Some time, and what every series was in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// How many cells after the first.
    pub(super) index: u64,
    /// Its first sample's time, s.
    pub time_s: f64,
    /// Smallest and largest; NaN where nothing is known.
    low: [f64; SERIES],
    high: [f64; SERIES],
}

impl Cell {
    pub(super) fn new(index: u64, time_s: f64) -> Self {
        Self { index, time_s, low: [f64::NAN; SERIES], high: [f64::NAN; SERIES] }
    }

    pub(super) fn add(&mut self, series: &[Option<f64>; SERIES]) {
        for (place, value) in series.iter().enumerate() {
            if let Some(value) = value {
                // `min` and `max` pass over what is not a number.
                self.low[place] = self.low[place].min(*value);
                self.high[place] = self.high[place].max(*value);
            }
        }
    }

    /// Smallest and largest of a series; `None` where nothing is known.
    pub fn bounds(&self, series: usize) -> Option<[f64; 2]> {
        let bounds = [*self.low.get(series)?, *self.high.get(series)?];
        bounds[0].is_finite().then_some(bounds)
    }
}

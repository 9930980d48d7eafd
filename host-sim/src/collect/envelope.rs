//! Minimum, maximum and mean over time in a fixed number of bins, however long the recording turns out to be.

use super::continuity::Continuity;
use crate::recording::EPOCH_S;

/// Bins held; between half as many and all of them are in use in a long recording.
const CAPACITY: usize = 4096;

/// Width of a bin to begin with, s.
const FIRST_WIDTH_S: f64 = EPOCH_S;

/// A long channel, reduced to what a screen can show.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Envelope {
    /// Width of a bin, s.
    pub bin_width_s: f64,
    /// Bins in order of time; none is empty.
    pub bins: Vec<Bin>,
}

/// All samples of a short stretch of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Time of the first sample.
    pub time_s: f64,
    /// Smallest sample.
    pub min: f64,
    /// When it was taken.
    pub min_at_s: f64,
    /// Largest sample.
    pub max: f64,
    /// When it was taken.
    pub max_at_s: f64,
    /// Mean of the samples.
    pub mean: f64,
    /// Number of samples, at least one.
    pub count: u64,
    /// There is a gap just before it: the line is broken.
    pub after_gap: bool,
}

impl Envelope {
    /// Mean of all samples; `None` when there are none.
    pub fn mean(&self) -> Option<f64> {
        let count: u64 = self.bins.iter().map(|bin| bin.count).sum();
        let sum: f64 = self.bins.iter().map(|bin| bin.mean * bin.count as f64).sum();
        (count > 0).then(|| sum / count as f64)
    }

    /// Smallest and largest sample; `None` when there are none.
    pub fn range(&self) -> Option<(f64, f64)> {
        let wider = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        self.bins.iter().map(|bin| (bin.min, bin.max)).reduce(wider)
    }
}

/// Reduces a channel to an [`Envelope`]. When the bins are full, pairs are merged and the bins become twice as wide, so
/// that nothing of the extremes is ever lost.
#[derive(Clone, Debug)]
pub struct EnvelopeCollector {
    bins: Vec<Slot>,
    origin_s: f64,
    width_s: f64,
    continuity: Continuity,
}

/// A bin being filled; empty when `count` is zero.
#[derive(Clone, Copy, Debug)]
struct Slot {
    first_s: f64,
    min: f64,
    min_at_s: f64,
    max: f64,
    max_at_s: f64,
    sum: f64,
    count: u64,
    after_gap: bool,
}

impl Slot {
    const EMPTY: Self = Self {
        first_s: 0.0,
        min: f64::INFINITY,
        min_at_s: 0.0,
        max: f64::NEG_INFINITY,
        max_at_s: 0.0,
        sum: 0.0,
        count: 0,
        after_gap: false,
    };

    fn push(&mut self, time_s: f64, value: f64, after_gap: bool) {
        if self.count == 0 {
            self.first_s = time_s;
            self.after_gap = after_gap; // a gap inside a bin is narrower than the bin: it cannot be seen
        }
        if value < self.min {
            (self.min, self.min_at_s) = (value, time_s);
        }
        if value > self.max {
            (self.max, self.max_at_s) = (value, time_s);
        }
        self.sum += value;
        self.count += 1;
    }

    fn merged(self, later: Self) -> Self {
        if self.count == 0 || later.count == 0 {
            return if self.count == 0 { later } else { self };
        }
        let low = if later.min < self.min { later } else { self };
        let high = if later.max > self.max { later } else { self };
        Self {
            min: low.min,
            min_at_s: low.min_at_s,
            max: high.max,
            max_at_s: high.max_at_s,
            sum: self.sum + later.sum,
            count: self.count + later.count,
            ..self
        }
    }

    fn bin(&self) -> Bin {
        Bin {
            time_s: self.first_s,
            min: self.min,
            min_at_s: self.min_at_s,
            max: self.max,
            max_at_s: self.max_at_s,
            mean: self.sum / self.count as f64,
            count: self.count,
            after_gap: self.after_gap,
        }
    }
}

impl Default for EnvelopeCollector {
    fn default() -> Self {
        Self {
            bins: Vec::with_capacity(CAPACITY),
            origin_s: 0.0,
            width_s: FIRST_WIDTH_S,
            continuity: Continuity::default(),
        }
    }
}

impl EnvelopeCollector {
    /// Take in one sample. Times must not decrease; a value that is not finite is left out.
    pub fn push(&mut self, time_s: f64, value: f64) {
        if !(time_s.is_finite() && value.is_finite()) {
            return;
        }
        if self.bins.is_empty() {
            // Half a bin early: samples on the 10 Hz grid fall into the middle of their bins, clear of the edges.
            self.origin_s = time_s - 0.5 * FIRST_WIDTH_S;
        }
        let after_gap = self.continuity.after_gap(time_s);
        while (time_s - self.origin_s) / self.width_s >= CAPACITY as f64 {
            self.widen();
        }
        // Never negative, and the cast saturates: a time before the first goes into the first bin.
        let index = ((time_s - self.origin_s) / self.width_s) as usize;
        if index >= self.bins.len() {
            self.bins.resize(index + 1, Slot::EMPTY);
        }
        self.bins[index].push(time_s, value, after_gap);
    }

    fn widen(&mut self) {
        let pair = |pair: &[Slot]| pair.iter().copied().reduce(Slot::merged).unwrap_or(Slot::EMPTY);
        let merged: Vec<Slot> = self.bins.chunks(2).map(pair).collect();
        self.bins.clear(); // and not replaced: the capacity stays
        self.bins.extend(merged);
        self.width_s *= 2.0;
    }

    /// What has been collected so far.
    pub fn envelope(&self) -> Envelope {
        Envelope {
            bin_width_s: self.width_s,
            bins: self.bins.iter().filter(|slot| slot.count > 0).map(Slot::bin).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(i: u32) -> f64 {
        50_000.0 + (f64::from(i) * 0.37).sin() * f64::from(i % 97)
    }

    #[test]
    fn short_recording_keeps_every_sample_at_its_own_time() {
        let mut collector = EnvelopeCollector::default();
        (0..3_000_u32).for_each(|i| collector.push(1.7e9 + f64::from(i) * 0.1, wave(i)));
        let bins = collector.envelope().bins;
        assert_eq!(bins.len(), 3_000);
        for (i, bin) in bins.iter().enumerate() {
            let value = wave(i as u32);
            let time_s = 1.7e9 + i as f64 * 0.1;
            let expected = Bin {
                time_s,
                min: value,
                min_at_s: time_s,
                max: value,
                max_at_s: time_s,
                mean: value,
                count: 1,
                after_gap: false,
            };
            assert_eq!(*bin, expected);
        }
    }

    #[test]
    fn long_recording_agrees_with_a_direct_computation() {
        let rows = 100_000_u32;
        let mut collector = EnvelopeCollector::default();
        (0..rows).for_each(|i| collector.push(f64::from(i) * 0.1, wave(i)));
        let bins = collector.envelope().bins;
        assert!(bins.len() > CAPACITY / 2 && bins.len() <= CAPACITY, "{}", bins.len());
        let mut next = 0;
        for bin in &bins {
            let values: Vec<f64> = (next..next + bin.count as u32).map(wave).collect();
            assert_eq!(bin.min, values.iter().copied().fold(f64::INFINITY, f64::min));
            assert_eq!(bin.max, values.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            assert!((bin.mean - values.iter().sum::<f64>() / values.len() as f64).abs() < 1e-9);
            assert!(bin.time_s == f64::from(next) * 0.1 && !bin.after_gap);
            let at = |time_s: f64| wave((time_s / 0.1).round() as u32);
            assert_eq!((at(bin.min_at_s), at(bin.max_at_s)), (bin.min, bin.max));
            next += bin.count as u32;
        }
        assert_eq!(next, rows);
    }

    #[test]
    fn gaps_break_the_line_as_long_as_they_are_wider_than_a_bin() {
        let mut collector = EnvelopeCollector::default();
        // 20,000 s, with 60 s missing every 1,000 s and a single epoch missing now and then.
        for i in (0..200_000_u32).filter(|i| i % 10_000 >= 600 && i % 777 != 0) {
            collector.push(f64::from(i) * 0.1, wave(i));
        }
        let bins = collector.envelope().bins;
        let breaks: Vec<f64> = bins.iter().filter(|bin| bin.after_gap).map(|bin| bin.time_s).collect();
        let long: Vec<_> = bins.windows(2).filter(|pair| pair[1].time_s - pair[0].time_s > 30.0).collect();
        assert_eq!(long.len(), 19);
        assert!(long.iter().all(|pair| breaks.contains(&pair[1].time_s)));
    }

    #[test]
    fn what_is_not_a_number_is_left_out() {
        let mut collector = EnvelopeCollector::default();
        collector.push(0.0, 1.0);
        collector.push(0.1, f64::NAN);
        collector.push(0.2, 3.0);
        let envelope = collector.envelope();
        assert_eq!((envelope.bins.len(), envelope.mean(), envelope.range()), (2, Some(2.0), Some((1.0, 3.0))));
        assert!(envelope.bins[1].after_gap);
    }
}

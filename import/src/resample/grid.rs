//! The 10 Hz grid, and which rows of the source lie near each of its own.

use super::low_pass::LowPass;
use crate::rate::{RATE_HZ, Sampling};

/// Where the rows lie, and which rows of the source each is made of.
pub(super) struct Grid<'a> {
    pub(super) low_pass: LowPass,
    pub(super) source_s: &'a [f64],
    pub(super) time_s: Vec<f64>,
    /// The stretch of each row.
    pub(super) stretch: Vec<std::ops::Range<usize>>,
    /// The row of the source at or before each.
    pub(super) at: Vec<usize>,
}

impl<'a> Grid<'a> {
    pub(super) fn of(source_s: &'a [f64], sampling: &Sampling) -> Self {
        let mut grid =
            Self { low_pass: LowPass::new(), source_s, time_s: Vec::new(), stretch: Vec::new(), at: Vec::new() };
        let Some(&first) = source_s.first() else { return grid };
        // On tenths of a second, so that stamps are short; by counting, so that none drifts.
        let origin = (first * RATE_HZ - 1e-6).ceil();
        for stretch in &sampling.stretches {
            let (begin, end) = (source_s[stretch.start], source_s[stretch.end - 1]);
            let mut count = (begin * RATE_HZ - origin - 1e-6).ceil().max(0.0);
            let mut at = stretch.start;
            while (origin + count) / RATE_HZ <= end + 1e-6 {
                let time_s = (origin + count) / RATE_HZ;
                while at + 1 < stretch.end && source_s[at + 1] <= time_s + 1e-9 {
                    at += 1;
                }
                grid.time_s.push(time_s);
                grid.stretch.push(stretch.clone());
                grid.at.push(at);
                count += 1.0;
            }
        }
        grid
    }

    /// The rows of the source within half a step of 10 Hz.
    pub(super) fn nearby(&self, row: usize) -> impl Iterator<Item = usize> {
        let (time_s, stretch) = (self.time_s[row], self.stretch[row].clone());
        let is_near = move |source: &usize| (self.source_s[*source] - time_s).abs() <= 0.5 / RATE_HZ + 1e-9;
        let back = (stretch.start..=self.at[row]).rev().take_while(is_near);
        let forward = (self.at[row] + 1..stretch.end).take_while(is_near);
        back.chain(forward)
    }

    pub(super) fn nearest(&self, row: usize) -> usize {
        let at = self.at[row];
        let next = (at + 1).min(self.stretch[row].end - 1);
        let off = |source: usize| (self.source_s[source] - self.time_s[row]).abs();
        if off(next) < off(at) { next } else { at }
    }

    pub(super) fn lowest(&self, row: usize, numbers: &[f64]) -> f64 {
        let lowest = self.nearby(row).map(|source| numbers[source]).fold(f64::NAN, f64::min);
        if lowest.is_nan() { numbers[self.nearest(row)] } else { lowest }
    }
}

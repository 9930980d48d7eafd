//! What the smoother reads: the rows of all recordings, one after another, averaged to 2 Hz.

use std::ops::Range;

use super::circle::circle_mean;
use super::terms::{COMBINATIONS, MAGNITUDE, TERMS, TOLD, UNIT_FIELD_NT, combine, magnitude, of_stretch};
use crate::Tow;

/// Rows that are averaged to one sample. The terms are fitted below 1 Hz: above it, what a fluxgate's timing and a mount's
/// shake do is no longer what the terms say, and a smoother that weighs all frequencies by their noise would believe those.
pub(crate) const BLOCK_ROWS: usize = 5;
/// Time between two samples, s.
pub(crate) const SAMPLE_S: f64 = 0.5;
/// Between two recordings coefficients may have moved as in this time, s: the body was on deck.
const ON_DECK_S: f64 = 600.0;
/// What is slow before a longer gap says nothing about after it, s.
const LONG_GAP_S: f64 = 5.0;

/// The mean of some rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    /// What is fitted.
    pub(crate) columns: [f64; COMBINATIONS],
    /// The scalar less the fitted targets, nT.
    pub(crate) scalar_nt: f64,
    /// How much larger than usual the variance of the reading's noise is here.
    pub(crate) variance_ratio: f64,
    /// Time since the sample before, s.
    pub(crate) step_s: f64,
    /// Whether a recording begins here: its background is another one.
    pub(crate) begins: bool,
    /// Whether the sensor was moved before: the coefficients have nothing to do with those before.
    pub(crate) moved: bool,
}

/// The samples, and the rows that they come from.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub(crate) samples: Vec<Sample>,
    /// Sample of each row; of a row that is not usable, some sample near it.
    pub(crate) sample_of: Vec<usize>,
    /// Whether each row is usable.
    pub(crate) is_usable: Vec<bool>,
    /// What is fitted, of the usable rows; zeros elsewhere.
    pub(crate) columns: Vec<[f64; COMBINATIONS]>,
    /// All 18 terms of the usable rows, in nT a scaled coefficient; zeros elsewhere.
    pub(crate) all_terms: Vec<[f64; TERMS]>,
    /// Rows without a long gap.
    pub(crate) row_parts: Vec<Range<usize>>,
}

impl Series {
    /// All rows of recordings of one body. `targets_nt` is taken off the readings, a value a row.
    pub(crate) fn of(tows: &[Tow], targets_nt: &[f64]) -> Self {
        let all_terms: Vec<[f64; TERMS]> = tows.iter().flat_map(terms_of).collect();
        let is_usable: Vec<bool> = tows.iter().flat_map(|tow| tow.is_usable.iter().copied()).collect();
        let columns = columns_of(tows, &is_usable, &all_terms);
        let row_parts = row_parts(tows);
        let mut series = Self { samples: Vec::new(), sample_of: Vec::new(), is_usable, columns, all_terms, row_parts };
        let mut first = 0;
        for tow in tows {
            series.add(tow, first, targets_nt);
            first += tow.len();
        }
        series
    }

    /// The samples of a recording, whose first row is `first` among all.
    fn add(&mut self, tow: &Tow, first: usize, targets_nt: &[f64]) {
        let mut before_s = None;
        for stretch in tow.stretches() {
            for begin in stretch.clone().step_by(BLOCK_ROWS) {
                let rows = begin..(begin + BLOCK_ROWS).min(stretch.end);
                let time_s = 0.5 * (tow.time_s[rows.start] + tow.time_s[rows.end - 1]);
                self.sample_of.resize(first + begin, self.samples.len().saturating_sub(1));
                self.sample_of.resize(first + rows.end, self.samples.len());
                let average = |value: &dyn Fn(usize) -> f64| rows.clone().map(value).sum::<f64>() / rows.len() as f64;
                self.samples.push(Sample {
                    columns: std::array::from_fn(|k| average(&|row| self.columns[first + row][k])),
                    scalar_nt: average(&|row| tow.scalar_nt[row] - targets_nt[first + row]),
                    variance_ratio: BLOCK_ROWS as f64 / rows.len() as f64,
                    step_s: before_s.map_or(ON_DECK_S, |before_s| time_s - before_s),
                    begins: before_s.is_none(),
                    moved: false,
                });
                before_s = Some(time_s);
            }
        }
        self.sample_of.resize(first + tow.len(), self.samples.len().saturating_sub(1));
    }

    /// Mean of a value a row over the rows of each sample.
    pub(crate) fn averaged(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.samples.len()];
        for (row, value) in values.iter().enumerate().filter(|(row, _)| self.is_usable[*row]) {
            let (sum, rows) = &mut sums[self.sample_of[row]];
            (*sum, *rows) = (*sum + value, *rows + 1.0);
        }
        sums.into_iter().map(|(sum, rows)| sum / f64::max(rows, 1.0)).collect()
    }

    /// Samples without a long gap.
    pub(crate) fn sample_parts(&self) -> Vec<Range<usize>> {
        parts(self.samples.len(), |at| self.samples[at].begins || self.samples[at].step_s > LONG_GAP_S)
    }

    /// One where a row is usable, else zero.
    pub(crate) fn row_weights(&self) -> Vec<f64> {
        self.is_usable.iter().map(|is_usable| f64::from(u8::from(*is_usable))).collect()
    }
}

/// Ranges that begin where `begins` says so.
fn parts(len: usize, begins: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut parts: Vec<Range<usize>> = Vec::new();
    for at in 0..len {
        match parts.last_mut() {
            Some(last) if !begins(at) => last.end = at + 1,
            _ => parts.push(at..at + 1),
        }
    }
    parts
}

fn row_parts(tows: &[Tow]) -> Vec<Range<usize>> {
    let mut first = 0;
    let mut all = Vec::new();
    for tow in tows {
        let is_after_gap = |row: usize| row > 0 && tow.time_s[row] - tow.time_s[row - 1] > LONG_GAP_S;
        all.extend(parts(tow.len(), is_after_gap).into_iter().map(|part| first + part.start..first + part.end));
        first += tow.len();
    }
    all
}

fn terms_of(tow: &Tow) -> Vec<[f64; TERMS]> {
    let mut terms = vec![[0.0; TERMS]; tow.len()];
    let field_nt = mean_magnitude_nt((0..tow.len()).filter(|&row| tow.is_usable[row]).map(|row| tow.flux_nt[row]));
    for rows in tow.stretches() {
        let values = of_stretch(&tow.time_s, &tow.flux_nt, rows.clone(), field_nt);
        terms[rows].copy_from_slice(&values);
    }
    terms
}

/// Mean magnitude of some readings of the fluxgate.
fn mean_magnitude_nt(flux_nt: impl Iterator<Item = [f64; 3]> + Clone) -> f64 {
    flux_nt.clone().map(magnitude).sum::<f64>() / flux_nt.count().max(1) as f64
}

/// From the eddy terms: each is a cosine times a derivative, and the cosines' squares sum to one.
fn square_of_rate(terms: &[f64; TERMS], flux_nt: [f64; 3]) -> f64 {
    let field = magnitude(flux_nt) / UNIT_FIELD_NT;
    terms[9..].iter().map(|eddy| eddy * eddy).sum::<f64>() / field
}

/// The combinations less their mean over a circle of headings; the fluxgate's magnitude less its mean, in 1,000 nT: the
/// column of the sum of the squares of eq. (4), which a fluxgate with errors of its own needs; and the square of the direction's
/// rate, which a backward difference has in the sum of its eddy terms, and which a sensor that lags by itself needs: on a real
/// flight (C, 4) it takes a fifth of what the 18 terms leave.
fn columns_of(tows: &[Tow], is_usable: &[bool], all_terms: &[[f64; TERMS]]) -> Vec<[f64; COMBINATIONS]> {
    let flux_nt: Vec<[f64; 3]> = tows.iter().flat_map(|tow| tow.flux_nt.iter().copied()).collect();
    let usable = || (0..flux_nt.len()).filter(|&row| is_usable[row]);
    let circle = circle_mean(&usable().map(|row| (flux_nt[row], &all_terms[row])).collect::<Vec<_>>());
    let mean = combine(&circle);
    let mean_nt = mean_magnitude_nt(usable().map(|row| flux_nt[row]));
    let column = |row: usize| {
        let combined = combine(&all_terms[row]);
        let excess = (magnitude(flux_nt[row]) - mean_nt) / 1_000.0;
        let value = |k: usize| match k {
            MAGNITUDE => excess,
            _ if k < TOLD => combined[k] - mean[k],
            _ => square_of_rate(&all_terms[row], flux_nt[row]),
        };
        if is_usable[row] { std::array::from_fn(value) } else { [0.0; COMBINATIONS] }
    };
    (0..flux_nt.len()).map(column).collect()
}

//! What the smoother reads: all rows of all recordings, one after another.

use super::terms::{COMBINATIONS, TERMS, circle_mean, combine, of_stretch};
use crate::Tow;

/// Between two recordings coefficients may have moved as in this time, s: the body was on deck.
const ON_DECK_S: f64 = 600.0;

/// One row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    /// Combinations of the terms less their mean over a circle of headings.
    pub(crate) terms: [f64; COMBINATIONS],
    /// The scalar less the fitted targets, nT.
    pub(crate) scalar_nt: f64,
    /// How much larger than usual the variance of the reading's noise is here; infinite where the row is not used.
    pub(crate) variance_ratio: f64,
    /// Time since the row before, s.
    pub(crate) step_s: f64,
    /// What is new at this row.
    pub(crate) onset: Onset,
}

/// What may begin at a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Onset {
    /// Nothing.
    Nothing,
    /// A recording: its background is another one.
    Recording,
    /// Coefficients that have nothing to do with those before: the sensor was moved.
    Move,
}

/// The rows, and what was taken off their terms.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub(crate) samples: Vec<Sample>,
    /// All 18 terms of the usable rows, in nT a scaled coefficient; zeros elsewhere.
    pub(crate) all_terms: Vec<[f64; TERMS]>,
    /// Their mean over a circle of headings.
    pub(crate) circle: [f64; TERMS],
}

impl Series {
    /// All rows of recordings of one body; a row that is not usable has no weight.
    pub(crate) fn of(tows: &[Tow]) -> Self {
        let usable = |tow: &Tow| -> Vec<[f64; 3]> {
            (0..tow.len()).filter(|&row| tow.is_usable[row]).map(|row| tow.flux_nt[row]).collect()
        };
        let circle = circle_mean(tows.iter().flat_map(usable));
        let mean = combine(&circle);
        let (mut samples, mut all_terms) = (Vec::new(), Vec::new());
        for tow in tows {
            let terms = terms_of(tow);
            let first = samples.len();
            samples.extend((0..tow.len()).map(|row| sample(tow, row, &terms[row], &mean)));
            begin_at_a_reading(&mut samples[first..]);
            all_terms.extend(terms);
        }
        Self { samples, all_terms, circle }
    }
}

fn sample(tow: &Tow, row: usize, terms: &[f64; TERMS], mean: &[f64; COMBINATIONS]) -> Sample {
    let is_usable = tow.is_usable[row];
    let combined = combine(terms);
    let before = row.checked_sub(1).map(|before| tow.time_s[row] - tow.time_s[before]);
    Sample {
        terms: if is_usable { std::array::from_fn(|k| combined[k] - mean[k]) } else { [0.0; COMBINATIONS] },
        scalar_nt: if is_usable { tow.scalar_nt[row] } else { 0.0 },
        variance_ratio: if is_usable { 1.0 } else { f64::INFINITY },
        step_s: before.filter(|step_s| *step_s > 0.0).unwrap_or(if row == 0 { ON_DECK_S } else { 0.0 }),
        onset: if row == 0 { Onset::Recording } else { Onset::Nothing },
    }
}

/// The background of a recording begins near its first usable reading.
fn begin_at_a_reading(samples: &mut [Sample]) {
    let reading = samples.iter().find(|sample| sample.variance_ratio.is_finite()).map(|sample| sample.scalar_nt);
    if let (Some(first), Some(scalar_nt)) = (samples.first_mut(), reading) {
        first.scalar_nt = scalar_nt;
    }
}

fn terms_of(tow: &Tow) -> Vec<[f64; TERMS]> {
    let mut terms = vec![[0.0; TERMS]; tow.len()];
    for rows in tow.stretches() {
        let values = of_stretch(&tow.time_s, &tow.flux_nt, rows.clone());
        terms[rows].copy_from_slice(&values);
    }
    terms
}

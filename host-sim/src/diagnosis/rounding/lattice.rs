//! The step of a recorder, from the values that it wrote: a file may give them more digits than the recorder had.
//!
//! Values of a step lie at `offset + n step`, give or take half of the last digit. The smallest differences among the
//! sorted values hold few steps each: a periodogram of them shows the step. It is then made exact over ever larger
//! differences, each time as far as it is known well enough to count, until it holds for all values.

use std::f64::consts::TAU;

use crate::diagnosis::policy::{
    LATTICE_DIFFERENCES, LATTICE_LEAST_CONCENTRATION, LATTICE_LEAST_DIFFERENCES, LATTICE_LEAST_DIGITS,
    LATTICE_LEAST_SCORE, LATTICE_MOST_STEPS,
};

/// Points of the periodogram for each turn that the largest difference makes.
const POINTS_PER_TURN: f64 = 4.0;
/// The first point, in turns of the largest difference: below, everything is near to no turn at all.
const FIRST_TURN: f64 = 0.75;
/// Rounds in which the step is made exact.
const ROUNDS: usize = 40;
/// Standard error of a count up to which it is certain, steps. Small: differences of the same values err together.
const CERTAIN: f64 = 0.05;
/// Distance from a multiple beyond which a difference is not used, steps.
const OFF: f64 = 0.25;
/// Standard deviation of a difference at least, last digits: that of two roundings is 0.41.
const LEAST_SCATTER: f64 = 0.4;
/// How much larger a difference may be that is rounded up than one of as many steps that is rounded down.
const AS_MANY_STEPS: f64 = 1.5;
/// Differences that the periodogram is made of, at most.
const MOST_SCORED: usize = 128;
/// Peaks of the periodogram that are looked at: the first is the step, unless that is one of chance.
const MOST_CANDIDATES: usize = 4;

/// The multiples of a step, from an offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    /// In the unit of the values.
    pub(crate) step: f64,
    /// Standard error of the step, were the differences it is found from independent.
    pub(crate) step_error: f64,
    /// Any of its points.
    pub(crate) offset: f64,
}

impl Lattice {
    /// The coarsest lattice that values lie on, if it is coarser than the step of their last digit, `resolution`, by
    /// enough to be told from it.
    pub(crate) fn of(values: &[f64], resolution: f64) -> Option<Self> {
        let found = Self::beyond(values, resolution)?;
        // What is coarse may be rounded once more: each step may hide a coarser one, as the last digit does.
        Some(std::iter::successors(Some(found), |finer| Self::beyond(values, finer.step)).last().unwrap_or(found))
    }

    /// A lattice that is coarser than `resolution`.
    fn beyond(values: &[f64], resolution: f64) -> Option<Self> {
        let distinct = distinct(values, 0.5 * resolution);
        let differences = small_differences(&distinct, resolution)?;
        let steps = candidates(&differences, resolution).take(MOST_CANDIDATES);
        steps.filter_map(|step| Self::near(step, &differences, &distinct, resolution)).next()
    }

    /// The lattice whose step is about this one, if the values lie on it.
    fn near(step: f64, differences: &[f64], distinct: &[f64], resolution: f64) -> Option<Self> {
        let known = Known { step, error: 0.0, least_scatter: LEAST_SCATTER * resolution };
        let mut known = known.refined(differences.iter().copied())?;
        let range = distinct.last()? - distinct.first()?;
        for _ in 0..ROUNDS {
            let reach = known.countable();
            known = known.refined(lagged(distinct).filter(|difference| *difference <= reach))?;
            if reach >= range {
                break;
            }
        }
        let (concentration, offset) = phases(distinct, known.step);
        (concentration >= LATTICE_LEAST_CONCENTRATION).then_some(Self {
            step: known.step,
            step_error: known.error,
            offset,
        })
    }

    /// How near to the lattice values are, wherever its offset: 1 all on it, 0 anywhere. 1 where there is none.
    pub(crate) fn concentration(&self, values: &[f64]) -> f64 {
        if values.is_empty() { 1.0 } else { phases(values, self.step).0 }
    }

    /// Distance of a value from the nearest point, steps.
    pub(crate) fn off(&self, value: f64) -> f64 {
        let steps = (value - self.offset) / self.step;
        (steps - steps.round()).abs()
    }
}

/// A step, and how well it is known.
#[derive(Clone, Copy)]
struct Known {
    step: f64,
    /// Standard error.
    error: f64,
    /// Standard deviation that a difference has at least.
    least_scatter: f64,
}

impl Known {
    /// By least squares over differences that are multiples of it.
    fn refined(self, differences: impl Iterator<Item = f64>) -> Option<Self> {
        let (mut products, mut squares, mut errors, mut count) = (0.0, 0.0, 0.0, 0.0);
        for difference in differences {
            let steps = (difference / self.step).round();
            let off = difference - steps * self.step;
            if steps > 0.0 && off.abs() <= OFF * self.step {
                products += difference * steps;
                squares += steps * steps;
                errors += off * off;
                count += 1.0;
            }
        }
        let scatter = (errors / count).sqrt().max(self.least_scatter);
        (count > 0.0).then(|| Self { step: products / squares, error: scatter / squares.sqrt(), ..self })
    }

    /// The largest difference of which the number of steps is certain.
    fn countable(&self) -> f64 {
        CERTAIN * self.step * self.step / self.error
    }
}

/// Sorted values without those that repeat another one to within `apart`.
fn distinct(values: &[f64], apart: f64) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup_by(|next, before| *next - *before < apart);
    sorted
}

/// The smallest differences of neighbours, and all that may be as many steps: without these they would be those that happen
/// to be rounded down. Ascending; `None` where there are too few.
fn small_differences(sorted: &[f64], resolution: f64) -> Option<Vec<f64>> {
    let mut differences: Vec<f64> = sorted.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if differences.len() < LATTICE_LEAST_DIFFERENCES {
        return None;
    }
    differences.sort_by(f64::total_cmp);
    let largest = differences[LATTICE_DIFFERENCES.min(differences.len()) - 1];
    let largest = (largest + 2.0 * resolution).max(AS_MANY_STEPS * largest);
    differences.truncate(differences.partition_point(|difference| *difference <= largest));
    Some(differences)
}

/// Steps of which differences look like whole multiples, the largest first.
fn candidates(differences: &[f64], resolution: f64) -> impl Iterator<Item = f64> {
    let scored: Vec<f64> = differences.iter().copied().step_by(differences.len().div_ceil(MOST_SCORED)).collect();
    let largest = differences[differences.len() - 1];
    let finest = (LATTICE_LEAST_DIGITS * resolution).max(largest / LATTICE_MOST_STEPS);
    let points = (POINTS_PER_TURN * largest / finest).ceil() as usize;
    let frequency = move |point: usize| point as f64 / (POINTS_PER_TURN * largest);
    let first = (FIRST_TURN * POINTS_PER_TURN) as usize;
    let scores: Vec<f64> = (first..=points).map(|point| score(&scored, frequency(point))).collect();
    let is_peak = move |at: &usize| {
        let near = at.saturating_sub(1)..(at + 2).min(scores.len());
        scores[*at] >= LATTICE_LEAST_SCORE && scores[near].iter().all(|other| *other <= scores[*at])
    };
    (0..(points + 1).saturating_sub(first)).filter(is_peak).map(move |at| 1.0 / frequency(first + at))
}

/// Differences of sorted values 1, 2, 4, ... places apart.
fn lagged(sorted: &[f64]) -> impl Iterator<Item = f64> {
    let lags = std::iter::successors(Some(1_usize), |lag| Some(2 * lag)).take_while(|lag| *lag < sorted.len());
    lags.flat_map(|lag| sorted.iter().zip(&sorted[lag..]).map(|(low, high)| high - low))
}

/// Mean cosine of the differences at a frequency in turns per unit: 1 where all are whole turns.
fn score(differences: &[f64], frequency: f64) -> f64 {
    let sum: f64 = differences.iter().map(|difference| (TAU * frequency * difference).cos()).sum();
    sum / differences.len() as f64
}

/// Mean resultant length of the values as phases of a step, and the value in the middle of them.
fn phases(values: &[f64], step: f64) -> (f64, f64) {
    let (mut sine, mut cosine) = (0.0, 0.0);
    // From the first one, which keeps the digits of a phase.
    let first = values[0];
    for value in values {
        let turns = (value - first) / step;
        let (s, c) = (TAU * (turns - turns.round())).sin_cos();
        (sine, cosine) = (sine + s, cosine + c);
    }
    (sine.hypot(cosine) / values.len() as f64, first + step * sine.atan2(cosine) / TAU)
}

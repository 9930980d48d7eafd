//! Moves: a sensor that was moved, or a body that was opened, has other coefficients from then on.

use super::band::high_passed;
use super::kalman::{Model, Start, likelihood};
use super::outliers::raise_variances;
use super::series::{SAMPLE_S, Sample, Series};
use super::smoother::smooth;

/// Samples between two places where a move is looked for.
const EVERY: usize = 2;
/// Samples at either end, and to another move, where none is looked for: too few to tell new coefficients, 120 s.
const EDGE: usize = 240;
/// Places that are tried at most.
const MOST: usize = 8;
/// Fixed coefficients leave this many times as much, as a variance, of a recording with a move in it. A sensor that is moved
/// leaves a hundred times as much; what the terms do not describe leaves up to twice.
const LEAST_RATIO: f64 = 2.5;
/// What is nearer than this to a place counts for nothing in that, s: a strong target, or the jump of the move itself. Iron at 12 m,
/// passed at 1 m/s, has faded to a fortieth of its peak there.
const ABOUT_S: f64 = 30.0;
/// Rounds of counting less what stands out.
const ROUNDS: usize = 3;
/// A sample with so much more noise counts for nothing.
const NOTHING: f64 = 1e12;

/// Mark all moves.
pub(crate) fn mark_moves(series: &mut Series) {
    let mut band = high_passed(series);
    count_targets_less(&mut band);
    let mut tried: Vec<usize> = Vec::new();
    for _place in 0..MOST {
        let Some(at) = likeliest_move(&band, &tried) else { return };
        let is_move = is_move(&band, at);
        (band[at].moved, series.samples[at].moved) = (is_move, is_move);
        tried.push(at);
    }
}

/// What stands out of the rest is no move, which leaves something everywhere from there on: a strong target that is not found yet, or
/// not fitted well, in one half of a recording would look like other coefficients there.
fn count_targets_less(band: &mut [Sample]) {
    for _round in 0..ROUNDS {
        let smoothed = smooth(band, &Start::unknown(), &fixed(left_nt2(band)), None);
        if raise_variances(band, &smoothed) == 0 {
            return;
        }
    }
}

/// Where coefficients that change would explain most, away from what was tried and from both ends.
fn likeliest_move(samples: &[Sample], tried: &[usize]) -> Option<usize> {
    let smoothed = smooth(samples, &Start::unknown(), &fixed(left_nt2(samples)), Some(EVERY));
    let is_new = |at: &usize| tried.iter().all(|other| at.abs_diff(*other) > about());
    let is_far = |at: &usize| samples[at - EDGE..at + EDGE].iter().all(|near| !near.moved);
    let inner = EDGE..samples.len().saturating_sub(EDGE);
    inner.filter(|at| is_new(at) && is_far(at)).max_by(|&a, &b| smoothed[a].move_glrt.total_cmp(&smoothed[b].move_glrt))
}

/// Whether coefficients that change there explain what is away from it.
fn is_move(samples: &[Sample], at: usize) -> bool {
    let mut samples = samples.to_vec();
    let near = at.saturating_sub(about())..(at + about()).min(samples.len());
    samples[near].iter_mut().for_each(|sample| sample.variance_ratio = NOTHING);
    let without_nt2 = left_nt2(&samples);
    samples[at].moved = true;
    without_nt2 > LEAST_RATIO * left_nt2(&samples)
}

/// Samples to either side that count for nothing.
fn about() -> usize {
    (ABOUT_S / SAMPLE_S) as usize
}

fn fixed(noise_nt2: f64) -> Model {
    Model { noise_nt2, background: 0.0, slope: 0.0, coefficients: 0.0 }
}

/// What fixed coefficients leave, as a variance.
fn left_nt2(samples: &[Sample]) -> f64 {
    let start = Start::unknown();
    let once_nt2 = likelihood(samples, &start, &fixed(1.0)).1;
    likelihood(samples, &start, &fixed(once_nt2)).1
}

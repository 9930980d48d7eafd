//! Moves: a sensor that was moved, or a body that was opened, has other coefficients from then on.

use super::band::high_passed;
use super::kalman::{Model, Start, likelihood};
use super::series::{Sample, Series};
use super::smoother::smooth;

/// Samples between two places where a move is looked for.
const EVERY: usize = 2;
/// Samples at either end, and to another move, where none is looked for: too few to tell new coefficients, 120 s.
const EDGE: usize = 240;
/// Moves that are looked for at most.
const MOST: usize = 6;
/// Fixed coefficients leave this many times as much, as a variance, of a recording with a move in it. A sensor that is moved
/// leaves a hundred times as much; what the terms do not describe leaves up to twice.
const LEAST_RATIO: f64 = 2.5;

/// Mark all moves.
pub(crate) fn mark_moves(series: &mut Series) {
    let mut band = high_passed(series);
    for _move in 0..MOST {
        let Some(at) = next_move(&mut band) else { return };
        series.samples[at].moved = true;
    }
}

/// The likeliest move, marked; `None` when fixed coefficients leave little more without it.
fn next_move(samples: &mut [Sample]) -> Option<usize> {
    let start = Start::unknown();
    let fixed = |noise_nt2: f64| Model { noise_nt2, background: 0.0, slope: 0.0, coefficients: 0.0 };
    let left = |samples: &[Sample]| likelihood(samples, &start, &fixed(likelihood(samples, &start, &fixed(1.0)).1)).1;
    let without_nt2 = left(samples);
    let smoothed = smooth(samples, &start, &fixed(without_nt2), Some(EVERY));
    let is_far = |at: &usize| samples[at - EDGE..at + EDGE].iter().all(|near| !near.moved);
    let inner = EDGE..samples.len().saturating_sub(EDGE);
    let at = inner.filter(is_far).max_by(|&a, &b| smoothed[a].move_glrt.total_cmp(&smoothed[b].move_glrt))?;
    samples[at].moved = true;
    let is_move = without_nt2 > LEAST_RATIO * left(samples);
    if !is_move {
        samples[at].moved = false;
    }
    is_move.then_some(at)
}

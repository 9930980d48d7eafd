//! Effects that begin at some row and stay: every moment is tried, with sums over whole blocks made once.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::Candidate;
use crate::gap::bench::{Bench, Fit};
use crate::gap::span::{dot, explained};
use crate::gap::term::{Term, signatures};

/// Rows between the moments that are tried first.
const COARSE_ROWS: usize = 20;
/// The best of them are followed row by row.
const FOLLOWED: usize = 3;
/// Seconds after which a moment counts as another one.
const INDEPENDENT_S: f64 = 3.0;
/// Rows at the ends of the recording where nothing is taken to begin.
const END_ROWS: usize = 60;
/// Samples that are slipped.
const SLIPS: [f64; 6] = [-1.0, 1.0, -2.0, 2.0, -3.0, 3.0];

/// Products of columns among each other, with the span and with what is left, over some samples.
#[derive(Clone)]
struct Sums {
    gram: DMatrix<f64>,
    along: DMatrix<f64>,
    q: DVector<f64>,
}

/// Columns that act from a row on, all at once.
struct Onset<'a> {
    bench: &'a Bench<'a>,
    fit: &'a Fit,
    raw: Vec<Vec<f64>>,
    ranges: Vec<Range<usize>>,
    /// Sums over the blocks from each on.
    after: Vec<Sums>,
}

pub(super) fn scan(bench: &Bench<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let before_all_s = bench.signals.recording_time_s(0) - 1.0;
    let trials = (bench.duration_s() / INDEPENDENT_S).max(1.0);
    if bench.library[effect].spec().name == "permanent_step" {
        let at = vec![before_all_s, 0.0, 0.0, 0.0];
        let onset = Onset::new(bench, fit, signatures(&*bench.library[effect], &bench.signals, &at));
        let (row, gain, coordinates, rank) = onset.best(&|sums| sums.linear())?;
        let term = Term { effect, at: vec![moment_s(bench, row), 0.0, 0.0, 0.0], coordinates };
        return Some(Candidate { term, gain, freedom: rank as f64, trials, variance: None });
    }
    let slip = |samples: f64| {
        let at = vec![before_all_s, samples];
        let column = Term { effect, at, coordinates: Vec::new() }.column(bench.library, &bench.signals);
        let (row, gain, _, _) = Onset::new(bench, fit, vec![column]).best(&|sums| sums.fixed())?;
        let term = Term { effect, at: vec![moment_s(bench, row), samples], coordinates: Vec::new() };
        Some(Candidate { term, gain, freedom: 1.0, trials: trials * SLIPS.len() as f64, variance: None })
    };
    SLIPS.into_par_iter().filter_map(slip).max_by(|a, b| a.gain.total_cmp(&b.gain))
}

/// A time between the row and the one before, s on the recording's axis.
fn moment_s(bench: &Bench<'_>, row: usize) -> f64 {
    let time_s = bench.signals.recording_time_s(row);
    let step_s = if row > 0 { time_s - bench.signals.recording_time_s(row - 1) } else { 0.1 };
    time_s - 0.5 * step_s.min(0.1)
}

impl Sums {
    fn zero(columns: usize, rank: usize) -> Self {
        Self {
            gram: DMatrix::zeros(columns, columns),
            along: DMatrix::zeros(rank, columns),
            q: DVector::zeros(columns),
        }
    }

    fn plus(&self, other: &Self) -> Self {
        Self { gram: &self.gram + &other.gram, along: &self.along + &other.along, q: &self.q + &other.q }
    }

    fn swept(&self) -> DMatrix<f64> {
        &self.gram - self.along.transpose() * &self.along
    }

    /// Gain, coefficients and rank when the size is free.
    fn linear(&self) -> (f64, Vec<f64>, usize) {
        let gram = self.swept();
        // What the sweep has all but annihilated is rounding.
        if (0..gram.nrows()).any(|k| gram[(k, k)] < 1e-6 * self.gram[(k, k)]) {
            return (0.0, vec![0.0; self.q.len()], 0);
        }
        let (gain, coefficients, rank) = explained(&gram, &self.q);
        (gain, coefficients.as_slice().to_vec(), rank)
    }

    /// The same when it is given.
    fn fixed(&self) -> (f64, Vec<f64>, usize) {
        (2.0 * self.q[0] - self.swept()[(0, 0)], Vec::new(), 1)
    }
}

impl<'a> Onset<'a> {
    fn new(bench: &'a Bench<'a>, fit: &'a Fit, raw: Vec<Vec<f64>>) -> Self {
        let ranges = bench.whitener.ranges();
        let mut onset = Self { bench, fit, raw, ranges, after: Vec::new() };
        let blocks: Vec<Sums> = (0..onset.ranges.len()).into_par_iter().map(|block| onset.sums(block, 0)).collect();
        let mut sum = Sums::zero(onset.raw.len(), fit.span.rank());
        let mut after = vec![sum.clone()];
        for block in blocks.iter().rev() {
            sum = sum.plus(block);
            after.push(sum.clone());
        }
        after.reverse();
        onset.after = after;
        onset
    }

    /// Sums over one block of columns that begin `from` samples after its first.
    fn sums(&self, block: usize, from: usize) -> Sums {
        let rows = &self.bench.whitener.blocks()[block].rows;
        let range = self.ranges[block].clone();
        let whitened: Vec<Vec<f64>> = self
            .raw
            .iter()
            .map(|column| {
                let mut values = column[rows.clone()].to_vec();
                values[..from].fill(0.0);
                self.bench.whitener.apply_block(block, &values)
            })
            .collect();
        let m = whitened.len();
        let basis = self.fit.span.basis();
        Sums {
            gram: DMatrix::from_fn(m, m, |i, j| dot(&whitened[i], &whitened[j])),
            along: DMatrix::from_fn(basis.len(), m, |k, j| dot(&basis[k][range.clone()], &whitened[j])),
            q: DVector::from_fn(m, |j, _| dot(&whitened[j], &self.fit.rest[range.clone()])),
        }
    }

    /// The row, gain, coefficients and rank of the best moment.
    fn best(&self, gain: &(impl Fn(&Sums) -> (f64, Vec<f64>, usize) + Sync)) -> Option<(usize, f64, Vec<f64>, usize)> {
        let at = |block: usize, from: usize| gain(&self.sums(block, from).plus(&self.after[block + 1]));
        let moments: Vec<(usize, usize)> = (0..self.ranges.len())
            .flat_map(|block| (0..self.ranges[block].len()).step_by(COARSE_ROWS).map(move |from| (block, from)))
            .skip(1)
            .collect();
        // At the ends of the recording a few rows would be an event of their own.
        let rows = self.bench.whitener.blocks().iter().map(|block| block.rows.clone());
        let (first, last) = rows.clone().fold((usize::MAX, 0), |(a, b), rows| (a.min(rows.start), b.max(rows.end)));
        let row = |block: usize, from: usize| self.bench.whitener.blocks()[block].rows.start + from;
        let moments: Vec<(usize, usize)> = moments
            .into_iter()
            .filter(|&(block, from)| row(block, from) >= first + END_ROWS && row(block, from) + END_ROWS <= last)
            .collect();
        let mut coarse: Vec<(f64, usize, usize)> =
            moments.into_par_iter().map(|(block, from)| (at(block, from).0, block, from)).collect();
        coarse.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut best: Option<(f64, usize, usize)> = None;
        for &(_, block, from) in coarse.iter().take(FOLLOWED) {
            let near = from.saturating_sub(COARSE_ROWS)..(from + COARSE_ROWS).min(self.ranges[block].len());
            let found =
                near.into_par_iter().map(|from| (at(block, from).0, block, from)).max_by(|a, b| a.0.total_cmp(&b.0));
            best = [best, found].into_iter().flatten().max_by(|a, b| a.0.total_cmp(&b.0));
        }
        let (_, block, from) = best?;
        let (gain, coefficients, rank) = at(block, from);
        Some((self.bench.whitener.blocks()[block].rows.start + from, gain, coefficients, rank))
    }
}

//! Effects that begin at some row and stay: every moment is tried, with sums over whole blocks made once.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::{dot, explained};
use crate::diagnosis::regression::term::{Term, regressors};
use crate::diagnosis::search::Candidate;

/// Rows between the moments whose products are made.
const COARSE_ROWS: usize = 20;
/// The best moments by the products nearest to them are made row by row, so many rows on either side.
const FOLLOWED: usize = 3;
const BESIDE_ROWS: usize = 2;
/// Seconds after which a moment counts as another one: with it, half of 130 clean recordings have a best chance below one
/// half.
const INDEPENDENT_S: f64 = 0.8;
/// Rows at the ends of the recording where nothing is taken to begin.
const END_ROWS: usize = 200;

/// Products of columns among each other, with the span and with what is left, over some samples.
#[derive(Clone)]
struct Sums {
    gram: DMatrix<f64>,
    along: DMatrix<f64>,
    q: DVector<f64>,
}

/// Columns that act from a row on, all at once.
struct Onset<'a> {
    problem: &'a RegressionProblem<'a>,
    fit: &'a Fit,
    raw: Vec<Vec<f64>>,
    ranges: Vec<Range<usize>>,
    /// Sums over the blocks from each on.
    after: Vec<Sums>,
}

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize, sizes: &[f64]) -> Option<Candidate> {
    let before_all_s = problem.signals.recording_time_s(0) - 1.0;
    let trials_factor = (problem.duration_s() / INDEPENDENT_S).max(1.0);
    if sizes.is_empty() {
        let at_moment = |moment_s: f64| {
            let mut at = vec![0.0; problem.library[effect].spec().parameters.len()];
            at[0] = moment_s;
            at
        };
        let onset =
            Onset::new(problem, fit, regressors(&*problem.library[effect], &problem.signals, &at_moment(before_all_s)));
        let (row, glrt, coordinates, rank) = onset.best(linear)?;
        let term = Term { effect, at: at_moment(moment_s(problem, row)), coordinates };
        return Some(Candidate { term, glrt, dof: rank as f64, trials_factor, variance: None });
    }
    let slip = |samples: f64| {
        let at = vec![before_all_s, samples];
        let column = Term { effect, at, coordinates: Vec::new() }.column(problem.library, &problem.signals);
        let (row, glrt, _, _) = Onset::new(problem, fit, vec![column]).best(fixed)?;
        let term = Term { effect, at: vec![moment_s(problem, row), samples], coordinates: Vec::new() };
        Some(Candidate { term, glrt, dof: 1.0, trials_factor: trials_factor * sizes.len() as f64, variance: None })
    };
    sizes.par_iter().filter_map(|&size| slip(size)).max_by(|a, b| a.glrt.total_cmp(&b.glrt))
}

/// A time between the row and the one before, s on the recording's axis.
fn moment_s(problem: &RegressionProblem<'_>, row: usize) -> f64 {
    let time_s = problem.signals.recording_time_s(row);
    let step_s = if row > 0 { time_s - problem.signals.recording_time_s(row - 1) } else { 0.1 };
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

    /// Products of the columns without what lies in the span; none of those that the span has all but annihilated: what is
    /// left of them is rounding.
    fn projected(&self) -> DMatrix<f64> {
        let projected = &self.gram - self.along.transpose() * &self.along;
        if (0..projected.nrows()).any(|k| projected[(k, k)] < 1e-6 * self.gram[(k, k)]) {
            0.0 * projected
        } else {
            projected
        }
    }
}

/// Gain, coefficients and rank, from products of columns among each other and with what is left.
type Gain = (f64, Vec<f64>, usize);

/// When the size is free.
fn linear(gram: &DMatrix<f64>, q: &DVector<f64>) -> Gain {
    let (glrt, coefficients, rank) = explained(gram, q);
    (glrt, coefficients.as_slice().to_vec(), rank)
}

/// When it is given.
fn fixed(gram: &DMatrix<f64>, q: &DVector<f64>) -> Gain {
    if gram[(0, 0)] > 0.0 { (2.0 * q[0] - gram[(0, 0)], Vec::new(), 1) } else { (0.0, Vec::new(), 1) }
}

impl<'a> Onset<'a> {
    fn new(problem: &'a RegressionProblem<'a>, fit: &'a Fit, raw: Vec<Vec<f64>>) -> Self {
        let ranges = problem.whitening.ranges();
        let mut onset = Self { problem, fit, raw, ranges, after: Vec::new() };
        let blocks: Vec<Sums> = (0..onset.ranges.len()).into_par_iter().map(|block| onset.sums(block, 0)).collect();
        let mut sum = Sums::zero(onset.raw.len(), fit.projection.rank());
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
        let rows = &self.problem.whitening.blocks()[block].rows;
        let range = self.ranges[block].clone();
        let whitened: Vec<Vec<f64>> = self
            .raw
            .iter()
            .map(|column| {
                let mut values = column[rows.clone()].to_vec();
                values[..from].fill(0.0);
                self.problem.whitening.apply_block(block, &values)
            })
            .collect();
        let m = whitened.len();
        let basis = self.fit.projection.basis();
        Sums {
            gram: DMatrix::from_fn(m, m, |i, j| dot(&whitened[i], &whitened[j])),
            along: DMatrix::from_fn(basis.len(), m, |k, j| dot(&basis[k][range.clone()], &whitened[j])),
            q: DVector::from_fn(m, |j, _| dot(&whitened[j], &self.fit.residual_whitened[range.clone()])),
        }
    }

    /// The row, gain, coefficients and rank of the best moment.
    fn best(&self, glrt: fn(&DMatrix<f64>, &DVector<f64>) -> Gain) -> Option<(usize, f64, Vec<f64>, usize)> {
        let mut tried = self.every_row(glrt);
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut followed: Vec<(usize, usize)> = Vec::new();
        for (_, block, from) in tried {
            if !followed.iter().any(|other| other.0 == block && other.1.abs_diff(from) <= COARSE_ROWS) {
                followed.push((block, from));
            }
            if followed.len() == FOLLOWED {
                break;
            }
        }
        let blocks = self.problem.whitening.blocks();
        let beside = |&(block, from): &(usize, usize)| {
            let near = from.saturating_sub(BESIDE_ROWS)..(from + BESIDE_ROWS + 1).min(blocks[block].len());
            near.map(move |from| (block, from))
        };
        let found = followed.iter().flat_map(beside).map(|(block, from)| {
            let sums = self.from(block, from);
            let (glrt, coefficients, rank) = glrt(&sums.projected(), &sums.q);
            (blocks[block].rows.start + from, glrt, coefficients, rank)
        });
        found.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// About how much each row of each block would gain, were it the moment.
    ///
    /// An edge shows within a row or two where the background is taken out, so that every row is tried: what is left is
    /// summed up for each, and the products of the columns, which change slowly, are those of a moment near by.
    fn every_row(&self, glrt: fn(&DMatrix<f64>, &DVector<f64>) -> Gain) -> Vec<(f64, usize, usize)> {
        let left = self.left();
        let blocks = self.problem.whitening.blocks();
        let (Some(first), Some(last)) = (blocks.first(), blocks.last()) else { return Vec::new() };
        // At the ends of the recording a few rows would be an event of their own.
        let inner = first.rows.start + END_ROWS..=last.rows.end.saturating_sub(END_ROWS);
        let parts = |block: usize| {
            let len = blocks[block].len();
            (0..len).step_by(COARSE_ROWS).map(move |from| (block, from, (from + COARSE_ROWS).min(len)))
        };
        let parts: Vec<(usize, usize, usize)> = (0..blocks.len()).flat_map(parts).collect();
        let of_part = |(block, from, to): (usize, usize, usize)| {
            let start = blocks[block].rows.start;
            let gram = self.from(block, (from + to) / 2).projected();
            let (left, inner) = (&left, &inner);
            let rows = (from..to).filter(move |from| inner.contains(&(start + from)));
            rows.map(move |from| (glrt(&gram, &left[start + from]).0, block, from))
        };
        parts.into_par_iter().flat_map_iter(of_part).collect()
    }

    /// Sums over everything from a row of a block on.
    fn from(&self, block: usize, from: usize) -> Sums {
        self.sums(block, from).plus(&self.after[block + 1])
    }

    /// Products with what is left of columns that begin at each row.
    fn left(&self) -> Vec<DVector<f64>> {
        let rows = self.problem.signals.len();
        let adjoint = self.problem.whitening.transposed(&self.fit.residual_whitened, rows);
        let mut sum = DVector::zeros(self.raw.len());
        let mut left = vec![sum.clone(); rows];
        for row in (0..rows).rev() {
            self.raw.iter().enumerate().for_each(|(k, column)| sum[k] += adjoint[row] * column[row]);
            left[row].copy_from(&sum);
        }
        left
    }
}

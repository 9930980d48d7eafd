//! Effects that begin at some row and stay: every moment is tried, with sums over whole blocks made once.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::diagnosis::policy::{EPOCH_S, ONSET_END_ROWS, ONSET_INDEPENDENT_S, PROJECTED_LEAST_SHARE};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::regression::projection::explained;
use crate::diagnosis::regression::term::{Term, regressors};
use crate::diagnosis::search::Candidate;

/// Rows between the moments whose products are made.
const COARSE_ROWS: usize = 20;
/// The best moments by the products nearest to them are made row by row, so many rows on either side.
const FOLLOWED: usize = 3;
const BESIDE_ROWS: usize = 2;
/// The best moment of an effect whose first parameter is one. Its size is either linear, or one of
/// `sizes` of the second parameter.
pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize, sizes: &[f64]) -> Option<Candidate> {
    let mut at = vec![0.0; problem.library[effect].spec().parameters.len()];
    // Before the first row, so that the columns have it everywhere.
    at[0] = problem.signals.recording_time_s(0) - 1.0;
    if !sizes.is_empty() {
        let of_size = |&size: &f64| {
            let term = Term { effect, at: vec![at[0], size], coordinates: Vec::new() };
            of_given_size(problem, fit, term, sizes.len())
        };
        return sizes.par_iter().filter_map(of_size).max_by(|a, b| a.glrt.total_cmp(&b.glrt));
    }
    let raw = regressors(&*problem.library[effect], &problem.signals, &at);
    let Moment { row, explained } = Onset::new(problem, fit, raw).best(free_size)?;
    at[0] = moment_s(problem, row);
    let term = Term { effect, at, coordinates: explained.coefficients };
    let (glrt, dof) = (explained.glrt, explained.rank as f64);
    Some(Candidate { term, glrt, dof, trials_factor: moments(problem), variance: None })
}

/// The best moment of one of `sizes` given sizes.
fn of_given_size(problem: &RegressionProblem<'_>, fit: &Fit, mut term: Term, sizes: usize) -> Option<Candidate> {
    let column = term.column(problem.library, &problem.signals);
    let Moment { row, explained } = Onset::new(problem, fit, vec![column]).best(given_size)?;
    term.at[0] = moment_s(problem, row);
    let trials_factor = moments(problem) * sizes as f64;
    Some(Candidate { term, glrt: explained.glrt, dof: 1.0, trials_factor, variance: None })
}

/// Independent moments of a recording.
fn moments(problem: &RegressionProblem<'_>) -> f64 {
    (problem.duration_s() / ONSET_INDEPENDENT_S).max(1.0)
}

/// A time between the row and the one before, s on the recording's axis.
fn moment_s(problem: &RegressionProblem<'_>, row: usize) -> f64 {
    let time_s = problem.signals.recording_time_s(row);
    let step_s = if row > 0 { time_s - problem.signals.recording_time_s(row - 1) } else { EPOCH_S };
    time_s - 0.5 * step_s.min(EPOCH_S)
}

/// Products of whitened columns over some samples.
#[derive(Clone)]
struct Products {
    /// Among each other.
    gram: DMatrix<f64>,
    /// With the directions of everything fitted: directions by columns.
    along: DMatrix<f64>,
    /// With the residual.
    q: DVector<f64>,
}

impl Products {
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

    /// Products among each other of the columns with everything fitted projected out; 0 where that leaves next to nothing
    /// of a column, which is rounding.
    fn projected(&self) -> DMatrix<f64> {
        let projected = &self.gram - self.along.transpose() * &self.along;
        if (0..projected.nrows()).any(|k| projected[(k, k)] < PROJECTED_LEAST_SHARE * self.gram[(k, k)]) {
            0.0 * projected
        } else {
            projected
        }
    }
}

/// What columns that begin at a moment explain.
struct Explained {
    glrt: f64,
    coefficients: Vec<f64>,
    rank: usize,
}

/// What is explained, from products of columns among each other and with the residual.
type Explain = fn(&DMatrix<f64>, &DVector<f64>) -> Explained;

/// When the size is free.
fn free_size(gram: &DMatrix<f64>, q: &DVector<f64>) -> Explained {
    let (glrt, coefficients, rank) = explained(gram, q);
    Explained { glrt, coefficients: coefficients.as_slice().to_vec(), rank }
}

/// When it is given.
fn given_size(gram: &DMatrix<f64>, q: &DVector<f64>) -> Explained {
    let glrt = if gram[(0, 0)] > 0.0 { 2.0 * q[0] - gram[(0, 0)] } else { 0.0 };
    Explained { glrt, coefficients: Vec::new(), rank: 1 }
}

/// A row, and what columns that begin there explain.
struct Moment {
    row: usize,
    explained: Explained,
}

/// Columns that act from a row on, to be tried at every row.
struct Onset<'a> {
    problem: &'a RegressionProblem<'a>,
    fit: &'a Fit,
    /// The columns as if they acted everywhere, nT, one value a row.
    raw: Vec<Vec<f64>>,
    /// The samples of each block.
    ranges: Vec<Range<usize>>,
    /// Products over all blocks from each one on.
    after: Vec<Products>,
}

impl<'a> Onset<'a> {
    fn new(problem: &'a RegressionProblem<'a>, fit: &'a Fit, raw: Vec<Vec<f64>>) -> Self {
        let ranges = problem.whitening.ranges();
        let mut onset = Self { problem, fit, raw, ranges, after: Vec::new() };
        let blocks: Vec<Products> =
            (0..onset.ranges.len()).into_par_iter().map(|block| onset.products(block, 0)).collect();
        let mut sum = Products::zero(onset.raw.len(), fit.projection.rank());
        let mut after = vec![sum.clone()];
        for block in blocks.iter().rev() {
            sum = sum.plus(block);
            after.push(sum.clone());
        }
        after.reverse();
        onset.after = after;
        onset
    }

    /// Products over one block of columns that begin `from` samples after its first.
    fn products(&self, block: usize, from: usize) -> Products {
        let rows = &self.problem.whitening.blocks()[block].rows;
        let range = self.ranges[block].clone();
        let whiten = |column: &Vec<f64>| {
            let mut values = column[rows.clone()].to_vec();
            values[..from].fill(0.0);
            self.problem.whitening.apply_block(block, &values)
        };
        let whitened: Vec<Vec<f64>> = self.raw.iter().map(whiten).collect();
        let m = whitened.len();
        let basis = self.fit.projection.basis();
        Products {
            gram: DMatrix::from_fn(m, m, |i, j| dot(&whitened[i], &whitened[j])),
            along: DMatrix::from_fn(basis.len(), m, |k, j| dot(&basis[k][range.clone()], &whitened[j])),
            q: DVector::from_fn(m, |j, _| dot(&whitened[j], &self.fit.residual_whitened[range.clone()])),
        }
    }

    /// Products over everything from a row of a block on.
    fn from(&self, block: usize, from: usize) -> Products {
        self.products(block, from).plus(&self.after[block + 1])
    }

    /// The best moment.
    fn best(&self, explain: Explain) -> Option<Moment> {
        let blocks = self.problem.whitening.blocks();
        let beside = |(block, from): (usize, usize)| {
            let near = from.saturating_sub(BESIDE_ROWS)..(from + BESIDE_ROWS + 1).min(blocks[block].len());
            near.map(move |from| (block, from))
        };
        let tried = self.most_promising(explain).into_iter().flat_map(beside).map(|(block, from)| {
            let products = self.from(block, from);
            let explained = explain(&products.projected(), &products.q);
            Moment { row: blocks[block].rows.start + from, explained }
        });
        tried.max_by(|a, b| a.explained.glrt.total_cmp(&b.explained.glrt))
    }

    /// The best moments by [`Self::every_row`], none near another one: block, and samples after its first.
    fn most_promising(&self, explain: Explain) -> Vec<(usize, usize)> {
        let mut tried = self.every_row(explain);
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut promising: Vec<(usize, usize)> = Vec::new();
        for (_, block, from) in tried {
            if !promising.iter().any(|other| other.0 == block && other.1.abs_diff(from) <= COARSE_ROWS) {
                promising.push((block, from));
            }
            if promising.len() == FOLLOWED {
                break;
            }
        }
        promising
    }

    /// About how much would be explained, were it the moment, by every row: GLRT, block, samples after its first.
    ///
    /// With the background projected out an edge shows within a row or two, so that every row is tried: the products with
    /// the residual are summed up for each, and the products of the columns, which change slowly, are those of a moment
    /// near by.
    fn every_row(&self, explain: Explain) -> Vec<(f64, usize, usize)> {
        let q = self.products_with_residual();
        let blocks = self.problem.whitening.blocks();
        let (Some(first), Some(last)) = (blocks.first(), blocks.last()) else { return Vec::new() };
        // At the ends of the recording a few rows would be an event of their own.
        let inner = first.rows.start + ONSET_END_ROWS..=last.rows.end.saturating_sub(ONSET_END_ROWS);
        let parts = |block: usize| {
            let len = blocks[block].len();
            (0..len).step_by(COARSE_ROWS).map(move |from| (block, from, (from + COARSE_ROWS).min(len)))
        };
        let parts: Vec<(usize, usize, usize)> = (0..blocks.len()).flat_map(parts).collect();
        let of_part = |(block, from, to): (usize, usize, usize)| {
            let start = blocks[block].rows.start;
            let gram = self.from(block, (from + to) / 2).projected();
            let (q, inner) = (&q, &inner);
            let rows = (from..to).filter(move |from| inner.contains(&(start + from)));
            rows.map(move |from| (explain(&gram, &q[start + from]).glrt, block, from))
        };
        parts.into_par_iter().flat_map_iter(of_part).collect()
    }

    /// Products with the residual of columns that begin at each row, by the transpose of the whitening.
    fn products_with_residual(&self) -> Vec<DVector<f64>> {
        let rows = self.problem.signals.len();
        let adjoint = self.problem.whitening.transposed(&self.fit.residual_whitened, rows);
        let mut sum = DVector::zeros(self.raw.len());
        let mut products = vec![sum.clone(); rows];
        for row in (0..rows).rev() {
            self.raw.iter().enumerate().for_each(|(k, column)| sum[k] += adjoint[row] * column[row]);
            products[row].copy_from(&sum);
        }
        products
    }
}

//! Columns as independent samples of equal variance: background projected out per block, noise whitened.

use nalgebra::DMatrix;
use rayon::prelude::*;
use rustfft::num_complex::Complex;

use crate::diagnosis::noise::blocks::Block;

/// Order of the noise model.
const ORDER: usize = 32;
/// Samples that are whitened side by side.
const LANES: usize = 8;

/// Predictors of every order up to the last, by the Levinson recursion: whitening from the first sample on.
#[derive(Clone, Debug)]
pub(crate) struct Predictor {
    /// Of order `k` at `k`: the weights of the samples before, the latest first, and the standard deviation left.
    orders: Vec<(Vec<f64>, f64)>,
}

impl Predictor {
    /// For noise without colour.
    pub(crate) fn white(std: f64) -> Self {
        Self { orders: vec![(Vec::new(), std)] }
    }

    /// From an autocovariance, lag 0 first.
    pub(crate) fn levinson(autocovariance: &[f64]) -> Self {
        let order = ORDER.min(autocovariance.len() - 1);
        let mut variance = autocovariance[0].max(f64::MIN_POSITIVE);
        let mut weights: Vec<f64> = Vec::new();
        let mut orders = vec![(weights.clone(), variance.sqrt())];
        for k in 1..=order {
            let known: f64 = weights.iter().enumerate().map(|(i, w)| w * autocovariance[k - 1 - i]).sum();
            let reflection = (autocovariance[k] - known) / variance;
            if reflection.abs() >= 1.0 {
                break;
            }
            let last = weights.clone();
            for (i, weight) in weights.iter_mut().enumerate() {
                *weight -= reflection * last[k - 2 - i];
            }
            weights.push(reflection);
            variance *= 1.0 - reflection * reflection;
            orders.push((weights.clone(), variance.sqrt()));
        }
        Self { orders }
    }

    /// Prediction errors over their standard deviations.
    fn apply(&self, values: &[f64], out: &mut [f64]) {
        let last = self.orders.len() - 1;
        let start = last.min(values.len());
        for k in 0..start {
            let (weights, std) = &self.orders[k];
            let known: f64 = weights.iter().zip(values[..k].iter().rev()).map(|(w, x)| w * x).sum();
            out[k] = (values[k] - known) / std;
        }
        let (weights, std) = &self.orders[last];
        let mut groups = out[start..].chunks_exact_mut(LANES);
        let mut k = start;
        for group in &mut groups {
            // Side by side, which the compiler turns into vector instructions; each sum in its own order, so that its bits
            // depend on no machine.
            let mut known = [0.0; LANES];
            for (i, weight) in weights.iter().enumerate() {
                let before = &values[k - 1 - i..][..LANES];
                known.iter_mut().zip(before).for_each(|(sum, x)| *sum += weight * x);
            }
            let errors = values[k..].iter().zip(known).map(|(value, known)| (value - known) / std);
            group.iter_mut().zip(errors).for_each(|(out, error)| *out = error);
            k += LANES;
        }
        for out in groups.into_remainder() {
            let known: f64 = weights.iter().zip(values[..k].iter().rev()).map(|(w, x)| w * x).sum();
            *out = (values[k] - known) / std;
            k += 1;
        }
    }

    /// The transpose of [`Self::apply`].
    fn apply_transposed(&self, values: &[f64], out: &mut [f64]) {
        let last = self.orders.len() - 1;
        out.fill(0.0);
        for k in 0..values.len() {
            let (weights, std) = &self.orders[k.min(last)];
            let value = values[k] / std;
            out[k] += value;
            for (i, w) in weights.iter().enumerate() {
                out[k - 1 - i] -= w * value;
            }
        }
    }

    /// Power that a sine of `cycles` per row has after whitening, of 1.
    pub(crate) fn response(&self, cycles: f64) -> f64 {
        let (weights, std) = &self.orders[self.orders.len() - 1];
        // Horner's scheme: one sine for all weights.
        let turn = Complex::cis(-std::f64::consts::TAU * cycles);
        let known = weights.iter().rev().fold(Complex::<f64>::ZERO, |sum, &weight| (sum + weight) * turn);
        (1.0 - known).norm_sqr() / (std * std)
    }

    /// Squared weights by lag: what of a white addition's variance an innovation holds is their sum.
    pub(crate) fn squared_weights(&self) -> Vec<f64> {
        let (weights, std) = &self.orders[self.orders.len() - 1];
        std::iter::once(1.0).chain(weights.iter().map(|w| w * w)).map(|w| w / (std * std)).collect()
    }
}

/// Everything that turns a column over the rows into a whitened, projected one over the samples.
#[derive(Clone, Debug)]
pub(crate) struct Whitening {
    blocks: Vec<Block>,
    predictor: Predictor,
    /// Orthonormal basis of background and missing rows, whitened, per block: one row a sample.
    bases: Vec<DMatrix<f64>>,
    /// Weight of each sample, 1 but where the noise is known to be larger.
    weights: Vec<f64>,
    samples: usize,
}

impl Whitening {
    /// Whitening by `predictor`; `weights`, if any, one a sample.
    pub(crate) fn new(blocks: &[Block], predictor: Predictor, weights: Option<Vec<f64>>) -> Self {
        let samples = blocks.iter().map(Block::len).sum();
        let weights = weights.unwrap_or_else(|| vec![1.0; samples]);
        let mut starts = Vec::with_capacity(blocks.len());
        let mut start = 0;
        for block in blocks {
            starts.push(start);
            start += block.len();
        }
        let bases = (0..blocks.len())
            .into_par_iter()
            .map(|b| {
                let block = &blocks[b];
                basis(block, &predictor, &weights[starts[b]..starts[b] + block.len()])
            })
            .collect();
        Self { blocks: blocks.to_vec(), predictor, bases, weights, samples }
    }

    /// The same noise model without a background.
    pub(crate) fn without_background(other: &Self) -> Self {
        let bases = other.blocks.iter().map(|block| DMatrix::zeros(block.len(), 0)).collect();
        Self { bases, ..other.clone() }
    }

    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    pub(crate) fn predictor(&self) -> &Predictor {
        &self.predictor
    }

    pub(crate) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// How many samples a whitened column has.
    pub(crate) fn samples(&self) -> usize {
        self.samples
    }

    /// Degrees of degrees of freedom that the background leaves.
    pub(crate) fn dof(&self) -> f64 {
        self.samples as f64 - self.bases.iter().map(|basis| basis.ncols() as f64).sum::<f64>()
    }

    /// The same of one block.
    pub(crate) fn block_dof(&self, block: usize) -> f64 {
        self.blocks[block].len() as f64 - self.bases[block].ncols() as f64
    }

    /// The samples of each block in a whitened column.
    pub(crate) fn ranges(&self) -> Vec<std::ops::Range<usize>> {
        let mut start = 0;
        let range = |block: &Block| {
            let range = start..start + block.len();
            start = range.end;
            range
        };
        self.blocks.iter().map(range).collect()
    }

    /// The values of a whitened column at rows with a reading.
    pub(crate) fn observed<'b>(&'b self, column: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        self.blocks.iter().zip(self.ranges()).flat_map(move |(block, range)| {
            let is_there = move |k: &usize| block.missing.binary_search(&(k - range.start)).is_err();
            range.clone().filter(is_there).map(move |k| column[k])
        })
    }

    /// The row of each sample.
    pub(crate) fn rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.blocks.iter().flat_map(|block| block.rows.clone())
    }

    /// Whiten and project a column over the rows of the recording. What is no number at a missing row is taken as 0.
    pub(crate) fn apply(&self, column: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.samples];
        let mut start = 0;
        for (block, basis) in self.blocks.iter().zip(&self.bases) {
            let part = &mut out[start..start + block.len()];
            self.predictor.apply(&block.values(column), part);
            for (value, weight) in part.iter_mut().zip(&self.weights[start..]) {
                *value *= weight;
            }
            project(basis, part);
            start += block.len();
        }
        out
    }

    /// Whiten and project the part of a column that is one block's.
    pub(crate) fn apply_block(&self, block: usize, values: &[f64]) -> Vec<f64> {
        let start: usize = self.blocks[..block].iter().map(Block::len).sum();
        let mut values = values.to_vec();
        self.blocks[block].missing.iter().for_each(|&at| values[at] = 0.0);
        let mut out = vec![0.0; values.len()];
        self.predictor.apply(&values, &mut out);
        out.iter_mut().zip(&self.weights[start..]).for_each(|(value, weight)| *value *= weight);
        project(&self.bases[block], &mut out);
        out
    }

    /// The column over `rows` rows whose product with any raw column is that of `whitened` with the whitened one.
    pub(crate) fn transposed(&self, whitened: &[f64], rows: usize) -> Vec<f64> {
        let mut out = vec![0.0; rows];
        let mut start = 0;
        for (block, basis) in self.blocks.iter().zip(&self.bases) {
            let mut part = whitened[start..start + block.len()].to_vec();
            project(basis, &mut part);
            for (value, weight) in part.iter_mut().zip(&self.weights[start..]) {
                *value *= weight;
            }
            let mut raw = vec![0.0; part.len()];
            self.predictor.apply_transposed(&part, &mut raw);
            for (row, value) in block.rows.clone().zip(raw) {
                out[row] = value;
            }
            block.missing.iter().for_each(|&at| out[block.rows.start + at] = 0.0);
            start += block.len();
        }
        out
    }
}

/// Take the basis out of a column.
fn project(basis: &DMatrix<f64>, column: &mut [f64]) {
    for base in basis.column_iter() {
        let base = base.as_slice();
        let along: f64 = base.iter().zip(column.iter()).map(|(b, x)| b * x).sum();
        column.iter_mut().zip(base).for_each(|(x, b)| *x -= along * b);
    }
}

fn basis(block: &Block, predictor: &Predictor, weights: &[f64]) -> DMatrix<f64> {
    let columns = block.nuisance();
    let mut whitened = DMatrix::zeros(block.len(), columns.len());
    for (column, mut out) in columns.iter().zip(whitened.column_iter_mut()) {
        predictor.apply(column, out.as_mut_slice());
        out.iter_mut().zip(weights).for_each(|(value, weight)| *value *= weight);
    }
    whitened.qr().q()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_recursion_solves_the_normal_equations() {
        let autocovariance: Vec<f64> = (0..6).map(|k| 0.9_f64.powi(k) + if k == 0 { 0.5 } else { 0.0 }).collect();
        let predictor = Predictor::levinson(&autocovariance);
        let (weights, std) = &predictor.orders[5];
        let normal = DMatrix::from_fn(5, 5, |i, j| autocovariance[i.abs_diff(j)]);
        let right = nalgebra::DVector::from_fn(5, |i, _| autocovariance[i + 1]);
        let direct = normal.lu().solve(&right).expect("positive definite");
        let variance = autocovariance[0] - direct.dot(&right);
        assert!(weights.iter().zip(direct.iter()).all(|(a, b)| (a - b).abs() < 1e-12));
        assert!((std - variance.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn whitening_is_the_inverse_of_the_covariance_and_its_transpose_is_one() {
        let autocovariance: Vec<f64> = (0..40).map(|k| 0.8_f64.powi(k)).collect();
        let predictor = Predictor::levinson(&autocovariance);
        let n = 40;
        let whiten = |x: &[f64]| {
            let mut out = vec![0.0; n];
            predictor.apply(x, &mut out);
            out
        };
        let unit = |k: usize| (0..n).map(|i| f64::from(u8::from(i == k))).collect::<Vec<_>>();
        let matrix = DMatrix::from_columns(&(0..n).map(|k| whiten(&unit(k)).into()).collect::<Vec<_>>());
        let covariance = DMatrix::from_fn(n, n, |i, j| autocovariance[i.abs_diff(j)]);
        let identity = &matrix * covariance * matrix.transpose();
        assert!((identity - DMatrix::identity(n, n)).amax() < 1e-9);
        let mut transposed = vec![0.0; n];
        predictor.apply_transposed(&unit(17), &mut transposed);
        assert!((0..n).all(|k| (transposed[k] - matrix[(17, k)]).abs() < 1e-12));
    }
}

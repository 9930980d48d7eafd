//! Columns as independent samples of equal variance: background projected out per block, noise whitened.

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::diagnosis::noise::blocks::Block;
pub(crate) use crate::diagnosis::noise::predictor::Predictor;
use crate::diagnosis::regression::products::project_out;

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
        let parts: Vec<_> = blocks.iter().zip(ranges(blocks)).collect();
        let bases = parts.into_par_iter().map(|(block, range)| basis(block, &predictor, &weights[range])).collect();
        Self { blocks: blocks.to_vec(), predictor, bases, weights, samples }
    }

    /// The same noise model without a background.
    pub(crate) fn without_background(other: &Self) -> Self {
        let bases = other.blocks.iter().map(|block| DMatrix::zeros(block.len(), 0)).collect();
        Self { bases, ..other.clone() }
    }

    /// For white noise that is as loud.
    pub(crate) fn of_white_noise(&self) -> Self {
        Self::new(&self.blocks, Predictor::white(self.predictor.std()), Some(self.weights.clone()))
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

    /// Degrees of freedom that the background leaves.
    pub(crate) fn dof(&self) -> f64 {
        (0..self.blocks.len()).map(|block| self.block_dof(block)).sum()
    }

    /// Those of one block.
    pub(crate) fn block_dof(&self, block: usize) -> f64 {
        let own = &self.blocks[block];
        own.len() as f64 - own.between_parts().count() as f64 - self.bases[block].ncols() as f64
    }

    /// The samples of each block in a whitened column.
    pub(crate) fn ranges(&self) -> Vec<std::ops::Range<usize>> {
        ranges(&self.blocks)
    }

    /// The values of a whitened column at rows with a reading.
    pub(crate) fn observed<'b>(&'b self, column: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        self.blocks.iter().zip(self.ranges()).flat_map(move |(block, range)| {
            let is_there = move |k: &usize| block.missing.binary_search(&(k - range.start)).is_err();
            range.clone().filter(is_there).map(move |k| column[k])
        })
    }

    /// What is projected out of a block: orthonormal directions, one value a sample of the block.
    pub(crate) fn directions(&self, block: usize) -> impl Iterator<Item = &[f64]> {
        let basis = &self.bases[block];
        basis.as_slice().chunks_exact(basis.nrows().max(1))
    }

    /// The row of each sample.
    pub(crate) fn rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.blocks.iter().flat_map(|block| block.rows.clone())
    }

    /// Whiten and project a column over the rows of the recording, nT; one value a sample, noise of variance 1. Values at
    /// missing rows do not matter.
    pub(crate) fn apply(&self, column: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.samples];
        for ((block, basis), range) in self.blocks.iter().zip(&self.bases).zip(self.ranges()) {
            let part = &mut out[range.clone()];
            whiten(block, &self.predictor, &block.values(column), part);
            weigh(part, &self.weights[range]);
            project(basis, part);
        }
        out
    }

    /// Whiten and project the part of a column that is one block's: as many values as it has rows.
    pub(crate) fn apply_block(&self, block: usize, values: &[f64]) -> Vec<f64> {
        let range = self.ranges()[block].clone();
        let mut values = values.to_vec();
        self.blocks[block].missing.iter().for_each(|&at| values[at] = 0.0);
        let mut out = vec![0.0; values.len()];
        whiten(&self.blocks[block], &self.predictor, &values, &mut out);
        weigh(&mut out, &self.weights[range]);
        project(&self.bases[block], &mut out);
        out
    }

    /// The transpose of [`Self::apply`]: the column over `rows` rows of the recording whose product with any column is that
    /// of `whitened` with the whitened column.
    pub(crate) fn transposed(&self, whitened: &[f64], rows: usize) -> Vec<f64> {
        let mut out = vec![0.0; rows];
        for ((block, basis), range) in self.blocks.iter().zip(&self.bases).zip(self.ranges()) {
            let mut part = whitened[range.clone()].to_vec();
            project(basis, &mut part);
            weigh(&mut part, &self.weights[range]);
            let raw = &mut out[block.rows.clone()];
            for own in block.parts() {
                self.predictor.apply_transposed(&part[own.clone()], &mut raw[own]);
            }
            block.missing.iter().for_each(|&at| raw[at] = 0.0);
        }
        out
    }
}

/// The samples of each block, in order.
fn ranges(blocks: &[Block]) -> Vec<std::ops::Range<usize>> {
    let mut start = 0;
    let range = |block: &Block| {
        let range = start..start + block.len();
        start = range.end;
        range
    };
    blocks.iter().map(range).collect()
}

/// Project a column onto the orthogonal complement of an orthonormal basis, one direction after another.
fn project(basis: &DMatrix<f64>, column: &mut [f64]) {
    project_out(column, (0..basis.ncols()).map(|k| &basis.as_slice()[k * basis.nrows()..(k + 1) * basis.nrows()]));
}

/// Prediction errors of a block's values, part by part; `out` stays as it is where no part is.
fn whiten(block: &Block, predictor: &Predictor, values: &[f64], out: &mut [f64]) {
    for part in block.parts() {
        predictor.apply(&values[part.clone()], &mut out[part]);
    }
}

fn weigh(values: &mut [f64], weights: &[f64]) {
    values.iter_mut().zip(weights).for_each(|(value, weight)| *value *= weight);
}

/// Orthonormal basis of the whitened, weighted nuisance columns of a block: one row a sample.
fn basis(block: &Block, predictor: &Predictor, weights: &[f64]) -> DMatrix<f64> {
    let columns = block.nuisance();
    let mut whitened = DMatrix::zeros(block.len(), columns.len());
    for (column, mut out) in columns.iter().zip(whitened.column_iter_mut()) {
        whiten(block, predictor, column, out.as_mut_slice());
        weigh(out.as_mut_slice(), weights);
    }
    whitened.qr().q()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::policy::LONG_RUN_ROWS;
    use crate::diagnosis::regression::products::dot;

    fn block(missing: Vec<usize>) -> Block {
        Block { rows: 0..400, missing, targets: Vec::new() }
    }

    fn red() -> Predictor {
        Predictor::levinson(&(0..40).map(|k| 0.8_f64.powi(k)).collect::<Vec<_>>())
    }

    #[test]
    fn what_was_not_read_counts_for_nothing_however_many_rows_it_is() {
        let whitening = Whitening::new(&[block((60..64).chain(200..200 + 4 * LONG_RUN_ROWS).collect())], red(), None);
        let column: Vec<f64> = (0..400).map(|row| (0.7 * f64::from(row)).sin()).collect();
        let other: Vec<f64> =
            (0..400).map(|row| if block_has(&whitening, row) { column[row] } else { 1e3 * row as f64 }).collect();
        assert_eq!(whitening.apply(&column), whitening.apply(&other));
        let background = Whitening::new(&[block(Vec::new())], red(), None);
        assert_eq!(whitening.dof(), background.dof() - 4.0 - 4.0 * LONG_RUN_ROWS as f64);
    }

    fn block_has(whitening: &Whitening, row: usize) -> bool {
        !whitening.blocks()[0].missing.contains(&row)
    }

    #[test]
    fn the_transpose_is_one_beside_a_long_run_of_missing_rows() {
        let whitening = Whitening::new(&[block((200..200 + LONG_RUN_ROWS).collect())], red(), None);
        let [a, b] = [0.3, 1.1].map(|hz| (0..400).map(|row| (hz * f64::from(row)).cos()).collect::<Vec<f64>>());
        let (there, back) = (dot(&whitening.apply(&a), &b), dot(&a, &whitening.transposed(&b, 400)));
        assert!((there - back).abs() < 1e-9 * there.abs(), "{there} {back}");
    }
}

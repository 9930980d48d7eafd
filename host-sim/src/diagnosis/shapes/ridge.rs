//! A group of columns with a common prior size: how likely it makes a residual, and how much of it it closes on blocks of time that
//! it was not fitted to. A large group does not win by its size: every direction that the prior allows costs evidence
//! (MacKay 1992, Bayesian interpolation).

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::diagnosis::evidence::folds::Part;
use crate::diagnosis::policy::HELD_OUT_FOLDS;
use crate::diagnosis::regression::products::{dot, gram_of};

/// Prior variances that are tried, over that of the residual: powers of ten, two a decade.
const PRIORS: std::ops::RangeInclusive<i32> = 0..=18;

/// Priors that are tried on parts held out, over the likeliest one.
const TIGHTER: [f64; 4] = [1.0, 0.1, 0.01, 0.001];

/// Products of some columns among each other and with a target, on some samples.
#[derive(Clone, Debug)]
pub(crate) struct Products {
    pub(crate) gram: DMatrix<f64>,
    pub(crate) q: DVector<f64>,
    /// Square of the target.
    pub(crate) zz: f64,
    /// Samples.
    pub(crate) n: f64,
}

impl Products {
    pub(crate) fn new(columns: &[Vec<f64>], target: &[f64]) -> Self {
        let slices: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let q = along(columns, target);
        Self { gram: gram_of(&slices), q, zz: dot(target, target), n: target.len() as f64 }
    }

    fn none(columns: usize) -> Self {
        Self { gram: DMatrix::zeros(columns, columns), q: DVector::zeros(columns), zz: 0.0, n: 0.0 }
    }

    fn add(&mut self, other: &Self, sign: f64) {
        self.gram += &other.gram * sign;
        self.q += &other.q * sign;
        self.zz += sign * other.zz;
        self.n += sign * other.n;
    }

    /// Those of some of the columns.
    pub(crate) fn of(&self, columns: &[usize]) -> Self {
        let m = columns.len();
        Self {
            gram: DMatrix::from_fn(m, m, |i, j| self.gram[(columns[i], columns[j])]),
            q: DVector::from_fn(m, |i, _| self.q[columns[i]]),
            ..*self
        }
    }
}

/// Products of each fold, and of all.
#[derive(Clone, Debug)]
pub(crate) struct Folded {
    pub(crate) folds: Vec<Products>,
    pub(crate) all: Products,
}

impl Folded {
    pub(crate) fn new(columns: &[Vec<f64>], z: &[f64], parts: &[Part]) -> Self {
        let of_fold = |fold: usize| {
            let cut = |column: &[f64]| -> Vec<f64> {
                let own = parts.iter().filter(|part| part.fold == fold);
                own.flat_map(|part| column[part.samples.clone()].iter().copied()).collect()
            };
            Products::new(&columns.iter().map(|column| cut(column)).collect::<Vec<_>>(), &cut(z))
        };
        let folds: Vec<Products> = (0..HELD_OUT_FOLDS).map(of_fold).collect();
        let mut all = Products::none(columns.len());
        folds.iter().for_each(|fold| all.add(fold, 1.0));
        Self { folds, all }
    }

    /// Those of some of the columns.
    pub(crate) fn of(&self, columns: &[usize]) -> Self {
        Self { folds: self.folds.iter().map(|fold| fold.of(columns)).collect(), all: self.all.of(columns) }
    }

    /// All but one fold.
    pub(crate) fn training(&self, fold: usize) -> Products {
        let mut training = self.all.clone();
        training.add(&self.folds[fold], -1.0);
        training
    }

    /// Reduction of the sum of squares on the folds that were held out, with a prior or the tighter one that does best: where parts differ
    /// in what happened in them, the likeliest prior of the whole is too loose for any of them.
    pub(crate) fn held_out(&self, prior: f64) -> (f64, f64) {
        let folds: Vec<Ridge> = (0..self.folds.len()).map(|fold| Ridge::of(&self.training(fold))).collect();
        let with = |tighter: &f64| -> (f64, f64) {
            let prior = prior * tighter;
            (prior, folds.iter().zip(&self.folds).map(|(ridge, own)| reduction(own, &ridge.weights(prior))).sum())
        };
        TIGHTER.iter().map(with).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((prior, 0.0))
    }
}

/// Products of columns with a target.
fn along(columns: &[Vec<f64>], target: &[f64]) -> DVector<f64> {
    DVector::from_iterator(columns.len(), columns.iter().map(|column| dot(column, target)))
}

/// Values turned round in time: one of so many ways that are evenly spread.
pub(crate) fn turned<T: Clone>(values: &[T], turn: usize, turns: usize) -> Vec<T> {
    let mut turned = values.to_vec();
    turned.rotate_left(values.len() * turn / (turns + 1));
    turned
}

/// How much less is left of some products' target with weights that others gave.
pub(crate) fn reduction(products: &Products, weights: &DVector<f64>) -> f64 {
    2.0 * weights.dot(&products.q) - weights.dot(&(&products.gram * weights))
}

/// The directions of a group of columns.
pub(crate) struct Ridge {
    values: Vec<f64>,
    vectors: DMatrix<f64>,
    along: DVector<f64>,
    zz: f64,
    n: f64,
}

impl Ridge {
    pub(crate) fn of(products: &Products) -> Self {
        let eigen = SymmetricEigen::new(products.gram.clone());
        let along = eigen.eigenvectors.transpose() * &products.q;
        let values = eigen.eigenvalues.iter().map(|value| value.max(0.0)).collect();
        Self { values, along, vectors: eigen.eigenvectors, zz: products.zz, n: products.n }
    }

    /// Likeliest weights with a prior variance, over that of the noise.
    pub(crate) fn weights(&self, prior: f64) -> DVector<f64> {
        let shrunk = self.along.iter().zip(&self.values).map(|(q, value)| q * prior / (1.0 + prior * value));
        &self.vectors * DVector::from_iterator(self.values.len(), shrunk)
    }

    /// The best prior, and the logarithm of how much likelier the target is with the group than without, the noise's size free.
    pub(crate) fn best(&self) -> (f64, f64) {
        self.best_of(&self.along, self.zz)
    }

    /// The same gain for the target turned round in time in so many ways, by the columns that this is of: what they say by chance.
    pub(crate) fn gains_of_turned(
        &self,
        columns: &[Vec<f64>],
        target: &[f64],
        turns: usize,
    ) -> impl Iterator<Item = f64> {
        let gain = move |turn: usize| {
            let q = along(columns, &turned(target, turn, turns));
            self.best_of(&(self.vectors.transpose() * q), self.zz).1
        };
        (1..=turns).map(gain)
    }

    fn best_of(&self, along: &DVector<f64>, zz: f64) -> (f64, f64) {
        let gain = |prior: f64| {
            let taken: f64 = along.iter().zip(&self.values).map(|(q, v)| q * q * prior / (1.0 + prior * v)).sum();
            let volume: f64 = self.values.iter().map(|v| (prior * v).ln_1p()).sum();
            -0.5 * volume - 0.5 * self.n * (1.0 - taken / zz.max(f64::MIN_POSITIVE)).max(1e-9).ln()
        };
        let most = self.values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let priors = PRIORS.map(|half_decades| 10_f64.powf(0.5 * f64::from(half_decades)) / most);
        priors.map(|prior| (prior, gain(prior))).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn normal(n: usize, seed: u64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        (0..n).map(|_| StandardNormal.sample(&mut random)).collect()
    }

    #[test]
    fn many_columns_of_noise_gain_nothing_and_the_right_one_among_them_does() {
        let columns: Vec<Vec<f64>> = (0..40).map(|k| normal(2000, k)).collect();
        let noise = normal(2000, 99);
        let parts = crate::diagnosis::evidence::folds::parts(std::slice::from_ref(&(0..2000)), 100);
        let alone = Folded::new(&columns, &noise, &parts);
        let (prior, gain) = Ridge::of(&alone.all).best();
        assert!(gain < 3.0, "{gain}");
        assert!(alone.held_out(prior).1 < 0.01 * alone.all.zz);
        let with: Vec<f64> = noise.iter().zip(&columns[7]).map(|(noise, x)| noise + x).collect();
        let found = Folded::new(&columns, &with, &parts);
        let (prior, gain) = Ridge::of(&found.all).best();
        let share = found.held_out(prior).1 / found.all.zz;
        assert!(gain > 400.0 && (share - 0.5).abs() < 0.05, "{gain} {share}");
    }
}

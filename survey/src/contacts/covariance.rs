//! The covariance in time that goes with a spectrum.

use std::sync::LazyLock;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use towmag_fourier::{Complex, Plan};

use super::levelled::RATE_HZ;

/// Length of the transform: its lags, 410 s either way, are longer than any window.
const LENGTH: usize = 8192;

static TRANSFORM: LazyLock<Plan> = LazyLock::new(|| towmag_fourier::forward(LENGTH));

/// Covariance of values a lag of cells apart, nT^2.
#[derive(Clone, Debug)]
pub(super) struct Covariance {
    lags: Vec<f64>,
}

impl Covariance {
    /// Of a one-sided density, nT^2/Hz. What is slower than the transform is a level, which every fit has for itself.
    pub(super) fn of(density: impl Fn(f64) -> f64) -> Self {
        let step_hz = RATE_HZ / LENGTH as f64;
        let half = |place: usize| 0.5 * density(place.min(LENGTH - place).max(1) as f64 * step_hz) * step_hz;
        let mut values: Vec<Complex<f64>> = (0..LENGTH).map(|k| Complex::new(half(k), 0.0)).collect();
        TRANSFORM.process(&mut values);
        Self { lags: values[..LENGTH / 2].iter().map(|c| c.re).collect() }
    }

    /// Of means over so many neighbouring cells, a lag of whole means apart.
    pub(super) fn of_means(&self, cells: usize) -> Self {
        let mean = |lag: usize| {
            let at = |off: i64| self.lags[((lag * cells) as i64 + off).unsigned_abs() as usize];
            let weighted = |off: i64| (cells as f64 - off.unsigned_abs() as f64) * at(off);
            (1 - cells as i64..cells as i64).map(weighted).sum::<f64>() / (cells * cells) as f64
        };
        Self { lags: (0..(self.lags.len() - cells) / cells).map(mean).collect() }
    }

    /// Between two values.
    pub(super) fn at(&self, lag: usize) -> f64 {
        self.lags[lag.min(self.lags.len() - 1)]
    }

    /// Factor of the covariance matrix of values at these places; `None` if it is not positive.
    pub(super) fn factor(&self, places: &[usize]) -> Option<Cholesky<f64, Dyn>> {
        self.matrix(places).cholesky()
    }

    /// The same of values that have these variances more, each of its own, nT^2.
    pub(super) fn factor_beside(&self, places: &[usize], own_nt2: &[f64]) -> Option<Cholesky<f64, Dyn>> {
        (self.matrix(places) + DMatrix::from_diagonal(&DVector::from_column_slice(own_nt2))).cholesky()
    }

    fn matrix(&self, places: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(places.len(), places.len(), |i, j| self.at(places[i].abs_diff(places[j])))
    }
}

/// Known means, and those that follow, of a continuation, s.
const KNOWN_S: usize = 90;

/// What is most likely to follow on a stretch (kriging with an unknown level), a value a second.
#[derive(Clone, Debug)]
pub(super) struct Continuation {
    covariance: Covariance,
    factor: Option<Cholesky<f64, Dyn>>,
}

impl Continuation {
    pub(super) fn of(density: impl Fn(f64) -> f64) -> Self {
        let covariance = Covariance::of(density).of_means(RATE_HZ as usize);
        Self { factor: covariance.factor(&(0..KNOWN_S).collect::<Vec<_>>()), covariance }
    }

    /// The cells after `values`; pass them in reverse for those before.
    pub(super) fn after(&self, values: impl DoubleEndedIterator<Item = f64>, cells: usize) -> Vec<f64> {
        let second = RATE_HZ as usize;
        let last: Vec<f64> = values.rev().take(KNOWN_S * second).collect();
        // Means over seconds, the last first.
        let means: Vec<f64> = last.chunks_exact(second).map(|c| c.iter().sum::<f64>() / second as f64).collect();
        let seconds = cells.div_ceil(second) + 1;
        let next = self.means_after(&means, seconds);
        let at = |cell: usize| {
            let place = (cell as f64 + 0.5) / second as f64 + 0.5;
            let (before, share) = (place as usize, place.fract());
            let mean = |k: usize| if k == 0 { means[0] } else { next[(k - 1).min(next.len() - 1)] };
            (1.0 - share) * mean(before) + share * mean(before + 1)
        };
        (0..cells).map(at).collect()
    }

    fn means_after(&self, means: &[f64], seconds: usize) -> Vec<f64> {
        let whole = self.factor.as_ref().filter(|_| means.len() == KNOWN_S);
        let shorter = || self.covariance.factor(&(0..means.len()).collect::<Vec<_>>());
        let Some(factor) = whole.cloned().or_else(shorter) else { return vec![means[0]; seconds] };
        let values = DVector::from_column_slice(means);
        let ones = DVector::from_element(means.len(), 1.0);
        let of_ones = factor.solve(&ones);
        let level = of_ones.dot(&values) / of_ones.dot(&ones);
        let weights = factor.solve(&values.map(|x| x - level));
        let next = |k: usize| (0..means.len()).map(|j| weights[j] * self.covariance.at(k + j + 1)).sum::<f64>();
        (0..seconds).map(|k| level + next(k)).collect()
    }
}

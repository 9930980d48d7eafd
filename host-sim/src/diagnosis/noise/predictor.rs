//! Linear predictors of the noise: what whitens a series from its first sample on.

use towmag_fourier::Complex;
use wide::f64x4;

use super::spectrum::NoiseSpectrum;
use crate::diagnosis::numerics::levinson_step;
use crate::diagnosis::policy::RATE_HZ;

/// Order of the predictor: 3.2 s of memory.
const ORDER: usize = 32;
/// Steps of an integral over all frequencies, Hz.
const STEPS: usize = 500;
const STEP_HZ: f64 = 0.5 * RATE_HZ / STEPS as f64;
/// Vectors of four samples that are whitened side by side, so that none of their sums waits for the one before.
const SIDE_BY_SIDE: usize = 6;
const LANES: usize = 4 * SIDE_BY_SIDE;

/// A linear predictor of one order.
#[derive(Clone, Debug)]
struct Order {
    /// Weights of the samples before, the latest first.
    weights: Vec<f64>,
    /// Standard deviation of the prediction error, nT.
    std: f64,
}

impl Order {
    /// Prediction error of the sample at `k` over its standard deviation. Products are summed from the latest sample back.
    fn error(&self, values: &[f64], k: usize) -> f64 {
        let predicted: f64 = self.weights.iter().zip(values[..k].iter().rev()).map(|(w, x)| w * x).sum();
        (values[k] - predicted) / self.std
    }

    /// The same of all samples from `start` on, at least as many before it as there are weights.
    ///
    /// [`LANES`] of them side by side in vector registers; each sum in its own order, so that its bits depend on no machine.
    fn errors(&self, values: &[f64], start: usize, out: &mut [f64]) {
        let (groups, rest) = out[start..].as_chunks_mut::<LANES>();
        let mut k = start;
        for group in groups {
            let mut predicted = [f64x4::ZERO; SIDE_BY_SIDE];
            for (i, weight) in self.weights.iter().enumerate() {
                let before = values[k - 1 - i..][..LANES].as_chunks().0;
                predicted.iter_mut().zip(before).for_each(|(sum, x)| *sum += *weight * f64x4::new(*x));
            }
            let samples = values[k..][..LANES].as_chunks().0.iter().zip(predicted);
            for (out, (value, predicted)) in group.as_chunks_mut().0.iter_mut().zip(samples) {
                *out = ((f64x4::new(*value) - predicted) / self.std).to_array();
            }
            k += LANES;
        }
        for (out, k) in rest.iter_mut().zip(k..) {
            *out = self.error(values, k);
        }
    }
}

/// Linear predictors of every order up to the last, so that a series is whitened from its first sample on.
#[derive(Clone, Debug)]
pub(crate) struct Predictor {
    /// Of order `k` at `k`; fewer than [`ORDER`] where a higher one would predict without error.
    orders: Vec<Order>,
}

impl Predictor {
    /// For white noise of a standard deviation, nT.
    pub(crate) fn white(std: f64) -> Self {
        Self { orders: vec![Order { weights: Vec::new(), std }] }
    }

    /// Standard deviation of what it predicts, nT.
    pub(crate) fn std(&self) -> f64 {
        self.orders[0].std
    }

    /// Standard deviation of what it predicts over that of its prediction error.
    pub(crate) fn gain(&self) -> f64 {
        self.std() / self.highest().std
    }

    /// Of noise with this spectrum.
    pub(crate) fn of(spectrum: &NoiseSpectrum) -> Self {
        Self::levinson(&spectrum.autocovariance())
    }

    /// From an autocovariance, nT^2, lag 0 first: the Levinson-Durbin recursion.
    pub(crate) fn levinson(autocovariance: &[f64]) -> Self {
        let highest = ORDER.min(autocovariance.len() - 1);
        let mut variance = autocovariance[0].max(f64::MIN_POSITIVE);
        let mut weights: Vec<f64> = Vec::new();
        let mut orders = vec![Order { weights: weights.clone(), std: variance.sqrt() }];
        for k in 1..=highest {
            let predicted: f64 = weights.iter().enumerate().map(|(i, w)| w * autocovariance[k - 1 - i]).sum();
            let reflection = (autocovariance[k] - predicted) / variance;
            if reflection.abs() >= 1.0 {
                break;
            }
            levinson_step(&mut weights, reflection);
            variance *= 1.0 - reflection * reflection;
            orders.push(Order { weights: weights.clone(), std: variance.sqrt() });
        }
        Self { orders }
    }

    fn highest(&self) -> &Order {
        &self.orders[self.orders.len() - 1]
    }

    /// Prediction errors of a series over their standard deviations. As long as it is 0 so are they: much is tried that begins late.
    pub(super) fn apply(&self, values: &[f64], out: &mut [f64]) {
        let first = values.iter().position(|value| *value != 0.0).unwrap_or(values.len());
        out[..first].fill(0.0);
        let start = (self.orders.len() - 1).min(values.len());
        for (k, out) in out.iter_mut().enumerate().take(start).skip(first) {
            *out = self.orders[k].error(values, k);
        }
        self.highest().errors(values, start.max(first), out);
    }

    /// The inverse of [`Self::apply`]: the series that has these prediction errors.
    pub(super) fn inverse(&self, errors: &[f64]) -> Vec<f64> {
        let last = self.orders.len() - 1;
        let mut values: Vec<f64> = Vec::with_capacity(errors.len());
        for (k, error) in errors.iter().enumerate() {
            let Order { weights, std } = &self.orders[k.min(last)];
            let predicted: f64 = weights.iter().zip(values.iter().rev()).map(|(w, x)| w * x).sum();
            values.push(predicted + error * std);
        }
        values
    }

    /// The transpose of [`Self::apply`].
    pub(super) fn apply_transposed(&self, values: &[f64], out: &mut [f64]) {
        let last = self.orders.len() - 1;
        out.fill(0.0);
        for k in 0..values.len() {
            let Order { weights, std } = &self.orders[k.min(last)];
            let value = values[k] / std;
            out[k] += value;
            for (i, w) in weights.iter().enumerate() {
                out[k - 1 - i] -= w * value;
            }
        }
    }

    /// Power gain of the whitening at a frequency of `cycles` per row: that of a sine after it over that before, 1/nT^2.
    pub(crate) fn response(&self, cycles: f64) -> f64 {
        let Order { weights, std } = self.highest();
        // Horner's scheme: one sine for all weights.
        let turn = Complex::cis(-std::f64::consts::TAU * cycles);
        let predicted = weights.iter().rev().fold(Complex::<f64>::ZERO, |sum, &weight| (sum + weight) * turn);
        (1.0 - predicted).norm_sqr() / (std * std)
    }

    /// Variance of noise of a spectrum after the whitening.
    pub(crate) fn whitened_variance(&self, spectrum: &NoiseSpectrum) -> f64 {
        let hz = |k: usize| (k as f64 + 0.5) * STEP_HZ;
        (0..STEPS).map(|k| spectrum.at(hz(k)) * self.response(hz(k) / RATE_HZ) * STEP_HZ).sum()
    }

    /// Squares of the impulse response of the whitening, by lag: times the variance of an addition to one row they are
    /// what it adds to the variance of that sample and the ones after it.
    pub(crate) fn squared_weights(&self) -> Vec<f64> {
        let Order { weights, std } = self.highest();
        std::iter::once(1.0).chain(weights.iter().map(|w| w * w)).map(|w| w / (std * std)).collect()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;

    #[test]
    fn the_recursion_solves_the_normal_equations() {
        let autocovariance: Vec<f64> = (0..6).map(|k| 0.9_f64.powi(k) + if k == 0 { 0.5 } else { 0.0 }).collect();
        let predictor = Predictor::levinson(&autocovariance);
        let Order { weights, std } = &predictor.orders[5];
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
        let back = predictor.inverse(&whiten(&unit(17)));
        assert!((0..n).all(|k| (back[k] - unit(17)[k]).abs() < 1e-12));
    }
}

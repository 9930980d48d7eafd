//! Heteroscedastic noise: by how much the variance of the samples grows where an effect adds random noise.

use super::whitening::Whitening;
use crate::diagnosis::numerics::{golden_section_minimum, median};
use crate::diagnosis::policy::SPIKE_SQUARES;

/// Starting values of `ln kappa` that are tried before the golden section, in steps about where the addition is as large as the noise: a
/// sensor of 5 pT that gives 50 nT where it is blind adds e^18 times its noise.
const LOG_KAPPA_STEPS: std::ops::RangeInclusive<i32> = -7..=21;
const LOG_KAPPA_STEP: f64 = 1.0;
/// Width of the last bracket of `ln kappa`.
const LOG_KAPPA_TOLERANCE: f64 = 1e-5;
/// Above this a product takes no further factor, which may be as large, lest it be no number.
const LARGE_PRODUCT: f64 = 1e150;
/// Step of `ln kappa` for the curvature.
const CURVATURE_STEP: f64 = 0.05;

/// How much the variance of each sample grows.
#[derive(Clone, Debug)]
pub(crate) struct VarianceFit {
    /// Variance of each sample over what it is without the effect.
    pub(crate) growth: Vec<f64>,
    /// Standard error of the logarithm of the added variance.
    pub(crate) log_error: f64,
}

impl VarianceFit {
    /// From the fit of an addition of variance `v`.
    pub(crate) fn new(v: &[f64], fit: &AddedVariance) -> Self {
        let log_error = if fit.curvature > 0.0 { 1.0 / fit.curvature.sqrt() } else { 1.0 };
        Self { growth: v.iter().map(|v| 1.0 + fit.kappa * v).collect(), log_error }
    }

    /// Logarithm of the growth of each sample.
    pub(crate) fn log_growth(&self) -> Vec<f64> {
        self.growth.iter().map(|growth| growth.ln()).collect()
    }

    /// Growth of the sample that it makes grow most, from 1 on.
    pub(crate) fn most(&self) -> f64 {
        self.growth.iter().copied().fold(1.0, f64::max)
    }
}

/// Variance `a (1 + kappa v)` in place of a constant, `a` and `kappa` at their likeliest.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AddedVariance {
    /// Twice the log likelihood ratio.
    pub(crate) glrt: f64,
    pub(crate) kappa: f64,
    /// Curvature of the log likelihood by `ln kappa`.
    curvature: f64,
}

/// Fit the variance of normal samples whose squares are given as `a (1 + kappa v)`, `v` one a sample, not negative. An
/// addition of 0 everywhere gains nothing.
pub(crate) fn fit_variance(squares: &[f64], v: &[f64]) -> AddedVariance {
    let n = squares.len() as f64;
    let mean_v = v.iter().sum::<f64>() / n;
    if mean_v <= 0.0 {
        return AddedVariance::default();
    }
    let pairs = || squares.iter().copied().zip(v.iter().copied());
    let deviance = |log_kappa: f64| deviance(n, 0.0, pairs(), log_kappa);
    let start = -mean_v.ln();
    let coarse = LOG_KAPPA_STEPS.map(|k| start + LOG_KAPPA_STEP * f64::from(k)).map(|at| (deviance(at), at));
    let (_, best) = coarse.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, start));
    let bracket = [best - LOG_KAPPA_STEP, best + LOG_KAPPA_STEP];
    let at = golden_section_minimum(deviance, bracket, LOG_KAPPA_TOLERANCE);
    let curvature = (deviance(at + CURVATURE_STEP) - 2.0 * deviance(at) + deviance(at - CURVATURE_STEP)) / 0.0025;
    let none = n * (squares.iter().sum::<f64>() / n).ln();
    AddedVariance { glrt: none - deviance(at), kappa: at.exp(), curvature: 0.5 * curvature }
}

/// Minus twice the log likelihood, up to a constant, of `n` normal samples of variance `a (1 + kappa v)`, `a` at its best.
///
/// `unaffected` is the sum of the squares of samples with `v = 0`; `affected` are square and `v` of the others, summed in
/// their order.
pub(crate) fn deviance(n: f64, unaffected: f64, affected: impl Iterator<Item = (f64, f64)>, log_kappa: f64) -> f64 {
    let kappa = log_kappa.exp();
    let (mut scaled, mut logs, mut product) = (unaffected, 0.0, 1.0);
    for (square, v) in affected {
        let growth = 1.0 + kappa * v;
        scaled += square / growth;
        // One logarithm for as many as a product holds.
        if product > LARGE_PRODUCT {
            logs += f64::ln(product);
            product = 1.0;
        }
        product *= growth;
    }
    n * (scaled / n).ln() + logs + product.ln()
}

/// Variance of the whitened samples for independent additions of variance `row_variance`, nT^2, one a row of the
/// recording; one a sample. Whitening spreads each addition over the samples after it: the squared weights, by lag.
pub(crate) fn innovation_variance(whitening: &Whitening, row_variance: &[f64]) -> Vec<f64> {
    let by_lag = whitening.predictor().squared_weights();
    let weights = whitening.weights();
    let mut out = vec![0.0; weights.len()];
    for (block, range) in whitening.blocks().iter().zip(whitening.ranges()) {
        let out = &mut out[range.clone()];
        for part in block.parts() {
            let (out, of_part) = (&mut out[part.clone()], &row_variance[block.rows.start..][part]);
            for (k, &variance) in of_part.iter().enumerate().filter(|(_, variance)| **variance > 0.0) {
                out[k..].iter_mut().zip(&by_lag).for_each(|(sum, weight)| *sum += weight * variance);
            }
        }
        out.iter_mut().zip(&weights[range]).for_each(|(sum, weight)| *sum *= weight * weight);
    }
    out
}

/// Squares of a whitened residual, none larger than a spike may count; more where the variance is known to have grown.
pub(crate) fn squares(residual_whitened: &[f64], growth: Option<&[f64]>) -> Vec<f64> {
    let largest = SPIKE_SQUARES * median(residual_whitened.iter().map(|z| z * z).collect());
    let growth = |k: usize| growth.map_or(1.0, |growth| growth[k]);
    residual_whitened.iter().enumerate().map(|(k, z)| (z * z).min(largest * growth(k))).collect()
}

/// The common factor `a` of variances `a (1 + kappa v)` at its likeliest.
pub(crate) fn scale(squares: &[f64], v: &[f64], kappa: f64) -> f64 {
    squares.iter().zip(v).map(|(square, v)| square / (1.0 + kappa * v)).sum::<f64>() / squares.len() as f64
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    #[test]
    fn the_fit_finds_the_variance_that_was_added_and_its_error() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        let v: Vec<f64> = (0..20_000).map(|k| if k % 4 == 0 { 2.0 } else { 0.0 }).collect();
        let mut draw = |v: &f64| -> f64 {
            (0.5 * (1.0 + 3.0 * v)).sqrt() * Distribution::<f64>::sample(&StandardNormal, &mut random)
        };
        let squares: Vec<f64> = v.iter().map(|v| draw(v).powi(2)).collect();
        let fit = fit_variance(&squares, &v);
        assert!((fit.kappa - 3.0).abs() < 0.2, "{}", fit.kappa);
        assert!((scale(&squares, &v, fit.kappa) - 0.5).abs() < 0.02);
        // The variance of n squares has a relative error of root 2/n; its addition is 6 of 7 parts.
        let expected = (2.0 / 5000.0_f64 + 2.0 / 15_000.0).sqrt() * 7.0 / 6.0;
        let found = VarianceFit::new(&v, &fit).log_error;
        assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
        assert_eq!(fit_variance(&squares, &vec![0.0; v.len()]).glrt, 0.0);
    }

    #[test]
    fn an_addition_thousands_of_times_as_large_as_the_noise_is_told() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        let v: Vec<f64> = (0..5000).map(|k| if k % 7 == 0 { 1.0 } else { 0.0 }).collect();
        let mut draw =
            |v: &f64| -> f64 { (1.0 + 4e7 * v).sqrt() * Distribution::<f64>::sample(&StandardNormal, &mut random) };
        let squares: Vec<f64> = v.iter().map(|v| draw(v).powi(2)).collect();
        let fit = fit_variance(&squares, &v);
        assert!((fit.kappa / 4e7 - 1.0).abs() < 0.15, "{}", fit.kappa);
    }
}

//! Variance that grows: how much of it there is, and what whitening makes of it.

use super::whitening::Whitening;

/// Squares count no more than this, in units of their median: one spike is no variance.
const LARGEST_SQUARE: f64 = 300.0;

/// How much the variance of each sample grows.
#[derive(Clone, Debug)]
pub(crate) struct VarianceFit {
    /// Variance of each sample over what it is without the effect.
    pub(crate) growth: Vec<f64>,
    /// Standard error of the logarithm of the added variance.
    pub(crate) log_error: f64,
}

impl VarianceFit {
    /// From what [`fit_variance`] found of `v`.
    pub(crate) fn new(v: &[f64], kappa: f64, curvature: f64) -> Self {
        let log_error = if curvature > 0.0 { 1.0 / curvature.sqrt() } else { 1.0 };
        Self { growth: v.iter().map(|v| 1.0 + kappa * v).collect(), log_error }
    }

    /// Growth of the sample that it makes grow most, from 1 on.
    pub(crate) fn most(&self) -> f64 {
        self.growth.iter().copied().fold(1.0, f64::max)
    }
}

/// Twice the gain in log likelihood when the variance of `squares` is `a (1 + kappa v)` instead of `a`, `kappa`, and
/// the curvature by `ln kappa` there.
pub(crate) fn fit_variance(squares: &[f64], v: &[f64]) -> (f64, f64, f64) {
    let n = squares.len() as f64;
    let mean_v = v.iter().sum::<f64>() / n;
    let deviance = |log_kappa: f64| {
        let kappa = log_kappa.exp();
        let (mut scaled, mut logs) = (0.0, 0.0);
        for (square, v) in squares.iter().zip(v) {
            let growth = 1.0 + kappa * v;
            scaled += square / growth;
            logs += growth.ln();
        }
        n * (scaled / n).ln() + logs
    };
    let none = n * (squares.iter().sum::<f64>() / n).ln();
    if mean_v <= 0.0 {
        return (0.0, 0.0, 0.0);
    }
    let start = -mean_v.ln();
    let grid = (-14..=16).map(|k| start + 0.5 * f64::from(k));
    let best = grid.min_by(|a, b| deviance(*a).total_cmp(&deviance(*b))).unwrap_or(start);
    let (mut low, mut high) = (best - 0.5, best + 0.5);
    for _ in 0..24 {
        let (a, b) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
        if deviance(a) < deviance(b) { high = b } else { low = a }
    }
    let at = 0.5 * (low + high);
    let curvature = (deviance(at + 0.05) - 2.0 * deviance(at) + deviance(at - 0.05)) / 0.0025;
    (none - deviance(at), at.exp(), 0.5 * curvature)
}

/// Variance of whitened samples for a white addition of variance `row_variance`, one a row.
pub(crate) fn innovation_variance(whitening: &Whitening, row_variance: &[f64]) -> Vec<f64> {
    let by_lag = whitening.predictor().squared_weights();
    let weights = whitening.weights();
    let mut out = vec![0.0; weights.len()];
    for (block, range) in whitening.blocks().iter().zip(whitening.ranges()) {
        let out = &mut out[range.clone()];
        for (k, &variance) in
            row_variance[block.rows.clone()].iter().enumerate().filter(|(_, variance)| **variance > 0.0)
        {
            out[k..].iter_mut().zip(&by_lag).for_each(|(sum, weight)| *sum += weight * variance);
        }
        out.iter_mut().zip(&weights[range]).for_each(|(sum, weight)| *sum *= weight * weight);
    }
    out
}

/// Squares of what is left, none larger than one spike may count; more where the variance is known to have grown.
pub(crate) fn squares(rest: &[f64], growth: Option<&[f64]>) -> Vec<f64> {
    let mut all: Vec<f64> = rest.iter().map(|z| z * z).collect();
    let middle = all.len() / 2;
    let (_, median, _) = all.select_nth_unstable_by(middle, f64::total_cmp);
    let largest = LARGEST_SQUARE * *median;
    let grown = |k: usize| growth.map_or(1.0, |growth| growth[k]);
    rest.iter().enumerate().map(|(k, z)| (z * z).min(largest * grown(k))).collect()
}

/// The common factor of the variances at their best.
pub(crate) fn scale(squares: &[f64], v: &[f64], kappa: f64) -> f64 {
    squares.iter().zip(v).map(|(square, v)| square / (1.0 + kappa * v)).sum::<f64>() / squares.len() as f64
}

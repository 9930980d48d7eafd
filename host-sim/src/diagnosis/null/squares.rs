//! The squares of a residual: how loud it is at each sample.

/// Squares count no more than this: a few large ones have all frequencies, and are another test's.
const LARGEST_SQUARE: f64 = 16.0;

/// Squares of a residual of variance 1, less their mean.
pub(super) struct Squares {
    pub(super) mean: f64,
    /// A value a sample.
    pub(super) centred: Vec<f64>,
    /// Mean square of those.
    pub(super) spread: f64,
}

impl Squares {
    pub(super) fn of(z: &[f64]) -> Self {
        let (mean, centred) = centred(z.iter().map(|z| (z * z).min(LARGEST_SQUARE)).collect());
        let spread = centred.iter().map(|x| x * x).sum::<f64>() / z.len().max(1) as f64;
        Self { mean, centred, spread }
    }
}

/// The mean of some values, and the values less it.
pub(super) fn centred(values: Vec<f64>) -> (f64, Vec<f64>) {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    (mean, values.into_iter().map(|value| value - mean).collect())
}

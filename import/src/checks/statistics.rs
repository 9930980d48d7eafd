//! Which rows may be used, and what they are on the whole.

use crate::draft::Draft;

/// Rows whose scalar and fluxgate may be used.
pub(super) fn usable(draft: &Draft, scalar: &[f64], flux: &[&[f64]; 3]) -> Vec<usize> {
    (0..draft.len())
        .filter(|&row| !draft.invalid[row] && scalar[row].is_finite() && flux.iter().all(|axis| axis[row].is_finite()))
        .collect()
}

/// Mean and standard deviation.
pub(super) fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / count;
    let variance = values.map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    (mean, variance.sqrt())
}

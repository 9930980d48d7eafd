//! Medians: what is usual, whatever a few values do.

/// The median of the values that are finite.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.retain(|value| value.is_finite());
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The median of the steps forward.
pub(crate) fn median_step(values: &[f64]) -> Option<f64> {
    median(values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect())
}

//! What several parts count alike.

/// The median, the upper one of an even number; `None` of nothing. The values lose their order.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Weights of a normal bell, by how many steps they are off its middle, to three spreads. The spread is in steps.
pub(crate) fn bell(spread: f64) -> Vec<f64> {
    (0..=(3.0 * spread).ceil() as usize).map(|off| (-0.5 * (off as f64 / spread).powi(2)).exp()).collect()
}

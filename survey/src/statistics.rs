//! What several parts count alike.

/// From the median of the size of a normal deviate to its standard deviation.
pub(crate) const NORMAL_MEDIAN: f64 = 0.674_489_750_196_081_7;

/// The median, the upper one of an even number; `None` of nothing. The values lose their order.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Sums over what is about each value, weighted by a normal bell to three spreads of it. The spread is in values.
pub(crate) fn bell_sums<const N: usize>(values: &[[f64; N]], spread: f64) -> impl Iterator<Item = [f64; N]> {
    let reach = (3.0 * spread).ceil() as usize;
    let bell: Vec<f64> = (0..=reach).map(|off| (-0.5 * (off as f64 / spread).powi(2)).exp()).collect();
    (0..values.len()).map(move |place| {
        let near = place.saturating_sub(reach)..(place + reach + 1).min(values.len());
        near.fold([0.0; N], |sums, k| std::array::from_fn(|n| sums[n] + bell[k.abs_diff(place)] * values[k][n]))
    })
}

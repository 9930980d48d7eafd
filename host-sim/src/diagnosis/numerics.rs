//! Small numerical tools that several stages share.

use super::regression::products::dot;

/// Median of chi-squared with one degree of freedom.
const MEDIAN_OF_CHI_SQUARED_1: f64 = 0.454_936;

/// The median of at least one value; of an even number of them the upper one of the two in the middle.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Mean square of normal values of mean 0, from the median of their squares: a minority of large ones does not move it.
/// 0 of none.
pub(crate) fn robust_mean_square(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    median(values.iter().map(|x| x * x).collect()) / MEDIAN_OF_CHI_SQUARED_1
}

/// Root of the mean square; 0 of none.
pub(crate) fn rms(values: &[f64]) -> f64 {
    (dot(values, values) / values.len().max(1) as f64).sqrt()
}

/// Rms deviation of some values from their mean, over it.
pub(crate) fn coefficient_of_variation(values: &[f64]) -> f64 {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|value| (value / mean - 1.0).powi(2)).sum::<f64>() / count).sqrt()
}

/// Sums of the first 0, 1, ... n values, added in order: `n + 1` of them, so that the sum over `a..b` is `[b] - [a]`.
pub(crate) fn cumulative_sums(values: impl ExactSizeIterator<Item = f64>) -> Vec<f64> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut sum = 0.0;
    sums.push(sum);
    for value in values {
        sum += value;
        sums.push(sum);
    }
    sums
}

/// First-order low-pass, started in its steady state; `keep` of the state stays from one value to the next.
pub(crate) fn low_pass(values: impl Iterator<Item = f64>, keep: f64) -> Vec<f64> {
    let mut state = None;
    let passed = values.map(|value| {
        let next = keep * state.unwrap_or(value) + (1.0 - keep) * value;
        state = Some(next);
        next
    });
    passed.collect()
}

/// Lagrange's polynomial: 1 at one of the nodes, 0 at the others.
pub(crate) fn lagrange(nodes: &[f64], of: usize, at: f64) -> f64 {
    (0..nodes.len()).filter(|&k| k != of).map(|k| (at - nodes[k]) / (nodes[of] - nodes[k])).product()
}

/// Where a function with one minimum between `low` and `high` has it, to half of `tolerance`: golden-section search.
pub(crate) fn golden_section_minimum(of: impl Fn(f64) -> f64, [low, high]: [f64; 2], tolerance: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    while high - low > tolerance {
        let (a, b) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
        if of(a) < of(b) { high = b } else { low = a }
    }
    0.5 * (low + high)
}

/// From the weights of a linear predictor, the latest sample first, and the next reflection coefficient, the weights of
/// the predictor of one order more.
pub(crate) fn levinson_step(weights: &mut Vec<f64>, reflection: f64) {
    let last = weights.clone();
    for (weight, mirrored) in weights.iter_mut().zip(last.iter().rev()) {
        *weight -= reflection * mirrored;
    }
    weights.push(reflection);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_value_in_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 3.0, 2.0]), 3.0);
    }

    #[test]
    fn outliers_do_not_move_the_robust_mean_square() {
        // Quantiles of a standard normal, 0.01 apart.
        let normal = |k: usize| statrs::function::erf::erf_inv(2.0 * (k as f64 + 0.5) / 1000.0 - 1.0) * 2_f64.sqrt();
        let mut values: Vec<f64> = (0..1000).map(normal).collect();
        assert!((robust_mean_square(&values) - 1.0).abs() < 0.01);
        values[..20].fill(1e6);
        assert!((robust_mean_square(&values) - 1.0).abs() < 0.05);
    }

    #[test]
    fn cumulative_sums_begin_with_nothing() {
        assert_eq!(cumulative_sums([1.0, 2.0, 4.0].into_iter()), [0.0, 1.0, 3.0, 7.0]);
    }

    #[test]
    fn the_golden_section_finds_the_minimum_within_its_tolerance() {
        let found = golden_section_minimum(|x| (x - 0.3).powi(2), [-1.0, 4.0], 1e-3);
        assert!((found - 0.3).abs() <= 0.5e-3, "{found}");
    }
}

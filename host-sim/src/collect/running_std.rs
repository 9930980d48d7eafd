//! Mean and standard deviation in one pass (Welford 1962): no loss of digits however large the mean is.

/// Running population standard deviation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunningStd {
    count: u64,
    mean: f64,
    sum_of_squares: f64,
}

impl RunningStd {
    /// Take in one value.
    pub fn push(&mut self, value: f64) {
        self.count += 1;
        let before = value - self.mean;
        self.mean += before / self.count as f64;
        self.sum_of_squares += before * (value - self.mean);
    }

    /// Number of values.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; zero when there are none.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Their population standard deviation; NaN when there are none.
    pub fn std(&self) -> f64 {
        (self.sum_of_squares / self.count as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_two_passes_on_a_large_mean() {
        let values: Vec<f64> = (0..10_000).map(|i| 50_000.0 + (f64::from(i) * 0.7).sin() * 1e-3).collect();
        let mut running = RunningStd::default();
        values.iter().for_each(|&value| running.push(value));
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        assert!((running.mean() - mean).abs() < 1e-9);
        assert!((running.std() / variance.sqrt() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn one_value_has_no_spread_and_none_has_no_answer() {
        let mut running = RunningStd::default();
        assert!(running.std().is_nan());
        running.push(3.0);
        assert_eq!((running.std(), running.mean(), running.count()), (0.0, 3.0, 1));
    }
}

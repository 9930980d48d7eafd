//! The mean of a column over a window in time.

/// The mean over the values within `half_s` before and after each row; NaN counts as no value, in either column. Cumulative
/// sums: `time_s` does not fall.
pub(crate) fn moving_mean(time_s: &[f64], values: &[f64], half_s: f64) -> Vec<f64> {
    let rows: Vec<usize> =
        (0..time_s.len()).filter(|&row| time_s[row].is_finite() && values[row].is_finite()).collect();
    let mut means = vec![f64::NAN; time_s.len()];
    // About their first value: sums of eastings would lose digits.
    let centre = rows.first().map_or(0.0, |&row| values[row]);
    let (mut sum, mut first, mut end) = (0.0, 0, 0);
    for (row, mean) in means.iter_mut().enumerate().filter(|(row, _)| time_s[*row].is_finite()) {
        while end < rows.len() && time_s[rows[end]] <= time_s[row] + half_s {
            sum += values[rows[end]] - centre;
            end += 1;
        }
        while first < end && time_s[rows[first]] < time_s[row] - half_s {
            sum -= values[rows[first]] - centre;
            first += 1;
        }
        if end > first {
            *mean = centre + sum / (end - first) as f64;
        }
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_mean_of_what_is_there() {
        let time_s: Vec<f64> = (0..10).map(f64::from).collect();
        let mut values: Vec<f64> = time_s.iter().map(|t| 1e6 + t * t).collect();
        values[5] = f64::NAN;
        let means = moving_mean(&time_s, &values, 1.0);
        assert_eq!((means[0], means[3]), (1e6 + 0.5, 1e6 + (4.0 + 9.0 + 16.0) / 3.0));
        assert_eq!((means[5], means[9]), (1e6 + (16.0 + 36.0) / 2.0, 1e6 + (64.0 + 81.0) / 2.0));
        assert!(moving_mean(&[0.0, f64::NAN], &[f64::NAN, 1.0], 1.0).iter().all(|mean| mean.is_nan()));
    }
}

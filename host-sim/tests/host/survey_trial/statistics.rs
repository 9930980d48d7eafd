//! What the tables are made of.

/// A share with its Wilson interval of 95 %.
pub(crate) fn share(hits: usize, of: usize) -> [f64; 3] {
    if of == 0 {
        return [f64::NAN; 3];
    }
    // 97.5 % of the normal distribution.
    let (n, p, z) = (of as f64, hits as f64 / of as f64, 1.959_963_985);
    let scale = 1.0 / (1.0 + z * z / n);
    let (centre, half) = (p + z * z / (2.0 * n), z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt());
    [p, scale * (centre - half), scale * (centre + half)]
}

/// An hourly rate with the exact interval of 95 % of a Poisson count (Garwood 1936).
pub(crate) fn rate(count: usize, hours: f64) -> [f64; 3] {
    use statrs::distribution::{ContinuousCDF, Gamma};
    let quantile = |shape: f64, p: f64| Gamma::new(shape, 1.0).unwrap().inverse_cdf(p);
    let low = if count == 0 { 0.0 } else { quantile(count as f64, 0.025) };
    [count as f64 / hours, low / hours, quantile(count as f64 + 1.0, 0.975) / hours]
}

/// The value below which a share of the values lies; not a number if there is none.
pub(crate) fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    if values.is_empty() {
        return f64::NAN;
    }
    values[(share * (values.len() - 1) as f64).round() as usize]
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard deviation, of the population.
pub(crate) fn std(values: &[f64]) -> f64 {
    let mean = mean(values);
    (values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn the_intervals_are_the_published_ones() {
    // Newcombe 1998, table 1: 81 of 263, 0.2553 to 0.3662; Garwood: 3 events, 0.6187 to 8.7673.
    let [_, low, high] = share(81, 263);
    assert!((low - 0.2553).abs() < 1e-4 && (high - 0.3662).abs() < 1e-4, "{low} {high}");
    let [_, low, high] = rate(3, 1.0);
    assert!((low - 0.6187).abs() < 1e-3 && (high - 8.7673).abs() < 1e-3, "{low} {high}");
    assert_eq!(quantile(vec![3.0, 1.0, 2.0], 0.5), 2.0);
}

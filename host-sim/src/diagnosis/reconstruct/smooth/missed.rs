//! Motion that the smoothed series misses: where reading and smoothed value disagree by far more than noise, the reading
//! is taken.

use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::policy::READING_TRUSTED_RATIOS;

/// Rows on either side over which the disagreement is judged.
const BESIDE: usize = 3;

/// What is to be added to a smoothed series, `factor` times as dense: `residual`, readings less smoothed values at 10 Hz,
/// times the trust in the reading.
pub(crate) fn motion(residual: &[f64], factor: usize) -> Vec<f64> {
    let count = (residual.len() - 1) * factor + 1;
    let Some(trust) = trust(residual) else { return vec![0.0; count] };
    let missed: Vec<f64> = trust.iter().zip(residual).map(|(trust, residual)| trust * residual).collect();
    let at = |k: isize| missed[k.clamp(0, missed.len() as isize - 1) as usize];
    let value = |k: usize| {
        let (row, part) = ((k / factor) as isize, (k % factor) as f64 / factor as f64);
        catmull_rom([at(row - 1), at(row), at(row + 1), at(row + 2)], part)
    };
    (0..count).map(value).collect()
}

/// How far each reading is trusted over its smoothed value, from 0 to 1: by the mean square of the residual near it, over
/// that of noise. `None` where no reading is.
fn trust(residual: &[f64]) -> Option<Vec<f64>> {
    let noise = robust_mean_square(residual);
    let power = mean_beside(&residual.iter().map(|x| x * x).collect::<Vec<_>>());
    let [none, full] = READING_TRUSTED_RATIOS;
    let trust: Vec<f64> = power.iter().map(|power| ((power / noise - none) / (full - none)).clamp(0.0, 1.0)).collect();
    (noise > 0.0 && trust.iter().any(|&trust| trust != 0.0)).then(|| mean_beside(&trust))
}

/// Catmull and Rom's cubic between `b` and `c`, the `part` of the way: through the rows, without a kink at them.
fn catmull_rom([a, b, c, d]: [f64; 4], part: f64) -> f64 {
    let curve = (2.0 * a - 5.0 * b + 4.0 * c - d) + part * (3.0 * (b - c) + d - a);
    b + 0.5 * part * ((c - a) + part * curve)
}

/// Moving average over [`BESIDE`] rows on either side, fewer at the ends.
fn mean_beside(values: &[f64]) -> Vec<f64> {
    let near = |k: usize| &values[k.saturating_sub(BESIDE)..(k + BESIDE + 1).min(values.len())];
    (0..values.len()).map(|k| near(k).iter().sum::<f64>() / near(k).len() as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_stays_out_and_what_is_far_off_is_followed() {
        let noise = |k: usize| if (k * 7) % 13 < 6 { 1.0 } else { -0.8 };
        let residual: Vec<f64> = (0..400).map(noise).collect();
        assert!(motion(&residual, 5).iter().all(|&x| x == 0.0));
        let end = |k: usize| 300.0 * (-((399 - k) as f64) / 8.0).exp() * (0.9 * k as f64).sin();
        let with: Vec<f64> = (0..400).map(|k| noise(k) + end(k)).collect();
        let found = motion(&with, 5);
        assert!((380..400).all(|k| (found[5 * k] - end(k)).abs() < 2.0));
        assert!(found[..1500].iter().all(|&x| x == 0.0));
    }
}

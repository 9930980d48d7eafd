//! What a smooth series misses: where it is off by far more than noise, the reading itself is taken.

use crate::diagnosis::regression::projection::mean_square_of_most;

/// Rows on either side over which the disagreement is judged.
const BESIDE: usize = 3;
/// Mean square of the disagreement, of that of noise, below which the smooth value stays, and above which the reading
/// counts alone.
const NOISE: [f64; 2] = [4.0, 9.0];

/// What of `left`, readings less smooth values at 10 Hz, is to be added, `factor` times as dense.
pub(crate) fn motion(left: &[f64], factor: usize) -> Vec<f64> {
    let count = (left.len() - 1) * factor + 1;
    let noise = mean_square_of_most(left);
    let power = mean_beside(&left.iter().map(|x| x * x).collect::<Vec<_>>());
    let trust = |power: &f64| ((power / noise - NOISE[0]) / (NOISE[1] - NOISE[0])).clamp(0.0, 1.0);
    let trust: Vec<f64> = power.iter().map(trust).collect();
    if noise <= 0.0 || trust.iter().all(|&trust| trust == 0.0) {
        return vec![0.0; count];
    }
    let more: Vec<f64> = mean_beside(&trust).iter().zip(left).map(|(trust, left)| trust * left).collect();
    let at = |k: isize| more[k.clamp(0, more.len() as isize - 1) as usize];
    (0..count)
        .map(|k| {
            let (row, part) = ((k / factor) as isize, (k % factor) as f64 / factor as f64);
            // Catmull and Rom's cubic: through the rows, without a kink at them.
            let [a, b, c, d] = [at(row - 1), at(row), at(row + 1), at(row + 2)];
            let curve = (2.0 * a - 5.0 * b + 4.0 * c - d) + part * (3.0 * (b - c) + d - a);
            b + 0.5 * part * ((c - a) + part * curve)
        })
        .collect()
}

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
        let left: Vec<f64> = (0..400).map(noise).collect();
        assert!(motion(&left, 5).iter().all(|&x| x == 0.0));
        let end = |k: usize| 300.0 * (-((399 - k) as f64) / 8.0).exp() * (0.9 * k as f64).sin();
        let with: Vec<f64> = (0..400).map(|k| noise(k) + end(k)).collect();
        let found = motion(&with, 5);
        assert!((380..400).all(|k| (found[5 * k] - end(k)).abs() < 2.0));
        assert!(found[..1500].iter().all(|&x| x == 0.0));
    }
}

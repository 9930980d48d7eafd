//! What the sizes of the values say: jumps now and then, or a reading that hops between few levels.

use super::doubt::Doubt;
use super::finding::Finding;
use crate::diagnosis::numerics::coefficient_of_variation;
use crate::diagnosis::policy::{IMPULSES_DOUBT, LARGE_SAMPLE_SQUARES};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::search::log_tail;
use crate::effects::Channel;

/// More large samples than normal noise has: what switches or knocks leaves them, however its spectrum looks.
pub(super) fn impulses(z: &[f64], doubt: &Doubt) -> Finding {
    let n = z.len() as f64;
    let (kurtosis, mean_square) = kurtosis(z);
    // Normal noise whose variance differs between samples by so much more than was thought has a larger kurtosis.
    let variances: Vec<f64> = doubt.of_samples(IMPULSES_DOUBT).map(|doubt| 1.0 + doubt).collect();
    let allowed = 1.0 + coefficient_of_variation(&variances).powi(2);
    let score = if kurtosis > 3.0 * allowed { kurtosis_score(kurtosis / allowed, n) } else { 0.0 };
    let excess = z.iter().map(|z| (z * z / mean_square - LARGE_SAMPLE_SQUARES[0]).max(0.0)).sum();
    Finding { what: "impulses", log_p: log_tail(1.0, score * score), excess }
}

/// Fewer small and large samples than normal noise has: what hops between few levels faster than a few rows. A fluxgate that is read in
/// coarse steps does too, which is known.
pub(super) fn levels(channel: Channel, z: &[f64]) -> Finding {
    let (kurtosis, _) = kurtosis(z);
    let score =
        if channel == Channel::Scalar && kurtosis < 3.0 { kurtosis_score(kurtosis, z.len() as f64) } else { 0.0 };
    // Of normal noise and values of one size, either sign, together: -2 times the square of the latter's share of the power.
    let share = (0.5 * (3.0 - kurtosis)).clamp(0.0, 1.0).sqrt();
    Finding { what: "levels", log_p: log_tail(1.0, score * score), excess: share * z.len() as f64 }
}

/// With it, the mean square.
fn kurtosis(z: &[f64]) -> (f64, f64) {
    let n = z.len() as f64;
    let mean_square = dot(z, z) / n;
    (z.iter().map(|z| z.powi(4)).sum::<f64>() / n / (mean_square * mean_square), mean_square)
}

/// Standard normal, as near as can be, for the kurtosis of `n` normal samples (Anscombe and Glynn, Biometrika 70, 1983,
/// p. 227).
fn kurtosis_score(kurtosis: f64, n: f64) -> f64 {
    let mean = 3.0 * (n - 1.0) / (n + 1.0);
    let variance = 24.0 * n * (n - 2.0) * (n - 3.0) / ((n + 1.0).powi(2) * (n + 3.0) * (n + 5.0));
    let x = (kurtosis - mean) / variance.sqrt();
    let skewness = 6.0 * (n * n - 5.0 * n + 2.0) / ((n + 7.0) * (n + 9.0))
        * (6.0 * (n + 3.0) * (n + 5.0) / (n * (n - 2.0) * (n - 3.0))).sqrt();
    let a = 6.0 + 8.0 / skewness * (2.0 / skewness + (1.0 + 4.0 / (skewness * skewness)).sqrt());
    let root = ((1.0 - 2.0 / a) / (1.0 + x * (2.0 / (a - 4.0)).sqrt())).cbrt();
    (1.0 - 2.0 / (9.0 * a) - root) / (2.0 / (9.0 * a)).sqrt()
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    #[test]
    fn the_score_of_a_kurtosis_is_the_published_one() {
        // SciPy's kurtosistest, which is the same transformation.
        for (kurtosis, n, score) in [(3.0, 6000.0, 0.047285), (3.4, 6000.0, 5.356133), (2.8, 1000.0, -1.333778)] {
            assert!((kurtosis_score(kurtosis, n) - score).abs() < 1e-4, "{kurtosis}: {}", kurtosis_score(kurtosis, n));
        }
    }

    #[test]
    fn a_current_that_switches_now_and_then_leaves_impulses_and_noise_leaves_none() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let mut z: Vec<f64> = (0..6000).map(|_| StandardNormal.sample(&mut random)).collect();
        let nowhere = Doubt::where_it(|_| false, z.len(), 4.0);
        let every_seventh = Doubt::where_it(|k| k.is_multiple_of(7), z.len(), 4.0);
        assert!(impulses(&z, &nowhere).log_p > -5.0);
        let mut louder = z.clone();
        louder.iter_mut().step_by(7).for_each(|z| *z *= 1.6);
        assert!(impulses(&louder, &nowhere).log_p < -20.0);
        // Where the direction's noise may be misjudged by as much, that proves nothing.
        assert!(impulses(&louder, &every_seventh).log_p > -5.0);
        z.iter_mut().step_by(60).for_each(|z| *z += 4.0);
        assert!(impulses(&z, &nowhere).log_p < -20.0);
    }

    #[test]
    fn a_reading_that_hops_shows_its_levels_and_noise_has_none() {
        for seed in 0..8 {
            let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
            let mut z: Vec<f64> = (0..2400).map(|_| StandardNormal.sample(&mut random)).collect();
            assert!(levels(Channel::Scalar, &z).log_p > -9.0, "{seed}: {}", levels(Channel::Scalar, &z).log_p);
            z.iter_mut().enumerate().for_each(|(k, z)| *z += if k % 7 < 3 { 1.5 } else { -1.5 });
            assert!(levels(Channel::Scalar, &z).log_p < -20.0, "{seed}: {}", levels(Channel::Scalar, &z).log_p);
        }
    }
}

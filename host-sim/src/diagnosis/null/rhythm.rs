//! Whether the noise is louder in a rhythm: in every third row, or whenever something turns.

use super::finding::Finding;
use super::periodogram::powers;
use super::squares::Squares;
use crate::diagnosis::policy::{RATE_HZ, RHYTHM_LOWEST_HZ};
use crate::diagnosis::search::log_tail;

/// A line in the spectrum of the squares of a residual `z` of variance 1, whose variance the noise model may have wrong by `allowed`, as
/// a share of it.
pub(super) fn rhythm(z: &[f64], allowed: f64) -> Finding {
    let n = z.len() as f64;
    let Squares { mean, centred, spread } = Squares::of(z);
    let first = (RHYTHM_LOWEST_HZ / RATE_HZ * n) as usize;
    let powers = powers(&centred);
    let of_rhythm = powers.get(first..).unwrap_or(&[]);
    let largest = of_rhythm.iter().copied().fold(0.0, f64::max) / spread.max(f64::MIN_POSITIVE);
    // A variance that is off by so much at one frequency has a line of its own.
    let by_model = n * (allowed * mean).powi(2) / (4.0 * spread.max(f64::MIN_POSITIVE));
    let log_p = log_tail(2.0, 2.0 * (largest - by_model).max(0.0)) + (of_rhythm.len().max(1) as f64).ln();
    Finding { what: "rhythm", log_p: log_p.min(0.0), excess: (spread * largest * n).sqrt() }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    #[test]
    fn noise_in_every_fourth_row_has_a_rhythm_and_even_noise_has_none() {
        for seed in 0..8 {
            let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
            let mut z: Vec<f64> = (0..2400).map(|_| StandardNormal.sample(&mut random)).collect();
            assert!(rhythm(&z, 0.05).log_p > -9.0, "{seed}: {}", rhythm(&z, 0.05).log_p);
            z.iter_mut().step_by(4).for_each(|z| *z *= 1.8);
            assert!(rhythm(&z, 0.05).log_p < -20.0, "{seed}: {}", rhythm(&z, 0.05).log_p);
        }
    }
}

//! Direction without the sensor's noise, and between the rows.
//!
//! The columns of the 18 terms hold the direction and its derivative: noise in them is an error in variables that
//! biases the fit and stays in the residual. Three steps, each on the residual of the ones before:
//!
//! 1. a Wiener filter for slow motion: the sensor's noise is known from the top of the spectrum. The result is
//!    band-limited, so that it can be evaluated between the rows;
//! 2. the same moment by moment for quicker motion, which comes and goes: what is let through all the time lets its noise
//!    through all the time (`moments`);
//! 3. the reading itself where it still disagrees by far more than noise, as at the ends of a fast motion (`missed`).

mod ends;
mod missed;
mod moments;

use towmag_fourier::Complex;

use crate::diagnosis::numerics::{cumulative_sums, median};
use crate::diagnosis::policy::{MOMENT_SLOWEST_HZ, MOTION_HIGHEST_HZ, MOTION_LEAST_RATIO, NOISE_FLOOR_MARGIN, RATE_HZ};
use ends::predicted;

/// Half of the rate, Hz.
const NYQUIST_HZ: f64 = 0.5 * RATE_HZ;
/// Width of the bins that the spectrum is averaged over, Hz.
const BIN_HZ: f64 = 0.04;
/// A shorter series has no spectrum to speak of, rows.
const LEAST_ROWS: usize = 8;

/// Evenly spaced values at 10 Hz without the noise that lies above the spectrum of motion, `factor` times as dense.
///
/// The value with index `factor * k` belongs to row `k`. A series shorter than 8 rows is interpolated as it is.
pub(crate) fn smooth_dense(values: &[f64], factor: usize) -> Vec<f64> {
    if values.len() < LEAST_ROWS {
        return interpolated(values, factor);
    }
    let before = predicted(&values.iter().rev().copied().collect::<Vec<_>>());
    let first = before.len() * factor;
    let longer: Vec<f64> = before.into_iter().rev().chain(values.iter().copied()).chain(predicted(values)).collect();
    let mut dense = band_limited(&longer, factor);
    let residual = |dense: &[f64]| -> Vec<f64> {
        longer.iter().zip(dense.iter().step_by(factor)).map(|(value, smooth)| value - smooth).collect()
    };
    let brief = moments::motion(&residual(&dense), factor);
    add(&mut dense, &brief);
    let missed = missed::motion(&residual(&dense), factor);
    add(&mut dense, &missed);
    dense[first..][..(values.len() - 1) * factor + 1].to_vec()
}

fn add(sum: &mut [f64], more: &[f64]) {
    sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

/// A Wiener filter over a series of at least 3 rows, `factor` times as dense. What is filtered is the series less the
/// straight line between its ends, continued by point reflection at both: a sine series, without a jump or a kink.
fn band_limited(values: &[f64], factor: usize) -> Vec<f64> {
    let n = values.len();
    let (start, end) = (values[0], values[n - 1]);
    let line = |at: f64| start + (end - start) * at / (n - 1) as f64;
    let above: Vec<f64> = (0..n).map(|k| values[k] - line(k as f64)).collect();
    let spectrum = sine_transform(&above);
    let gains = slow_gains(&above, &spectrum[..n]);
    let period = spectrum.len();
    let mut dense = vec![Complex::default(); period * factor];
    let dense_len = dense.len();
    for k in 1..n - 1 {
        dense[k] = spectrum[k] * gains[k];
        dense[dense_len - k] = spectrum[period - k] * gains[k];
    }
    towmag_fourier::inverse(dense_len).process(&mut dense);
    (0..(n - 1) * factor + 1).map(|k| dense[k].re / period as f64 + line(k as f64 / factor as f64)).collect()
}

/// Spectrum of the odd periodic continuation of a series of `n` values that is 0 at both ends: `2 (n - 1)` of them.
fn sine_transform(values: &[f64]) -> Vec<Complex<f64>> {
    let n = values.len();
    let period = 2 * (n - 1);
    let mut spectrum: Vec<Complex<f64>> = vec![Complex::default(); period];
    for k in 1..n - 1 {
        spectrum[k].re = values[k];
        spectrum[period - k].re = -values[k];
    }
    towmag_fourier::forward(period).process(&mut spectrum);
    spectrum
}

/// Wiener gain at each frequency from 0 to half of the rate; 0 for motion that is left to its moments.
fn slow_gains(values: &[f64], half_spectrum: &[Complex<f64>]) -> Vec<f64> {
    let mut gains = wiener(half_spectrum);
    if moments::has_moments(values) {
        let hz = |k: usize| NYQUIST_HZ * k as f64 / (values.len() - 1) as f64;
        gains.iter_mut().enumerate().filter(|(k, _)| hz(*k) > MOMENT_SLOWEST_HZ).for_each(|(_, gain)| *gain = 0.0);
    }
    gains
}

/// Wiener gain at each frequency of a spectrum from 0 to half of the rate: the share of its power that is motion.
fn wiener(half_spectrum: &[Complex<f64>]) -> Vec<f64> {
    let n = half_spectrum.len();
    let bin = ((BIN_HZ / NYQUIST_HZ * n as f64).round() as usize).clamp(4, n);
    let sums = cumulative_sums(half_spectrum.iter().map(Complex::norm_sqr));
    let mean = |k: usize| {
        let (from, to) = (k.saturating_sub(bin / 2).max(1).min(n - 1), (k + bin / 2 + 1).min(n));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    let first_noise = (MOTION_HIGHEST_HZ / NYQUIST_HZ * n as f64) as usize;
    let top: Vec<f64> = half_spectrum[first_noise..].iter().map(Complex::norm_sqr).collect();
    // The median of an exponential variable is ln 2 of its mean; a line in the spectrum does not move it.
    let floor = median(top) / std::f64::consts::LN_2;
    (0..n).map(|k| gain(mean(k), floor)).collect()
}

/// Wiener gain for a mean power over a noise `floor`; 0 where the noise is a good part of it: the little motion in it is
/// left to its moments, or its noise would be let in all the time.
fn gain(mean: f64, floor: f64) -> f64 {
    if mean <= MOTION_LEAST_RATIO * floor { 0.0 } else { (mean - NOISE_FLOOR_MARGIN * floor) / mean }
}

/// Straight lines between the values.
fn interpolated(values: &[f64], factor: usize) -> Vec<f64> {
    let last = values.len() - 1;
    (0..last * factor + 1)
        .map(|k| {
            let (row, part) = (k / factor, (k % factor) as f64 / factor as f64);
            values[row] + part * (values[(row + 1).min(last)] - values[row])
        })
        .collect()
}

/// Slow part of a series at 10 Hz: twice the moving average over `window` rows, the series continued by point reflection
/// at its ends. (A window that shrinks towards the ends would have a kink where it begins to.)
pub(crate) fn slow(values: &[f64], window: usize) -> Vec<f64> {
    let Some((&first, &last)) = values.first().zip(values.last()) else { return Vec::new() };
    let more = window.min(values.len() - 1);
    let before = (1..=more).rev().map(|k| 2.0 * first - values[k]);
    let after = (1..=more).map(|k| 2.0 * last - values[values.len() - 1 - k]);
    let longer: Vec<f64> = before.chain(values.iter().copied()).chain(after).collect();
    moving_average(&moving_average(&longer, window), window)[more..][..values.len()].to_vec()
}

/// The mean of half a window on either side, fewer on both near the ends.
pub(crate) fn moving_average(values: &[f64], window: usize) -> Vec<f64> {
    let n = values.len();
    let sums = cumulative_sums(values.iter().copied());
    (0..n)
        .map(|k| {
            let half = (window / 2).min(k).min(n - 1 - k);
            (sums[k + half + 1] - sums[k - half]) / (2 * half + 1) as f64
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use std::f64::consts::TAU;

    fn motion(time_s: f64) -> f64 {
        300.0 * (TAU * 0.15 * time_s).sin() + 40.0 * (TAU * 0.9 * time_s + 1.0).sin() + 0.2 * time_s
    }

    /// Five minutes with noise of 1.
    fn noisy(seed: u64, of: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let noise: Vec<f64> = (0..3000).map(|_| StandardNormal.sample(&mut random)).collect();
        noise.iter().enumerate().map(|(k, noise)| of(0.1 * k as f64) + noise).collect()
    }

    #[test]
    fn noise_goes_and_motion_stays_on_and_between_the_rows() {
        let dense = smooth_dense(&noisy(4, motion), 5);
        let errors: Vec<f64> = (100..14_000).map(|k| dense[k] - motion(0.02 * k as f64)).collect();
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        assert!(rms < 0.6, "{rms} of noise 1");
    }

    #[test]
    fn the_ends_of_a_shake_are_as_good_as_its_middle() {
        let shaken = |time_s: f64| motion(time_s) + 1500.0 * (TAU * 1.07 * time_s + 0.4).sin();
        let dense = smooth_dense(&noisy(5, shaken), 5);
        // The last second is left out of every block.
        let worst = (14_800..14_946).map(|k| (dense[k] - shaken(0.02 * k as f64)).abs()).fold(0.0, f64::max);
        assert!(worst < 4.0, "{worst} of noise 1");
    }

    #[test]
    fn without_noise_nothing_changes() {
        let clean: Vec<f64> = (0..1200).map(|k| motion(0.1 * f64::from(k))).collect();
        let dense = smooth_dense(&clean, 5);
        for k in 40..1160 {
            assert!((dense[5 * k] - clean[k]).abs() < 0.05, "{k}");
        }
    }
}

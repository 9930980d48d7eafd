//! Direction without the sensor's noise, and between the rows.
//!
//! The columns of the 18 terms hold the direction and its derivative: noise in them is an error in variables that
//! biases the fit and stays in the residual. A Wiener filter per component takes what is known: the sensor's noise
//! from the top of the spectrum, the motion from the rest. Band-limited as the result is, it is evaluated anywhere. What
//! moves for moments only, so that the whole recording's spectrum does not show it, is then taken moment by moment, and
//! where the result still disagrees with what was read, as at the ends of a fast motion, the reading is right.

mod ends;
mod missed;
mod moments;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use ends::predicted;

/// Rows per second.
const RATE_HZ: f64 = 10.0;

/// The noise floor is taken from here up, Hz: a towed body does not move that fast.
const NOISE_FROM_HZ: f64 = 3.5;

/// Motion below so many times the noise is not let through at all times.
const LEAST: f64 = 4.0;

/// Width of the bins that the spectrum is averaged over, Hz.
const BIN_HZ: f64 = 0.04;

/// Evenly spaced values at 10 Hz without the noise that lies above the spectrum of motion, `factor` times as dense.
///
/// The value with index `factor * k` belongs to row `k`. A series shorter than 8 rows is interpolated as it is.
pub(crate) fn smooth_dense(values: &[f64], factor: usize) -> Vec<f64> {
    if values.len() < 8 {
        return interpolated(values, factor);
    }
    let before = predicted(&values.iter().rev().copied().collect::<Vec<_>>());
    let first = before.len() * factor;
    let longer: Vec<f64> = before.into_iter().rev().chain(values.iter().copied()).chain(predicted(values)).collect();
    let mut dense = band_limited(&longer, factor);
    let left = |dense: &[f64]| -> Vec<f64> {
        longer.iter().zip(dense.iter().step_by(factor)).map(|(value, smooth)| value - smooth).collect()
    };
    let brief = moments::motion(&left(&dense), factor);
    add(&mut dense, &brief);
    let missed = missed::motion(&left(&dense), factor);
    add(&mut dense, &missed);
    dense[first..][..(values.len() - 1) * factor + 1].to_vec()
}

fn add(sum: &mut [f64], more: &[f64]) {
    sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

/// A Wiener filter over a series that is continued beyond its ends by turning it about them.
fn band_limited(values: &[f64], factor: usize) -> Vec<f64> {
    let n = values.len();
    let (start, end) = (values[0], values[n - 1]);
    let line = |at: f64| start + (end - start) * at / (n - 1) as f64;
    let period = 2 * (n - 1);
    let mut spectrum: Vec<Complex<f64>> = vec![Complex::default(); period];
    let above: Vec<f64> = (0..n).map(|k| values[k] - line(k as f64)).collect();
    for k in 1..n - 1 {
        spectrum[k].re = above[k];
        spectrum[period - k].re = -above[k];
    }
    let mut planner = FftPlanner::new();
    planner.plan_fft_forward(period).process(&mut spectrum);
    let mut keep = wiener(&spectrum[..n]);
    let is_lasting = moments::is_lasting(&above);
    let hz = |k: usize| 0.5 * RATE_HZ * k as f64 / (n - 1) as f64;
    keep.iter_mut().enumerate().filter(|(k, _)| !is_lasting(hz(*k))).for_each(|(_, keep)| *keep = 0.0);
    let mut dense = vec![Complex::default(); period * factor];
    let dense_len = dense.len();
    for k in 1..n - 1 {
        dense[k] = spectrum[k] * keep[k];
        dense[dense_len - k] = spectrum[period - k] * keep[k];
    }
    planner.plan_fft_inverse(dense_len).process(&mut dense);
    (0..(n - 1) * factor + 1).map(|k| dense[k].re / period as f64 + line(k as f64 / factor as f64)).collect()
}

/// Share of each frequency that is signal.
fn wiener(half: &[Complex<f64>]) -> Vec<f64> {
    let n = half.len();
    let bin = ((BIN_HZ / (0.5 * RATE_HZ) * n as f64).round() as usize).clamp(4, n);
    let mut running = vec![0.0; n + 1];
    for (k, value) in half.iter().enumerate() {
        running[k + 1] = running[k] + value.norm_sqr();
    }
    let mean = |k: usize| {
        let (from, to) = (k.saturating_sub(bin / 2).max(1).min(n - 1), (k + bin / 2 + 1).min(n));
        (running[to] - running[from]) / (to - from) as f64
    };
    let first_noise = (NOISE_FROM_HZ / (0.5 * RATE_HZ) * n as f64) as usize;
    let mut top: Vec<f64> = half[first_noise..].iter().map(Complex::norm_sqr).collect();
    top.sort_by(f64::total_cmp);
    // The median of an exponential variable is ln 2 of its mean; not moved by a line in the spectrum.
    let floor = top[top.len() / 2] / std::f64::consts::LN_2;
    (0..n).map(|k| keep_of(mean(k), floor)).collect()
}

/// Wiener gain for a spectrum `mean` over a noise `floor`; none where the noise is a good part of it: what little motion
/// there is there is left to its moments, or its noise would be let in all the time.
fn keep_of(mean: f64, floor: f64) -> f64 {
    if mean <= LEAST * floor { 0.0 } else { (mean - 1.3 * floor) / mean }
}

fn interpolated(values: &[f64], factor: usize) -> Vec<f64> {
    let last = values.len() - 1;
    (0..last * factor + 1)
        .map(|k| {
            let (row, part) = (k / factor, (k % factor) as f64 / factor as f64);
            values[row] + part * (values[(row + 1).min(last)] - values[row])
        })
        .collect()
}

/// Slow part of a series at 10 Hz: twice the moving average over `window` rows, the series turned about its ends beyond
/// them. (A window that shrinks towards the ends would have a kink where it begins to.)
pub(crate) fn slow(values: &[f64], window: usize) -> Vec<f64> {
    let Some((&first, &last)) = values.first().zip(values.last()) else { return Vec::new() };
    let more = window.min(values.len() - 1);
    let before = (1..=more).rev().map(|k| 2.0 * first - values[k]);
    let after = (1..=more).map(|k| 2.0 * last - values[values.len() - 1 - k]);
    let longer: Vec<f64> = before.chain(values.iter().copied()).chain(after).collect();
    moving_average(&moving_average(&longer, window), window)[more..][..values.len()].to_vec()
}

fn moving_average(values: &[f64], window: usize) -> Vec<f64> {
    let n = values.len();
    let mut running = vec![0.0; n + 1];
    for (k, value) in values.iter().enumerate() {
        running[k + 1] = running[k] + value;
    }
    (0..n)
        .map(|k| {
            let half = (window / 2).min(k).min(n - 1 - k);
            (running[k + half + 1] - running[k - half]) / (2 * half + 1) as f64
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

//! Motion that lasts for moments: a shake of fifteen seconds stands out of the noise while it lasts, not on average.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::diagnosis::reconstruct::smooth::{NOISE_FROM_HZ, RATE_HZ};

/// Rows of a moment; the next one begins a step later.
const WINDOW: usize = 128;
const STEP: usize = WINDOW / 8;
/// Frequencies on either side that a spectrum is averaged over.
const BESIDE: usize = 3;
/// What a moment cannot tell from what is slower, Hz.
const SLOWEST_HZ: f64 = 0.4;
/// Windows that a series must have for most of them to mean anything.
const LEAST_MOMENTS: usize = 4;
/// What is below so many times the noise is noise: among thousands of averages it hardly ever is more.
const LEAST: f64 = 4.0;

/// What of `left`, values at 10 Hz that are mostly noise, is motion, `factor` times as dense.
pub(crate) fn motion(left: &[f64], factor: usize) -> Vec<f64> {
    let count = (left.len() - 1) * factor + 1;
    let mut sum = vec![0.0; count];
    if left.len() < 2 * WINDOW {
        return sum;
    }
    let back = FftPlanner::new().plan_fft_inverse(WINDOW * factor);
    let (starts, spectra) = spectra(left);
    let floor = floor(&spectra);
    for (start, spectrum) in starts.iter().zip(&spectra) {
        let mut dense = vec![Complex::default(); WINDOW * factor];
        let mut moves = false;
        for k in 1..WINDOW / 2 {
            let keep = keep(spectrum, k, floor);
            moves |= keep > 0.0;
            dense[k] = spectrum[k] * keep;
            dense[WINDOW * factor - k] = spectrum[WINDOW - k] * keep;
        }
        if !moves {
            continue;
        }
        back.process(&mut dense);
        for (k, value) in dense.iter().enumerate() {
            if let Some(sum) = sum.get_mut((start * factor as isize + k as isize) as usize) {
                *sum += value.re * weight(k as f64 / factor as f64) / WINDOW as f64 / OVERLAP;
            }
        }
    }
    sum
}

/// Whether there is motion at a frequency in most moments of a series; frequencies in Hz. What is not there in most is
/// left to the moments in which it is: let through all the time, it lets its noise through all the time.
pub(crate) fn is_lasting(values: &[f64]) -> impl Fn(f64) -> bool + use<> {
    let mut lasting = [true; WINDOW / 2 + 1];
    if values.len() >= LEAST_MOMENTS * WINDOW {
        let (_, spectra) = spectra(values);
        let floor = floor(&spectra);
        for (k, lasting) in lasting.iter_mut().enumerate() {
            let mut powers: Vec<f64> = spectra.iter().map(|spectrum| near(spectrum, k)).collect();
            let middle = powers.len() / 2;
            *lasting = *powers.select_nth_unstable_by(middle, f64::total_cmp).1 > LEAST * floor;
        }
    }
    move |hz| hz < SLOWEST_HZ || lasting[((hz / RATE_HZ * WINDOW as f64).round() as usize).min(WINDOW / 2)]
}

/// Spectra of windows, the first and the last of them nearly outside, and where they begin.
fn spectra(values: &[f64]) -> (Vec<isize>, Vec<Vec<Complex<f64>>>) {
    let forward = FftPlanner::new().plan_fft_forward(WINDOW);
    let starts = (1..).map(|k| (k * STEP) as isize - WINDOW as isize);
    let starts: Vec<isize> = starts.take_while(|start| *start < values.len() as isize).collect();
    let spectra = starts
        .iter()
        .map(|start| {
            let value = |k: usize| values.get((start + k as isize) as usize).copied().unwrap_or(0.0);
            let mut window: Vec<_> = (0..WINDOW).map(|k| Complex::new(value(k) * weight(k as f64), 0.0)).collect();
            forward.process(&mut window);
            window
        })
        .collect();
    (starts, spectra)
}

/// What the squares of the windows over a row add up to.
const OVERLAP: f64 = 3.0 / 8.0 * (WINDOW / STEP) as f64;

/// Hann's window.
fn weight(k: f64) -> f64 {
    (std::f64::consts::PI * k / WINDOW as f64).sin().powi(2)
}

/// Power of the noise at a frequency, from the median of what is above all motion.
fn floor(spectra: &[Vec<Complex<f64>>]) -> f64 {
    let first = (NOISE_FROM_HZ / RATE_HZ * WINDOW as f64) as usize;
    let mut powers: Vec<f64> =
        spectra.iter().flat_map(|spectrum| &spectrum[first..WINDOW / 2]).map(Complex::norm_sqr).collect();
    let middle = powers.len() / 2;
    *powers.select_nth_unstable_by(middle, f64::total_cmp).1 / std::f64::consts::LN_2
}

fn keep(spectrum: &[Complex<f64>], k: usize, floor: f64) -> f64 {
    let mean = near(spectrum, k);
    if mean > LEAST * floor { (mean - floor) / mean } else { 0.0 }
}

/// Mean power about a frequency.
fn near(spectrum: &[Complex<f64>], k: usize) -> f64 {
    let near = k.saturating_sub(BESIDE).max(1)..(k + BESIDE + 1).min(WINDOW / 2);
    spectrum[near.clone()].iter().map(Complex::norm_sqr).sum::<f64>() / near.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn a_moment_of_motion_stays_and_noise_alone_gives_nothing() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let noise: Vec<f64> = (0..4000).map(|_| StandardNormal.sample(&mut random)).collect();
        let energy = |dense: &[f64]| dense.iter().map(|x| x * x).sum::<f64>() / dense.len() as f64;
        assert!(energy(&motion(&noise, 5)) < 0.01);
        let shake = |k: f64| {
            let lasts = (-((k - 2000.0) / 60.0).powi(2)).exp();
            8.0 * lasts * (std::f64::consts::TAU * 0.21 * k).sin()
        };
        let with: Vec<f64> = noise.iter().enumerate().map(|(k, noise)| noise + shake(k as f64)).collect();
        let off: Vec<f64> = motion(&with, 5)[9_000..11_000]
            .iter()
            .enumerate()
            .map(|(k, x)| x - shake(0.2 * k as f64 + 1800.0))
            .collect();
        assert!(energy(&off) < 0.5, "{}", energy(&off));
    }
}

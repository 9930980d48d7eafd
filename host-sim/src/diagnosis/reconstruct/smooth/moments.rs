//! Motion that lasts for moments: a shake of fifteen seconds stands out of the noise while it lasts, not on average.
//!
//! A Wiener filter in overlapping windows ("moments"), each with Blackman and Harris's taper before and after its transform.

use towmag_fourier::{Complex, Plan};

use crate::diagnosis::numerics::median;
use crate::diagnosis::policy::{MOMENT_LEAST_RATIO, MOMENT_LEAST_RATIO_NEAR, MOTION_HIGHEST_HZ, RATE_HZ};

/// Rows of a moment; the next one begins a step later.
const WINDOW: usize = 96;
const STEP: usize = WINDOW / 8;
/// Terms of the taper: its side lobes are 92 dB down, as a body that rocks by 10,000 nT would otherwise be everywhere in a
/// spectrum whose noise is 0.5 nT (Harris, Proc. IEEE 66, 1978, table 1).
const TAPER: [f64; 4] = [0.358_75, 0.488_29, 0.141_28, 0.011_68];
/// What the squares of the tapers over one row add up to.
const OVERLAP: f64 = (TAPER[0] * TAPER[0] + 0.5 * (TAPER[1] * TAPER[1] + TAPER[2] * TAPER[2] + TAPER[3] * TAPER[3]))
    * (WINDOW / STEP) as f64;
/// Frequencies on either side that a spectrum is averaged over to find motion, and then to tell how much of it there is: what is found
/// beside a strong motion need not be one.
const BESIDE: usize = 5;
const NEAR: usize = 1;
/// Index of the first frequency at which there is no motion.
const FIRST_ABOVE_MOTION: usize = (MOTION_HIGHEST_HZ / RATE_HZ * WINDOW as f64) as usize;

/// The part of a residual at 10 Hz, mostly noise, that is motion, `factor` times as dense.
pub(crate) fn motion(residual: &[f64], factor: usize) -> Vec<f64> {
    let mut sum = vec![0.0; (residual.len() - 1) * factor + 1];
    if !has_moments(residual) {
        return sum;
    }
    let back = towmag_fourier::inverse(WINDOW * factor);
    let tapers = tapers(factor);
    let moments = moments(residual);
    let floor = floor(&moments);
    for moment in &moments {
        let Some(dense) = moment.motion(floor, factor, &back) else { continue };
        let first = moment.start * factor as isize;
        for (k, (value, taper)) in dense.iter().zip(&tapers).enumerate() {
            if let Some(sum) = sum.get_mut((first + k as isize) as usize) {
                *sum += value.re * taper / WINDOW as f64 / OVERLAP;
            }
        }
    }
    sum
}

/// Whether a series is long enough for moments to be told apart.
pub(crate) fn has_moments(values: &[f64]) -> bool {
    values.len() >= 2 * WINDOW
}

/// The spectrum of one window.
struct Moment {
    /// Its first row; the first windows begin before the series.
    start: isize,
    spectrum: Vec<Complex<f64>>,
}

impl Moment {
    /// Mean power of a frequency, given as its index, and so many `beside` it.
    fn power(&self, k: usize, beside: usize) -> f64 {
        let first = k.saturating_sub(beside).clamp(1, WINDOW / 2 - 2 * beside - 1);
        let near = &self.spectrum[first..first + 2 * beside + 1];
        near.iter().map(Complex::norm_sqr).sum::<f64>() / near.len() as f64
    }

    /// Wiener gain at a frequency over a noise of power `floor`.
    fn gain(&self, k: usize, floor: f64) -> f64 {
        let near = self.power(k, NEAR);
        let moves = self.power(k, BESIDE) > MOMENT_LEAST_RATIO * floor && near > MOMENT_LEAST_RATIO_NEAR * floor;
        if moves { (near - floor) / near } else { 0.0 }
    }

    /// Its motion, `factor` times as dense, times [`WINDOW`] and with one taper; `None` where it has none.
    fn motion(&self, floor: f64, factor: usize, back: &Plan) -> Option<Vec<Complex<f64>>> {
        let mut dense = vec![Complex::default(); WINDOW * factor];
        let mut moves = false;
        for k in 1..WINDOW / 2 {
            let gain = self.gain(k, floor);
            moves |= gain > 0.0;
            dense[k] = self.spectrum[k] * gain;
            dense[WINDOW * factor - k] = self.spectrum[WINDOW - k] * gain;
        }
        moves.then(|| {
            back.process(&mut dense);
            dense
        })
    }
}

/// The windows of a series, tapered; the first and the last of them nearly outside, where the series counts as 0.
fn moments(values: &[f64]) -> Vec<Moment> {
    let (forward, tapers) = (towmag_fourier::forward(WINDOW), tapers(1));
    let of_start = |start: isize| {
        let value = |k: usize| values.get((start + k as isize) as usize).copied().unwrap_or(0.0);
        let tapered = tapers.iter().enumerate().map(|(k, taper)| Complex::new(value(k) * taper, 0.0));
        let mut spectrum: Vec<_> = tapered.collect();
        forward.process(&mut spectrum);
        Moment { start, spectrum }
    };
    let starts = (1..).map(|k| (k * STEP) as isize - WINDOW as isize);
    starts.take_while(|start| *start < values.len() as isize).map(of_start).collect()
}

/// Blackman and Harris's taper of four terms, `factor` times as dense as the rows.
fn tapers(factor: usize) -> Vec<f64> {
    let taper = |k: usize| {
        let at = std::f64::consts::TAU * (k as f64 / factor as f64) / WINDOW as f64;
        TAPER[0] - TAPER[1] * at.cos() + TAPER[2] * (2.0 * at).cos() - TAPER[3] * (3.0 * at).cos()
    };
    (0..WINDOW * factor).map(taper).collect()
}

/// Power of the noise at a frequency: from the median of the powers above all motion, which is ln 2 of their mean.
fn floor(moments: &[Moment]) -> f64 {
    let above = moments.iter().flat_map(|moment| &moment.spectrum[FIRST_ABOVE_MOTION..WINDOW / 2]);
    median(above.map(Complex::norm_sqr).collect()) / std::f64::consts::LN_2
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

//! Motion that lasts for moments: a shake of fifteen seconds stands out of the noise while it lasts, not on average.
//!
//! A Wiener filter in overlapping windows ("moments"), each with Hann's taper before and after its transform.

use towmag_fourier::{Complex, Plan};

use crate::diagnosis::numerics::median;
use crate::diagnosis::policy::{
    MOMENT_LEAST_RATIO, MOMENT_SLOWEST_HZ, MOMENTS_FOR_A_MAJORITY, MOTION_HIGHEST_HZ, RATE_HZ,
};

/// Rows of a moment; the next one begins a step later.
const WINDOW: usize = 128;
const STEP: usize = WINDOW / 8;
/// What the squares of the tapers over one row add up to.
const OVERLAP: f64 = 3.0 / 8.0 * (WINDOW / STEP) as f64;
/// Frequencies on either side that a spectrum is averaged over.
const BESIDE: usize = 3;

/// The part of a residual at 10 Hz, mostly noise, that is motion, `factor` times as dense.
pub(crate) fn motion(residual: &[f64], factor: usize) -> Vec<f64> {
    let mut sum = vec![0.0; (residual.len() - 1) * factor + 1];
    if residual.len() < 2 * WINDOW {
        return sum;
    }
    let back = towmag_fourier::inverse(WINDOW * factor);
    let moments = moments(residual);
    let floor = floor(&moments);
    for moment in &moments {
        let Some(dense) = moment.motion(floor, factor, &back) else { continue };
        let first = moment.start * factor as isize;
        for (k, value) in dense.iter().enumerate() {
            if let Some(sum) = sum.get_mut((first + k as isize) as usize) {
                *sum += value.re * taper(k as f64 / factor as f64) / WINDOW as f64 / OVERLAP;
            }
        }
    }
    sum
}

/// Whether there is motion at a frequency, Hz, in most moments of a series. Motion that is not is left to the moments that
/// have it: a filter that let it through all the time would let its noise through all the time.
pub(crate) fn is_lasting(values: &[f64]) -> impl Fn(f64) -> bool + use<> {
    let mut lasting = [true; WINDOW / 2 + 1];
    if values.len() >= MOMENTS_FOR_A_MAJORITY * WINDOW {
        let moments = moments(values);
        let floor = floor(&moments);
        for (k, lasting) in lasting.iter_mut().enumerate() {
            *lasting = median(moments.iter().map(|moment| moment.power(k)).collect()) > MOMENT_LEAST_RATIO * floor;
        }
    }
    move |hz| hz < MOMENT_SLOWEST_HZ || lasting[((hz / RATE_HZ * WINDOW as f64).round() as usize).min(WINDOW / 2)]
}

/// The spectrum of one window.
struct Moment {
    /// Its first row; the first windows begin before the series.
    start: isize,
    spectrum: Vec<Complex<f64>>,
}

impl Moment {
    /// Mean power about a frequency, given as its index.
    fn power(&self, k: usize) -> f64 {
        let near = k.saturating_sub(BESIDE).max(1)..(k + BESIDE + 1).min(WINDOW / 2);
        self.spectrum[near.clone()].iter().map(Complex::norm_sqr).sum::<f64>() / near.len() as f64
    }

    /// Wiener gain at a frequency over a noise of power `floor`.
    fn gain(&self, k: usize, floor: f64) -> f64 {
        let power = self.power(k);
        if power > MOMENT_LEAST_RATIO * floor { (power - floor) / power } else { 0.0 }
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
    let forward = towmag_fourier::forward(WINDOW);
    let of_start = |start: isize| {
        let value = |k: usize| values.get((start + k as isize) as usize).copied().unwrap_or(0.0);
        let mut spectrum: Vec<_> = (0..WINDOW).map(|k| Complex::new(value(k) * taper(k as f64), 0.0)).collect();
        forward.process(&mut spectrum);
        Moment { start, spectrum }
    };
    let starts = (1..).map(|k| (k * STEP) as isize - WINDOW as isize);
    starts.take_while(|start| *start < values.len() as isize).map(of_start).collect()
}

/// Hann's taper.
fn taper(k: f64) -> f64 {
    (std::f64::consts::PI * k / WINDOW as f64).sin().powi(2)
}

/// Power of the noise at a frequency: from the median of the powers above all motion, which is ln 2 of their mean.
fn floor(moments: &[Moment]) -> f64 {
    let first = (MOTION_HIGHEST_HZ / RATE_HZ * WINDOW as f64) as usize;
    let powers = moments.iter().flat_map(|moment| &moment.spectrum[first..WINDOW / 2]).map(Complex::norm_sqr);
    median(powers.collect()) / std::f64::consts::LN_2
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

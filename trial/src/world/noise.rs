//! Sensor noise of a known colour, and the filter that makes it white again.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal, StudentT};

use crate::random::Random;

/// Taps of the filter of pink noise: flat below about 0.02 Hz.
const PINK_TAPS: usize = 256;
/// Samples that run before the first one is used.
const RUN_IN: usize = 3000;
/// The band that a size is told in, Hz: half the sample rate, and where the background ends.
pub(crate) const BAND_HZ: [f64; 2] = [0.04, 5.0];

/// White noise of `innovation_nt` through `1 / whitening`.
#[derive(Clone, Debug)]
pub(crate) struct Noise {
    /// `white`, `pink` or `ar1`.
    pub(crate) colour: &'static str,
    /// Standard deviation of what drives it, nT.
    pub(crate) innovation_nt: f64,
    /// The filter that makes it white: `innovation[t] = sum whitening[k] noise[t - k]`.
    pub(crate) whitening: Vec<f64>,
    /// Its rms in the band over its innovation.
    shape: f64,
    /// Degrees of freedom of Student's t, of noise with heavy tails; else it is normal.
    tails: Option<f64>,
}

impl Noise {
    /// White noise.
    pub(crate) fn white(rms_nt: f64) -> Self {
        Self::new("white", vec![1.0], rms_nt)
    }

    /// With a spectrum of 1/f.
    fn pink(rms_nt: f64) -> Self {
        static UNIT: LazyLock<Noise> = LazyLock::new(|| Noise::new("pink", pink_taps(), 1.0));
        Self { innovation_nt: rms_nt / UNIT.shape, ..UNIT.clone() }
    }

    /// Of any colour, with this rms in the band.
    pub(super) fn draw(rms_nt: f64, draw: &mut Random) -> Self {
        let has_heavy_tails = draw.random_bool(0.25);
        let tails = has_heavy_tails.then(|| draw.random_range(3.0..6.0));
        let coloured = match draw.random_range(0..3_u8) {
            0 => Self::white(rms_nt),
            1 => Self::pink(rms_nt),
            _ => Self::new("ar1", vec![1.0, -draw.random_range(0.3..0.9)], rms_nt),
        };
        Self { tails, ..coloured }
    }

    fn new(colour: &'static str, whitening: Vec<f64>, rms_nt: f64) -> Self {
        let shape = band_rms(&whitening);
        Self { colour, innovation_nt: rms_nt / shape, whitening, shape, tails: None }
    }

    /// Its colour, and whether its tails are heavy.
    pub(crate) fn name(&self) -> String {
        let tails = if self.tails.is_some() { ", heavy tails" } else { "" };
        format!("{}{tails}", self.colour)
    }

    /// In 0.04 to 5 Hz, nT.
    pub(crate) fn band_rms_nt(&self) -> f64 {
        self.innovation_nt * self.shape
    }

    /// One realisation, nT.
    pub(super) fn sample(&self, rows: usize, draw: &mut Random) -> Vec<f64> {
        let mut all = Vec::with_capacity(RUN_IN + rows);
        for at in 0..RUN_IN + rows {
            let driven = self.driven(draw);
            let memory: f64 = self.whitening.iter().enumerate().skip(1).take(at).map(|(k, w)| w * all[at - k]).sum();
            all.push(self.innovation_nt * driven - memory);
        }
        all.split_off(RUN_IN)
    }

    /// What drives it, with unit variance.
    fn driven(&self, draw: &mut Random) -> f64 {
        match self.tails.and_then(|freedom| Some((freedom, StudentT::new(freedom).ok()?))) {
            Some((freedom, student)) => ((freedom - 2.0) / freedom).sqrt() * student.sample(draw),
            None => StandardNormal.sample(draw),
        }
    }

    /// A series as the filter leaves it, over the innovation: noise of this colour becomes white with unit variance.
    pub(crate) fn whitened(&self, series: &[f64]) -> Vec<f64> {
        (0..series.len())
            .map(|at| {
                let reach = self.whitening.iter().enumerate().take(at + 1);
                reach.map(|(k, weight)| weight * series[at - k]).sum::<f64>() / self.innovation_nt
            })
            .collect()
    }
}

/// The rms in 0.04 to 5 Hz of white noise of unit variance through `1 / whitening`.
fn band_rms(whitening: &[f64]) -> f64 {
    const STEPS: usize = 2000;
    let [low, high] = BAND_HZ;
    let power = |step: usize| {
        let hz = low + (high - low) * (step as f64 + 0.5) / STEPS as f64;
        let (mut re, mut im) = (0.0, 0.0);
        for (k, weight) in whitening.iter().enumerate() {
            let (sin, cos) = libm::sincos(TAU * hz * k as f64 / 10.0);
            (re, im) = (re + weight * cos, im + weight * sin);
        }
        1.0 / (re * re + im * im)
    };
    let mean = (0..STEPS).map(power).sum::<f64>() / STEPS as f64;
    (mean * (high - low) / 5.0).sqrt()
}

/// Half a difference: the filter whose inverse has a spectrum of 1/f (Kasdin 1995).
fn pink_taps() -> Vec<f64> {
    let mut taps = vec![1.0];
    for k in 1..PINK_TAPS {
        taps.push(taps[k - 1] * (k as f64 - 1.5) / k as f64);
    }
    taps
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn whitened_noise_is_white_with_unit_variance_and_rms_is_as_asked() {
        let draw = &mut Random::seed_from_u64(3);
        for noise in [Noise::white(0.05), Noise::pink(0.05), Noise::new("ar1", vec![1.0, -0.8], 0.05)] {
            assert!((noise.band_rms_nt() - 0.05).abs() < 1e-9);
            let white = noise.whitened(&noise.sample(40_000, draw)).split_off(400);
            let power = |lag: usize| {
                white.iter().zip(&white[lag..]).map(|(a, b)| a * b).sum::<f64>() / (white.len() - lag) as f64
            };
            assert!((power(0) - 1.0).abs() < 0.03, "{} {}", noise.colour, power(0));
            assert!(power(1).abs() < 0.02 && power(7).abs() < 0.02, "{}", noise.colour);
        }
    }

    #[test]
    fn heavy_tails_have_the_rms_and_the_far_values_of_students_t() {
        let noise = Noise { tails: Some(5.0), ..Noise::white(0.05) };
        let driven: Vec<f64> = noise.sample(200_000, &mut Random::seed_from_u64(5));
        let sigma = noise.innovation_nt;
        let power = driven.iter().map(|nt| nt * nt).sum::<f64>() / driven.len() as f64;
        assert!((power / sigma.powi(2) - 1.0).abs() < 0.05, "{power}");
        // Beyond 4.0321 with 5 degrees of freedom lies one in a hundred: 3.1233 standard deviations.
        let far = driven.iter().filter(|nt| nt.abs() > 3.1233 * sigma).count() as f64 / driven.len() as f64;
        assert!((far - 0.01).abs() < 0.001, "{far}");
        assert_eq!((noise.name(), Noise::white(1.0).name()), ("white, heavy tails".into(), "white".into()));
    }

    #[test]
    fn pink_noise_has_as_much_power_in_every_octave() {
        let noise = Noise::pink(1.0);
        let series = noise.sample(1 << 16, &mut Random::seed_from_u64(4));
        // Differences of means over twice as many rows each: an octave a step.
        let power = |rows: usize| {
            let means: Vec<f64> = series.chunks_exact(rows).map(|c| c.iter().sum::<f64>() / rows as f64).collect();
            means.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum::<f64>() / means.len() as f64
        };
        assert!((power(4) / power(16) - 1.0).abs() < 0.2, "{}", power(4) / power(16));
    }
}

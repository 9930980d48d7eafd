//! Power spectral density by the method of Welch (1967).

use std::f64::consts::TAU;

use towmag_fourier::{Complex64, Plan};

use super::continuity::Continuity;

/// Samples in a segment: 51.2 s at 10 Hz, a resolution of 0.02 Hz, a fifth of the lower corner of the band.
const SEGMENT: usize = 512;

/// Amplitude spectral density. Empty when no stretch without a gap was long enough.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AmplitudeSpectrum {
    /// Frequencies, Hz, from zero to half the sample rate.
    pub frequency_hz: Vec<f64>,
    /// Amplitude density at each, nT per square root of Hz.
    pub density: Vec<f64>,
}

/// Running spectrum: Hann-windowed segments that overlap by half, each freed of its mean, their power averaged. A segment
/// never reaches across a gap.
#[derive(Clone)]
pub struct Welch {
    fft: Plan,
    window: Vec<f64>,
    segment: Vec<f64>,
    buffer: Vec<Complex64>,
    scratch: Vec<Complex64>,
    power: Vec<f64>,
    segments: u64,
    sample_rate_hz: f64,
    continuity: Continuity,
}

impl Welch {
    /// Of samples taken at `sample_rate_hz`.
    pub fn new(sample_rate_hz: f64) -> Self {
        let fft = towmag_fourier::forward(SEGMENT);
        Self {
            window: (0..SEGMENT).map(|i| 0.5 - 0.5 * (TAU * i as f64 / SEGMENT as f64).cos()).collect(),
            segment: Vec::with_capacity(SEGMENT),
            buffer: vec![Complex64::default(); SEGMENT],
            scratch: vec![Complex64::default(); fft.get_inplace_scratch_len()],
            power: vec![0.0; SEGMENT / 2 + 1],
            segments: 0,
            sample_rate_hz,
            continuity: Continuity::default(),
            fft,
        }
    }

    /// Take in one sample; a value that is not finite counts as missing.
    pub fn push(&mut self, time_s: f64, value: f64) {
        if !value.is_finite() {
            return;
        }
        if self.continuity.after_gap(time_s) {
            self.segment.clear();
        }
        self.segment.push(value);
        if self.segment.len() == SEGMENT {
            self.take_segment();
            self.segment.drain(..SEGMENT / 2);
        }
    }

    fn take_segment(&mut self) {
        let mean = self.segment.iter().sum::<f64>() / SEGMENT as f64;
        for ((slot, value), window) in self.buffer.iter_mut().zip(&self.segment).zip(&self.window) {
            *slot = Complex64::new((value - mean) * window, 0.0);
        }
        self.fft.process_with_scratch(&mut self.buffer, &mut self.scratch);
        for (power, bin) in self.power.iter_mut().zip(&self.buffer) {
            *power += bin.norm_sqr();
        }
        self.segments += 1;
    }

    /// One-sided amplitude density from zero to half the sample rate; empty before the first whole segment.
    pub fn spectrum(&self) -> AmplitudeSpectrum {
        if self.segments == 0 {
            return AmplitudeSpectrum::default();
        }
        let window_power: f64 = self.window.iter().map(|w| w * w).sum();
        let scale = 1.0 / (self.sample_rate_hz * window_power * self.segments as f64);
        let sides = |i: usize| if i == 0 || i == SEGMENT / 2 { 1.0 } else { 2.0 };
        AmplitudeSpectrum {
            frequency_hz: (0..self.power.len()).map(|i| i as f64 * self.sample_rate_hz / SEGMENT as f64).collect(),
            density: self.power.iter().enumerate().map(|(i, power)| (sides(i) * scale * power).sqrt()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardUniform};

    /// Uniform noise in -0.5 to 0.5, variance 1/12.
    fn noise(count: usize) -> Vec<f64> {
        let uniform = StandardUniform.sample_iter(ChaCha8Rng::seed_from_u64(7));
        uniform.take(count).map(|x: f64| x - 0.5).collect()
    }

    fn spectrum_of(values: &[f64]) -> AmplitudeSpectrum {
        let mut welch = Welch::new(10.0);
        values.iter().enumerate().for_each(|(i, &value)| welch.push(i as f64 * 0.1, value));
        welch.spectrum()
    }

    fn power(spectrum: &AmplitudeSpectrum) -> f64 {
        spectrum.density.iter().map(|d| d * d).sum::<f64>() * (spectrum.frequency_hz[1] - spectrum.frequency_hz[0])
    }

    /// The definition, by a direct Fourier sum.
    fn direct(values: &[f64], bin: usize) -> f64 {
        let hann = |i: usize| 0.5 - 0.5 * (TAU * i as f64 / 512.0).cos();
        let window_power: f64 = (0..512).map(|i| hann(i).powi(2)).sum();
        let starts: Vec<usize> = (0..=values.len() - 512).step_by(256).collect();
        let mut total = 0.0;
        for &start in &starts {
            let segment = &values[start..start + 512];
            let mean = segment.iter().sum::<f64>() / 512.0;
            let part = |i: usize| Complex64::from_polar(1.0, -TAU * (bin * i) as f64 / 512.0);
            let sum: Complex64 = (0..512).map(|i| part(i) * ((segment[i] - mean) * hann(i))).sum();
            total += 2.0 * sum.norm_sqr() / (10.0 * window_power);
        }
        (total / starts.len() as f64).sqrt()
    }

    #[test]
    fn agrees_with_the_definition() {
        let values: Vec<f64> = noise(2_000).iter().map(|v| v + 3.0).collect();
        let spectrum = spectrum_of(&values);
        assert_eq!(spectrum.frequency_hz.len(), 257);
        assert_eq!(spectrum.frequency_hz[256], 5.0);
        for bin in [1, 5, 100, 255] {
            assert!((spectrum.density[bin] / direct(&values, bin) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn parseval_noise_keeps_its_variance_and_is_flat() {
        let spectrum = spectrum_of(&noise(200_000));
        assert!((power(&spectrum) * 12.0 - 1.0).abs() < 0.01);
        let level = (1.0_f64 / 12.0 / 5.0).sqrt();
        assert!(spectrum.density[2..255].iter().all(|d| (d / level - 1.0).abs() < 0.2));
    }

    #[test]
    fn sine_has_its_power_at_its_frequency() {
        let sine: Vec<f64> = (0..10_000).map(|i| 2.0 * (TAU * 0.4 * f64::from(i) * 0.1).sin()).collect();
        let spectrum = spectrum_of(&sine);
        assert!((power(&spectrum) - 2.0).abs() < 0.01);
        let peak = (0..257).max_by(|&a, &b| spectrum.density[a].total_cmp(&spectrum.density[b])).unwrap();
        assert!((spectrum.frequency_hz[peak] - 0.4).abs() < 0.02);
    }

    #[test]
    fn no_segment_reaches_across_a_gap() {
        let mut welch = Welch::new(10.0);
        // A step of 1000 at every gap would flood the spectrum if a segment reached across.
        for i in 0..3_000_u32 {
            let stretch = i / 600;
            welch.push(f64::from(i) * 0.1 + f64::from(stretch), f64::from(stretch) * 1000.0);
        }
        assert_eq!(welch.segments, 5);
        assert!(welch.spectrum().density.iter().all(|d| *d < 1e-9));
    }

    #[test]
    fn too_short_for_a_segment_gives_nothing() {
        assert_eq!(spectrum_of(&noise(511)), AmplitudeSpectrum::default());
    }
}

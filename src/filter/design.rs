//! Design of the causal Butterworth band-pass from band, order and sample rate. In f64: it happens once.

use super::band_pass::{BandPass, MAX_ORDER, Section};
use crate::epoch::RATE_HZ;
use core::f64::consts::PI;
use nalgebra::Complex;

/// What the band-pass shall do. `build` turns it into coefficients, once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandPassDesign {
    /// Lower half-power frequency, Hz; above zero.
    pub low_hz: f64,
    /// Upper half-power frequency, Hz; above `low_hz` and below half the sample rate.
    pub high_hz: f64,
    /// Butterworth order: poles on each side of the band, 1 to 8.
    pub order: usize,
    /// Sample rate, Hz.
    pub sample_rate_hz: f64,
}

impl Default for BandPassDesign {
    /// 0.1 to 0.9 Hz, four poles a side: the band of the paper's section 3.1, at the rate of the epochs.
    fn default() -> Self {
        Self { low_hz: 0.1, high_hz: 0.9, order: 4, sample_rate_hz: RATE_HZ }
    }
}

/// Why a [`BandPassDesign`] cannot be built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BandPassError {
    /// The order is not 1 to 8.
    Order(usize),
    /// The frequencies do not satisfy 0 < low < high < half the sample rate.
    Band(BandPassDesign),
}

impl core::fmt::Display for BandPassError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Order(order) => write!(f, "band-pass order is {order}: choose 1 to {MAX_ORDER}"),
            Self::Band(design) => write!(
                f,
                "band-pass from {} to {} Hz at {} Hz: choose 0 < low < high < half the sample rate",
                design.low_hz, design.high_hz, design.sample_rate_hz
            ),
        }
    }
}

impl core::error::Error for BandPassError {}

impl BandPassDesign {
    /// Samples to a statistically independent one in noise that fills the band: the sample rate over twice the
    /// bandwidth.
    pub fn samples_per_independent(&self) -> f64 {
        self.sample_rate_hz / (2.0 * (self.high_hz - self.low_hz))
    }

    /// Butterworth prototype, low-pass to band-pass, bilinear transform with both edges pre-warped.
    pub fn build(&self) -> Result<BandPass, BandPassError> {
        self.validate()?;
        // Frequencies in units of twice the sample rate, in which the bilinear transform is s = (z - 1) / (z + 1).
        let low = libm::tan(PI * self.low_hz / self.sample_rate_hz);
        let high = libm::tan(PI * self.high_hz / self.sample_rate_hz);
        let mut band_pass =
            BandPass { sections: [Section::default(); MAX_ORDER], order: self.order, slowest_pole: 0.0 };
        // Prototype poles with non-negative imaginary part; each gives two sections, the real one gives one.
        let resonances = (0..self.order.div_ceil(2)).flat_map(|k| {
            let angle = PI * (2 * k + 1) as f64 / (2 * self.order) as f64;
            let pole = Complex::new(-libm::sin(angle), libm::cos(angle));
            resonances(pole, 2 * k + 1 == self.order, high - low, low * high)
        });
        for (section, resonance) in band_pass.sections.iter_mut().zip(resonances) {
            *section = resonance.section(high - low);
            band_pass.slowest_pole = band_pass.slowest_pole.max(resonance.largest_pole());
        }
        Ok(band_pass)
    }

    fn validate(&self) -> Result<(), BandPassError> {
        if !(1..=MAX_ORDER).contains(&self.order) {
            return Err(BandPassError::Order(self.order));
        }
        let in_order = 0.0 < self.low_hz && self.low_hz < self.high_hz && self.high_hz < self.sample_rate_hz / 2.0;
        if in_order && self.sample_rate_hz.is_finite() { Ok(()) } else { Err(BandPassError::Band(*self)) }
    }
}

/// Denominator `s^2 + damping s + square` of one section.
#[derive(Clone, Copy)]
struct Resonance {
    damping: f64,
    square: f64,
}

impl Resonance {
    fn section(&self, bandwidth: f64) -> Section {
        let a1 = 1.0 / (1.0 + self.damping + self.square);
        let omega = libm::sqrt(self.square);
        Section {
            a1: a1 as f32,
            a2: (a1 * omega) as f32,
            a3: (a1 * self.square) as f32,
            gain: (bandwidth / omega) as f32,
        }
    }

    /// Magnitude of the larger of the two poles in z.
    fn largest_pole(&self) -> f64 {
        let discriminant = self.damping * self.damping / 4.0 - self.square;
        if discriminant < 0.0 {
            let product = (1.0 - self.damping + self.square) / (1.0 + self.damping + self.square);
            return libm::sqrt(product);
        }
        let slow = -self.damping / 2.0 + libm::sqrt(discriminant);
        let fast = -self.damping / 2.0 - libm::sqrt(discriminant);
        libm::fabs((1.0 + slow) / (1.0 - slow)).max(libm::fabs((1.0 + fast) / (1.0 - fast)))
    }
}

/// Low-pass to band-pass: a prototype pole `p` becomes the roots of `s^2 - bandwidth p s + center^2`. Each complex root
/// pairs with its conjugate, which the conjugate of `p` gives.
fn resonances(pole: Complex<f64>, real: bool, bandwidth: f64, center_square: f64) -> impl Iterator<Item = Resonance> {
    let half = pole * (bandwidth / 2.0);
    let root = square_root(half * half - center_square);
    let of_root = |root: Complex<f64>| Resonance { damping: -2.0 * root.re, square: root.norm_sqr() };
    let both = if real {
        [Resonance { damping: -2.0 * half.re, square: center_square }; 2]
    } else {
        [of_root(half + root), of_root(half - root)]
    };
    both.into_iter().take(if real { 1 } else { 2 })
}

/// The root in the right half plane. By hand: the crate's own goes by way of the platform's trigonometry.
fn square_root(value: Complex<f64>) -> Complex<f64> {
    let magnitude = libm::hypot(value.re, value.im);
    let re = libm::sqrt((magnitude + value.re).max(0.0) / 2.0);
    let im = libm::sqrt((magnitude - value.re).max(0.0) / 2.0);
    Complex::new(re, if value.im < 0.0 { -im } else { im })
}

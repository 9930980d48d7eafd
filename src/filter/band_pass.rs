//! Causal Butterworth band-pass, designed from band, order and sample rate, started in steady state.

use core::f64::consts::PI;

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
    /// 0.1 to 0.9 Hz at 10 Hz, four poles a side: the band of the paper's section 3.1.
    fn default() -> Self {
        Self { low_hz: 0.1, high_hz: 0.9, order: 4, sample_rate_hz: 10.0 }
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

const MAX_ORDER: usize = 8;

/// Numbers that a filter remembers of a channel.
pub(crate) const STATES: usize = 2 * MAX_ORDER;

/// One second-order section as a trapezoidal state-variable filter (A. Simper, "Solving the continuous SVF equations
/// using trapezoidal integration", 2013). It is the bilinear transform exactly, and unlike a direct-form biquad it
/// keeps its precision in f32 when the pole lies as near to z = 1 as 0.1 Hz does at 10 Hz.
#[derive(Clone, Copy, Debug, Default)]
struct Section {
    a1: f32,
    a2: f32,
    a3: f32,
    gain: f32,
}

/// A designed band-pass: immutable coefficients for any number of channels.
#[derive(Clone, Copy, Debug)]
pub struct BandPass {
    sections: [Section; MAX_ORDER],
    order: usize,
    slowest_pole: f64,
}

/// Filter memory of `CHANNELS` signals that go through the same [`BandPass`].
#[derive(Clone, Copy, Debug)]
pub struct BandPassState<const CHANNELS: usize> {
    memory: [[[f32; CHANNELS]; 2]; MAX_ORDER],
}

impl<const CHANNELS: usize> BandPassState<CHANNELS> {
    /// The state that the filter has after `input` has stood still for ever: the output is zero, and a constant
    /// in the signal leaves no transient.
    pub fn steady(input: &[f32; CHANNELS]) -> Self {
        let mut memory = [[[0.0; CHANNELS]; 2]; MAX_ORDER];
        memory[0][1] = *input;
        Self { memory }
    }

    /// Make it what it would be if the input had always been more by `more`.
    pub(crate) fn shift(&mut self, more: &[f32; CHANNELS]) {
        self.memory[0][1].iter_mut().zip(more).for_each(|(value, more)| *value += more);
    }
}

impl BandPassState<1> {
    /// All that it remembers.
    pub(crate) fn values(&self) -> impl Iterator<Item = f32> + '_ {
        self.memory.as_flattened().iter().map(|[value]| *value)
    }

    /// Subtract the weighted sum of the first channels of another filter.
    pub(crate) fn subtract<const CHANNELS: usize>(&mut self, other: &BandPassState<CHANNELS>, weights: &[f32]) {
        for ([value], channels) in self.memory.as_flattened_mut().iter_mut().zip(other.memory.as_flattened()) {
            *value -= channels.iter().zip(weights).map(|(channel, weight)| channel * weight).sum::<f32>();
        }
    }
}

impl<const CHANNELS: usize> Default for BandPassState<CHANNELS> {
    fn default() -> Self {
        Self { memory: [[[0.0; CHANNELS]; 2]; MAX_ORDER] }
    }
}

impl BandPassDesign {
    /// Samples that count as one: noise that fills the band has this many samples to an independent one.
    pub fn samples_per_independent(&self) -> f64 {
        self.sample_rate_hz / (2.0 * (self.high_hz - self.low_hz))
    }

    /// Butterworth prototype, low-pass to band-pass, bilinear transform with both edges pre-warped.
    pub fn build(&self) -> Result<BandPass, BandPassError> {
        if !(1..=MAX_ORDER).contains(&self.order) {
            return Err(BandPassError::Order(self.order));
        }
        let in_order = 0.0 < self.low_hz && self.low_hz < self.high_hz && self.high_hz < self.sample_rate_hz / 2.0;
        if !(in_order && self.sample_rate_hz.is_finite()) {
            return Err(BandPassError::Band(*self));
        }
        // Frequencies in units of twice the sample rate, in which the bilinear transform is s = (z - 1) / (z + 1).
        let low = libm::tan(PI * self.low_hz / self.sample_rate_hz);
        let high = libm::tan(PI * self.high_hz / self.sample_rate_hz);
        let mut band_pass =
            BandPass { sections: [Section::default(); MAX_ORDER], order: self.order, slowest_pole: 0.0 };
        let mut next = 0;
        // Prototype poles with non-negative imaginary part; each gives two sections, the real one gives one.
        for k in 0..self.order.div_ceil(2) {
            let angle = PI * (2 * k + 1) as f64 / (2 * self.order) as f64;
            let pole = Complex { re: -libm::sin(angle), im: libm::cos(angle) };
            let real = 2 * k + 1 == self.order;
            for resonance in resonances(pole, real, high - low, low * high) {
                band_pass.sections[next] = resonance.section(high - low);
                band_pass.slowest_pole = band_pass.slowest_pole.max(resonance.largest_pole());
                next += 1;
            }
        }
        Ok(band_pass)
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

#[derive(Clone, Copy)]
struct Complex {
    re: f64,
    im: f64,
}

/// Low-pass to band-pass: a prototype pole `p` becomes the roots of `s^2 - bandwidth p s + center^2`. Each complex root
/// pairs with its conjugate, which the conjugate of `p` gives.
fn resonances(pole: Complex, real: bool, bandwidth: f64, center_square: f64) -> impl Iterator<Item = Resonance> {
    let half = Complex { re: pole.re * bandwidth / 2.0, im: pole.im * bandwidth / 2.0 };
    let root =
        square_root(Complex { re: half.re * half.re - half.im * half.im - center_square, im: 2.0 * half.re * half.im });
    let from_root = |sign: f64| {
        let (re, im) = (half.re + sign * root.re, half.im + sign * root.im);
        Resonance { damping: -2.0 * re, square: re * re + im * im }
    };
    let both = if real {
        [Resonance { damping: -2.0 * half.re, square: center_square }; 2]
    } else {
        [from_root(1.0), from_root(-1.0)]
    };
    both.into_iter().take(if real { 1 } else { 2 })
}

fn square_root(value: Complex) -> Complex {
    let magnitude = libm::hypot(value.re, value.im);
    let re = libm::sqrt((magnitude + value.re).max(0.0) / 2.0);
    let im = libm::sqrt((magnitude - value.re).max(0.0) / 2.0);
    Complex { re, im: if value.im < 0.0 { -im } else { im } }
}

impl BandPass {
    /// One sample of every channel.
    pub fn step<const CHANNELS: usize>(
        &self,
        state: &mut BandPassState<CHANNELS>,
        input: &[f32; CHANNELS],
    ) -> [f32; CHANNELS] {
        let mut signal = *input;
        for (section, [first, second]) in self.sections[..self.order].iter().zip(&mut state.memory) {
            for ((x, first), second) in signal.iter_mut().zip(first).zip(second) {
                let drive = *x - *second;
                let band = section.a1 * *first + section.a2 * drive;
                let low = *second + section.a2 * *first + section.a3 * drive;
                *first = 2.0 * band - *first;
                *second = 2.0 * low - *second;
                *x = section.gain * band;
            }
        }
        signal
    }

    /// Without input: what a state becomes, `next = matrix * state`, and what comes out of it, `row * state`.
    pub(crate) fn unit_responses(&self) -> ([[f32; STATES]; STATES], [f32; STATES]) {
        let mut state = BandPassState::<STATES>::default();
        for (i, channels) in state.memory[..self.order].as_flattened_mut().iter_mut().enumerate() {
            channels[i] = 1.0;
        }
        let output = self.step(&mut state, &[0.0; STATES]);
        let mut next = [[0.0; STATES]; STATES];
        next.copy_from_slice(state.memory.as_flattened());
        (next, output)
    }

    /// Number of samples after which the transient of the slowest pole has decayed to `fraction`, 0 to 1.
    pub fn settling_samples(&self, fraction: f64) -> u32 {
        libm::ceil(libm::log(fraction) / libm::log(self.slowest_pole)) as u32
    }
}

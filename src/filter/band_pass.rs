//! The band-pass as it runs: a cascade of second-order sections over any number of channels.

use nalgebra::{Const, SMatrix, SVector, VectorView};

/// Most poles on each side of the band.
pub(super) const MAX_ORDER: usize = 8;

/// Numbers that a filter remembers of a channel.
pub(crate) const STATES: usize = 2 * MAX_ORDER;

/// One second-order section as a trapezoidal state-variable filter (A. Simper, "Solving the continuous SVF equations
/// using trapezoidal integration", 2013). It is the bilinear transform exactly, and unlike a direct-form biquad it
/// keeps its precision in f32 when the pole lies as near to z = 1 as 0.1 Hz does at 10 Hz.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Section {
    pub(super) a1: f32,
    pub(super) a2: f32,
    pub(super) a3: f32,
    pub(super) gain: f32,
}

/// A designed band-pass: immutable coefficients for any number of channels.
#[derive(Clone, Copy, Debug)]
pub struct BandPass {
    pub(super) sections: [Section; MAX_ORDER],
    /// Sections in use, 1 to 8: one for each pole on a side.
    pub(super) order: usize,
    /// Magnitude of the pole nearest to the unit circle, 0 to 1.
    pub(super) slowest_pole: f64,
}

/// Filter memory of `CHANNELS` signals that go through the same [`BandPass`].
#[derive(Clone, Copy, Debug)]
pub struct BandPassState<const CHANNELS: usize> {
    /// By section, then its two integrators, then by channel.
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
    pub(crate) fn add_constant(&mut self, more: &[f32; CHANNELS]) {
        self.memory[0][1].iter_mut().zip(more).for_each(|(value, more)| *value += more);
    }
}

impl BandPassState<1> {
    /// What it holds when there has been nothing.
    pub(crate) const ZERO: Self = Self { memory: [[[0.0]; 2]; MAX_ORDER] };

    /// All that it remembers.
    pub(crate) fn values(&self) -> VectorView<'_, f32, Const<STATES>> {
        VectorView::<f32, Const<STATES>>::from_slice(self.memory.as_flattened().as_flattened())
    }

    /// Subtract the weighted sum of the first `N` of the channels of another filter.
    pub(crate) fn subtract<const CHANNELS: usize, const N: usize>(
        &mut self,
        other: &BandPassState<CHANNELS>,
        weights: &SVector<f32, N>,
    ) {
        const { assert!(N <= CHANNELS) }
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

impl BandPass {
    /// One sample of every channel.
    ///
    /// `f32` throughout; each channel is independent of the others. The gain is 1 in the middle of the band, -3 dB at
    /// its edges and nowhere above 1; within the cascade a section's gain reaches the ratio of its width to the band's.
    /// Inputs up to 1e6 are far from overflow; an input that is not finite stays in the state for good. A state that
    /// decays goes through subnormal numbers to zero, at any place at the same epoch: no platform flushes them.
    pub fn step<const CHANNELS: usize>(
        &self,
        state: &mut BandPassState<CHANNELS>,
        input: &[f32; CHANNELS],
    ) -> [f32; CHANNELS] {
        let mut signal = *input;
        for (section, [first, second]) in self.sections.iter().take(self.order).zip(&mut state.memory) {
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

    /// The filter without input as a linear system: what a state becomes, `next = F state`, and what comes out of it,
    /// `output' state`.
    pub(crate) fn state_space(&self) -> (SMatrix<f32, STATES, STATES>, SVector<f32, STATES>) {
        // One channel for each unit state.
        let mut state = BandPassState::<STATES>::default();
        for (i, channels) in state.memory[..self.order].as_flattened_mut().iter_mut().enumerate() {
            channels[i] = 1.0;
        }
        let output = self.step(&mut state, &[0.0; STATES]);
        let next = state.memory.as_flattened();
        (SMatrix::from_fn(|i, j| next[i][j]), output.into())
    }

    /// Number of samples after which the transient of the slowest pole has decayed to `fraction`, 0 to 1.
    pub fn settling_samples(&self, fraction: f64) -> u32 {
        libm::ceil(libm::log(fraction) / libm::log(self.slowest_pole)) as u32
    }
}

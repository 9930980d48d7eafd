//! Whitening for a slow random background beneath white noise.
//!
//! Geology and diurnal change have a spectrum that rises towards zero frequency. Rows that go through the inverse of its
//! root have white errors, and least squares of them is generalised least squares. Two first-order high-passes are that
//! inverse: above their corner every frequency counts alike, below it the background drowns the rest.

use crate::model::{Row, TERMS, TermVector};

/// High-passes one after the other: one lets 0.3 nT of 10 nT of geology at 60 s through, where the scalar's noise is 0.03.
const STAGES: usize = 2;

const CHANNELS: usize = TERMS + 1;

/// `y(t) = p y(t - 1) + g (x(t) - x(t - 1))`, `g = (1 + p) / 2`, so that half the sample rate passes with a gain of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Whitening {
    pole: f32,
}

/// What the high-passes remember.
#[derive(Clone, Copy, Debug)]
pub(super) struct WhiteningState {
    /// By stage: the latest input, and the latest output.
    stages: [[[f32; CHANNELS]; 2]; STAGES],
}

impl Whitening {
    /// With the corner at `corner_hz` of rows that come `rate_hz` times a second.
    pub(super) fn new(corner_hz: f64, rate_hz: f64) -> Self {
        Self { pole: libm::exp(-core::f64::consts::TAU * corner_hz / rate_hz) as f32 }
    }

    /// The state after `row` has stood still for ever.
    pub(super) fn steady(row: &Row) -> WhiteningState {
        let zero = [0.0; CHANNELS];
        WhiteningState { stages: [[channels(row), zero], [zero, zero]] }
    }

    /// One row. `f32`; elementwise, gain at most 1.
    pub(super) fn step(&self, state: &mut WhiteningState, row: &Row) -> Row {
        let gain = 0.5 * (1.0 + self.pole);
        let mut signal = channels(row);
        for [inputs, outputs] in &mut state.stages {
            for ((x, before), y) in signal.iter_mut().zip(inputs).zip(outputs) {
                *y = self.pole * *y + gain * (*x - *before);
                *before = *x;
                *x = *y;
            }
        }
        Row { terms: TermVector::from_fn(|i, _| signal[i]), scalar_nt: signal[TERMS] }
    }
}

fn channels(row: &Row) -> [f32; CHANNELS] {
    let mut channels = [row.scalar_nt; CHANNELS];
    channels[..TERMS].copy_from_slice(row.terms.as_slice());
    channels
}

//! Sums of sines on the fine grid.

use std::f64::consts::TAU;

use rand::RngExt;

use super::grid::{FINE_HZ, Grid};
use crate::random::Random;

/// `amplitude sin(2 pi hz t + phase)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tone {
    pub(super) hz: f64,
    pub(super) amplitude: f64,
    pub(super) phase: f64,
}

impl Tone {
    /// A quarter period behind.
    pub(super) fn behind(self) -> Self {
        Self { phase: self.phase - 0.25 * TAU, ..self }
    }

    /// With its amplitude times `by`.
    pub(super) fn times(self, by: f64) -> Self {
        Self { amplitude: self.amplitude * by, ..self }
    }
}

/// Their sum at every sample of the grid.
pub(super) fn sum(grid: &Grid, tones: &[Tone]) -> Vec<f64> {
    let mut all = vec![0.0; grid.len()];
    for tone in tones {
        let turn = TAU * tone.hz / FINE_HZ;
        let start = TAU * tone.hz * grid.start_s() + tone.phase;
        // Rotated from sample to sample, and set anew now and then so that nothing piles up.
        for (chunk, values) in all.chunks_mut(1000).enumerate() {
            let angle = start + turn * 1000.0 * chunk as f64;
            let (mut sin, mut cos) = libm::sincos(angle);
            let (step_sin, step_cos) = libm::sincos(turn);
            for value in values {
                *value += tone.amplitude * sin;
                (sin, cos) = (sin * step_cos + cos * step_sin, cos * step_cos - sin * step_sin);
            }
        }
    }
    all
}

/// Root of half the sum of the squared amplitudes.
pub(super) fn rms(tones: &[Tone]) -> f64 {
    (0.5 * tones.iter().map(|tone| tone.amplitude * tone.amplitude).sum::<f64>()).sqrt()
}

/// Tones spread evenly over a band, with random phases and amplitudes; their rms is `target`.
pub(super) fn band(hz: [f64; 2], count: usize, target: f64, draw: &mut Random) -> Vec<Tone> {
    let width = (hz[1] - hz[0]) / count as f64;
    let tone = |k: usize, draw: &mut Random| Tone {
        hz: hz[0] + width * (k as f64 + draw.random::<f64>()),
        amplitude: draw.random_range(0.3..1.0),
        phase: draw.random_range(0.0..TAU),
    };
    let tones: Vec<Tone> = (0..count).map(|k| tone(k, draw)).collect();
    let scale = target / rms(&tones);
    tones.into_iter().map(|tone| tone.times(scale)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_is_that_of_the_sines() {
        let grid = Grid::new(500);
        let tones = [Tone { hz: 0.31, amplitude: 2.0, phase: 0.4 }, Tone { hz: 1.7, amplitude: 0.5, phase: -1.0 }];
        let all = sum(&grid, &tones);
        for (value, t) in all.iter().zip(grid.times_s()) {
            let exact: f64 = tones.iter().map(|tone| tone.amplitude * (TAU * tone.hz * t + tone.phase).sin()).sum();
            assert!((value - exact).abs() < 1e-10);
        }
    }
}

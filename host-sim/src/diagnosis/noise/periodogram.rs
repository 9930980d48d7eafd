//! Periodograms of a residual in the windows of its blocks.

use std::ops::Range;

use towmag_fourier::{Complex, Planner};

use super::blocks::Block;
use crate::diagnosis::policy::{RATE_HZ, SPECTRUM_LEAST_LEFT};
use crate::diagnosis::reconstruct::prepared::fill_holes;

/// Half of the rate, Hz: one-sided power densities of white noise are its variance over this.
pub(super) const NYQUIST_HZ: f64 = 0.5 * RATE_HZ;
/// Longest window of a periodogram, rows.
const WINDOW: usize = 512;

/// Periodogram of some rows.
pub(super) struct Periodogram {
    pub(super) rows: Range<usize>,
    pub(super) step_hz: f64,
    /// From 0 Hz on, nT^2/Hz; not a number where too little was left of the noise.
    pub(super) powers: Vec<f64>,
}

impl Periodogram {
    /// Power density of white noise of variance 1, 1/Hz.
    pub(super) const WHITE_NOISE: f64 = 1.0 / NYQUIST_HZ;
}

/// Periodograms of a residual as they were before something was taken out of it.
pub(super) fn periodograms_of_all(residual: &[f64], blocks: &[Block], left: &[Vec<f64>]) -> Vec<Periodogram> {
    let mut all = periodograms(residual, blocks);
    for (periodogram, left) in all.iter_mut().zip(left) {
        let whole = |power: f64, left: f64| if left < SPECTRUM_LEAST_LEFT { f64::NAN } else { power / left };
        periodogram.powers.iter_mut().zip(left).for_each(|(power, left)| *power = whole(*power, *left));
    }
    all
}

/// Periodograms of windows that overlap by half.
pub(super) fn periodograms(residual: &[f64], blocks: &[Block]) -> Vec<Periodogram> {
    let mut planner = Planner::new();
    let (mut all, mut taper) = (Vec::new(), Taper::new(0));
    for block in blocks {
        let values = bridged(block, residual);
        let window = WINDOW.min(values.len());
        if taper.0.len() != window {
            taper = Taper::new(window);
        }
        let count = if values.len() > window { (2 * values.len()).div_ceil(window) - 1 } else { 1 };
        for index in 0..count {
            let start = if count > 1 { (values.len() - window) * index / (count - 1) } else { 0 };
            let first = block.rows.start + start;
            let powers = taper.powers(&values[start..start + window], &mut planner);
            all.push(Periodogram { rows: first..first + window, step_hz: RATE_HZ / window as f64, powers });
        }
    }
    all
}

/// The block's part of a residual, straight lines where a reading is missing: zeros would look like noise.
fn bridged(block: &Block, residual: &[f64]) -> Vec<f64> {
    let mut values = residual[block.rows.clone()].to_vec();
    block.missing.iter().for_each(|&at| values[at] = f64::NAN);
    fill_holes(&mut values);
    values
}

/// Hann's taper of a window.
struct Taper(Vec<f64>);

impl Taper {
    fn new(n: usize) -> Self {
        Self((0..n).map(|k| (std::f64::consts::PI * (k as f64 + 0.5) / n as f64).sin().powi(2)).collect())
    }

    /// One-sided power densities of a window, from 0 Hz to half of the rate: of nT, nT^2/Hz.
    fn powers(&self, values: &[f64], planner: &mut Planner) -> Vec<f64> {
        let n = values.len();
        let power: f64 = self.0.iter().map(|weight| weight * weight).sum();
        let tapered = values.iter().zip(&self.0).map(|(value, weight)| Complex::new(value * weight, 0.0));
        let mut spectrum: Vec<Complex<f64>> = tapered.collect();
        planner.forward(n).process(&mut spectrum);
        let scale = 2.0 / (RATE_HZ * power);
        spectrum[..n / 2 + 1].iter().map(|value| value.norm_sqr() * scale).collect()
    }
}

/// Welch spectrum of a residual, for a picture: Hz and nT^2/Hz. Of the longest windows only.
pub(crate) fn welch(residual: &[f64], blocks: &[Block]) -> Vec<[f64; 2]> {
    welch_of(&periodograms(residual, blocks))
}

pub(super) fn welch_of(all: &[Periodogram]) -> Vec<[f64; 2]> {
    let Some(longest) = all.iter().map(|periodogram| periodogram.powers.len()).max() else { return Vec::new() };
    let of_length: Vec<_> = all.iter().filter(|periodogram| periodogram.powers.len() == longest).collect();
    (1..longest)
        .map(|k| {
            let mean = of_length.iter().map(|periodogram| periodogram.powers[k]).sum::<f64>() / of_length.len() as f64;
            [k as f64 * of_length[0].step_hz, mean]
        })
        .collect()
}

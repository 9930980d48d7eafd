//! The noise of a residual as a smooth spectrum, blind to lines and bursts, and as an autocovariance.

use std::ops::Range;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::reconstruct::prepared::fill_holes;

/// Rows per second.
const RATE_HZ: f64 = 10.0;
/// Longest window, rows.
const WINDOW: usize = 512;
/// Length of the transform that makes the autocovariance.
const DENSE: usize = 2048;
/// Below this the background has taken power away, Hz.
const LOWEST_HZ: f64 = 0.075;
/// Rounds in which known noise is taken out.
const ROUNDS: usize = 25;
/// Ratio of the edges of a band.
const BAND_RATIO: f64 = 1.35;

/// A smooth spectrum: logarithms of power at logarithms of frequency, straight lines between.
#[derive(Clone, Debug)]
pub(crate) struct Spectrum {
    knots: Vec<(f64, f64)>,
}

impl Spectrum {
    /// Of a residual over the rows, one-sided, nT^2/Hz. `None` when there is nothing to estimate it from.
    pub(crate) fn of(residual: &[f64], blocks: &[Block]) -> Option<Self> {
        Self::smooth(&periodograms(residual, blocks))
    }

    /// The same without independent noise that is known to be in each row, `row_variance` nT^2; `self` is what was known
    /// before of the rest.
    ///
    /// A row counts the less the louder it is: what a fit leaves there is no guide to the noise of the others.
    pub(crate) fn without(self, residual: &[f64], blocks: &[Block], row_variance: &[f64]) -> Self {
        let own = self.autocovariance()[0];
        let weights: Vec<f64> = row_variance.iter().map(|added| own / (own + added)).collect();
        let weighted: Vec<f64> = residual.iter().zip(&weights).map(|(x, weight)| x * weight.sqrt()).collect();
        let known: Vec<f64> = row_variance.iter().zip(&weights).map(|(added, weight)| added * weight).collect();
        let pieces = periodograms(&weighted, blocks);
        let mean = |values: &[f64], rows: &Range<usize>| values[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
        let mut spectrum = self;
        // Each power is exponential about the sum of both: scaled to the one without, again and again.
        for _ in 0..ROUNDS {
            let alone = |piece: &Piece| {
                let (added, kept) = (mean(&known, &piece.rows) / (0.5 * RATE_HZ), mean(&weights, &piece.rows));
                let share = |k: usize| {
                    let alone = spectrum.at(k as f64 * piece.step_hz);
                    alone / (kept * alone + added)
                };
                let powers = piece.powers.iter().enumerate().map(|(k, power)| power * share(k)).collect();
                Piece { rows: piece.rows.clone(), step_hz: piece.step_hz, powers }
            };
            let Some(next) = Self::smooth(&pieces.iter().map(alone).collect::<Vec<_>>()) else { break };
            spectrum = next;
        }
        spectrum
    }

    fn smooth(pieces: &[Piece]) -> Option<Self> {
        let mut knots = Vec::new();
        let mut low_hz = LOWEST_HZ;
        while low_hz < 0.5 * RATE_HZ {
            // The last band takes what would be less than a band of its own.
            let high_hz = if low_hz * BAND_RATIO * 1.1 > 0.5 * RATE_HZ { 5.01 } else { low_hz * BAND_RATIO };
            let mut powers: Vec<f64> = Vec::new();
            let (mut sum_log_hz, mut count) = (0.0, 0.0);
            for piece in pieces {
                for (k, &power) in piece.powers.iter().enumerate() {
                    let hz = k as f64 * piece.step_hz;
                    if hz >= low_hz && hz < high_hz {
                        powers.push(power);
                        sum_log_hz += hz.ln();
                        count += 1.0;
                    }
                }
            }
            if powers.len() >= 8 {
                powers.sort_by(f64::total_cmp);
                let level = location(&powers);
                if level > 0.0 && level.is_finite() {
                    knots.push((sum_log_hz / count, level.ln()));
                }
            }
            low_hz = high_hz;
        }
        (knots.len() >= 3).then_some(Self { knots })
    }

    /// Power at a frequency, nT^2/Hz. Below the first band it goes on with the slope there, never steeper than 1/f^2
    /// nor falling towards 0 Hz.
    pub(crate) fn at(&self, hz: f64) -> f64 {
        let x = hz.max(0.02).ln();
        let knots = &self.knots;
        let first = knots[0];
        if x <= first.0 {
            let other = knots[(knots.len() - 1).min(3)];
            let slope = ((other.1 - first.1) / (other.0 - first.0)).clamp(-2.0, 0.0);
            return (first.1 + slope * (x - first.0)).exp();
        }
        let next = knots.iter().position(|knot| knot.0 >= x);
        let Some(next) = next else { return knots[knots.len() - 1].1.exp() };
        let (a, b) = (knots[next - 1], knots[next]);
        (a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0)).exp()
    }

    /// Autocovariance of the noise, nT^2, lag 0 first.
    pub(crate) fn autocovariance(&self) -> Vec<f64> {
        let mut powers: Vec<Complex<f64>> = (0..DENSE)
            .map(|k| {
                let hz = k.min(DENSE - k) as f64 * RATE_HZ / DENSE as f64;
                Complex::new(self.at(hz) * 0.5 * RATE_HZ, 0.0)
            })
            .collect();
        FftPlanner::new().plan_fft_inverse(DENSE).process(&mut powers);
        powers[..DENSE / 8].iter().map(|value| value.re / DENSE as f64).collect()
    }

    /// Standard deviation from 0.04 to 5 Hz, nT.
    pub(crate) fn std_nt(&self) -> f64 {
        let steps = 500;
        let step_hz = (5.0 - 0.04) / f64::from(steps);
        (0..steps).map(|k| self.at(0.04 + (f64::from(k) + 0.5) * step_hz) * step_hz).sum::<f64>().sqrt()
    }
}

/// Mean of exponential variables, a tenth of which may be anything larger: from their lower 70 %.
fn location(sorted: &[f64]) -> f64 {
    const SHARE: f64 = 0.7;
    let kept = ((sorted.len() as f64 * SHARE).round() as usize).clamp(1, sorted.len());
    // Mean of an exponential variable below its quantile q: 1 + (1 - q) ln(1 - q) / q of the mean.
    let share = kept as f64 / sorted.len() as f64;
    let part = if share < 1.0 { 1.0 + (1.0 - share) * (1.0 - share).ln() / share } else { 1.0 };
    sorted[..kept].iter().sum::<f64>() / kept as f64 / part
}

/// Periodogram of some rows.
struct Piece {
    rows: Range<usize>,
    step_hz: f64,
    /// From 0 Hz on, nT^2/Hz.
    powers: Vec<f64>,
}

/// Periodograms of windows that overlap by half.
fn periodograms(residual: &[f64], blocks: &[Block]) -> Vec<Piece> {
    let mut planner = FftPlanner::new();
    let mut pieces = Vec::new();
    for block in blocks {
        let values = bridged(block, residual);
        let window = WINDOW.min(values.len());
        let count = if values.len() > window { (2 * values.len()).div_ceil(window) - 1 } else { 1 };
        for piece in 0..count {
            let start = if count > 1 { (values.len() - window) * piece / (count - 1) } else { 0 };
            let first = block.rows.start + start;
            let powers = periodogram(&values[start..start + window], &mut planner);
            pieces.push(Piece { rows: first..first + window, step_hz: RATE_HZ / window as f64, powers });
        }
    }
    pieces
}

/// The block's part of a residual, straight lines where a reading is missing: zeros would look like noise.
fn bridged(block: &Block, residual: &[f64]) -> Vec<f64> {
    let mut values = residual[block.rows.clone()].to_vec();
    block.missing.iter().for_each(|&at| values[at] = f64::NAN);
    fill_holes(&mut values);
    values
}

fn periodogram(values: &[f64], planner: &mut FftPlanner<f64>) -> Vec<f64> {
    let n = values.len();
    let taper = |k: usize| (std::f64::consts::PI * (k as f64 + 0.5) / n as f64).sin().powi(2);
    let power: f64 = (0..n).map(|k| taper(k) * taper(k)).sum();
    let mut spectrum: Vec<Complex<f64>> = (0..n).map(|k| Complex::new(values[k] * taper(k), 0.0)).collect();
    planner.plan_fft_forward(n).process(&mut spectrum);
    let scale = 2.0 / (RATE_HZ * power);
    spectrum[..n / 2 + 1].iter().map(|value| value.norm_sqr() * scale).collect()
}

/// Welch spectrum of a residual, for a picture: Hz and nT^2/Hz.
pub(crate) fn welch(residual: &[f64], blocks: &[Block]) -> Vec<[f64; 2]> {
    let pieces = periodograms(residual, blocks);
    let Some(longest) = pieces.iter().map(|piece| piece.powers.len()).max() else { return Vec::new() };
    let of_length: Vec<_> = pieces.iter().filter(|piece| piece.powers.len() == longest).collect();
    (1..longest)
        .map(|k| {
            let mean = of_length.iter().map(|piece| piece.powers[k]).sum::<f64>() / of_length.len() as f64;
            [k as f64 * of_length[0].step_hz, mean]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn white_noise_is_flat_and_a_line_does_not_show() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let noise: Vec<f64> =
            (0..12_000).map(|k| draw() + 3.0 * (std::f64::consts::TAU * 0.123 * f64::from(k)).sin()).collect();
        let blocks: Vec<_> = (0..12).map(|b| Block { rows: b * 1000..(b + 1) * 1000, missing: vec![] }).collect();
        let spectrum = Spectrum::of(&noise, &blocks).expect("enough");
        for hz in [0.1, 0.3, 1.0, 4.0] {
            assert!((spectrum.at(hz) / 0.2 - 1.0).abs() < 0.35, "{hz} Hz: {}", spectrum.at(hz));
        }
        assert!((spectrum.autocovariance()[0] - 1.0).abs() < 0.15);
    }
}

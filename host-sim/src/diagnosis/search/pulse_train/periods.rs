//! Periods whose harmonics stand out of the spectrum of a residual.

use nalgebra::Vector3;

use super::residual::DirectedResidual;
use crate::diagnosis::numerics::median;
use crate::diagnosis::policy::{PULSE_PERIODS_S, PULSE_PERIODS_WITHIN, RATE_HZ};
use crate::diagnosis::search::tone::transform;

/// Numbers of harmonics that are added up: of those that the signal has most of its power in, and of those of the edges of a long
/// pulse, which are alike far up and nearly all that red noise and the background leave of it.
pub(super) const OF_PULSES: &[usize] = &[1, 3, 6, 12];
pub(super) const OF_EDGES: &[usize] = &[40, 100];
/// Periods that are folded, of each number of harmonics.
const FOLDED: usize = 4;
/// Parts of a step of the spectrum in which fundamentals are tried at least: the harmonics multiply what one is off.
const LEAST_PARTS: usize = 4;
/// Mean and median of the power at a frequency: chi-squared with six degrees of freedom.
const MEAN_OF_SIX: f64 = 6.0;
const MEDIAN_OF_SIX: f64 = 5.348;
/// Steps of the spectrum on either side over which its level is taken.
const LEVEL_STEPS: usize = 60;

/// The spectrum of a residual, over the level around each frequency.
pub(super) struct Spectrum {
    step_hz: f64,
    powers: Vec<f64>,
    duration_s: f64,
}

impl Spectrum {
    pub(super) fn of(residual: &DirectedResidual<'_>) -> Self {
        let (step_hz, powers) = powers(residual);
        Self { step_hz, powers: levelled(&powers), duration_s: residual.duration_s() }
    }

    /// Periods whose harmonics stand out, s: the best few by each number of harmonics.
    pub(super) fn periods_s(&self, harmonics: &[usize]) -> Vec<f64> {
        harmonics.iter().flat_map(|&harmonics| self.periods_by_s(harmonics)).collect()
    }

    fn periods_by_s(&self, harmonics: usize) -> Vec<f64> {
        let longest_s = PULSE_PERIODS_S[1].min(self.duration_s / PULSE_PERIODS_WITHIN);
        // All harmonics are below half of the rate.
        let shortest_s = PULSE_PERIODS_S[0].max(2.0 * harmonics as f64 / RATE_HZ);
        let parts = harmonics.max(LEAST_PARTS);
        let part = |period_s: f64| parts as f64 / (period_s * self.step_hz);
        let scored = (part(longest_s).ceil() as usize..part(shortest_s) as usize).map(|part| {
            let fundamental = part as f64 / parts as f64;
            (score(&self.powers, fundamental, harmonics), 1.0 / (fundamental * self.step_hz))
        });
        best_apart(scored.collect(), self.duration_s)
    }
}

/// Step in Hz, and power of the three components of the residual at each frequency below half of the rate: chi-squared
/// with six degrees of freedom where there is noise alone.
fn powers(residual: &DirectedResidual<'_>) -> (f64, Vec<f64>) {
    let component =
        |i: usize| transform(&residual.rows.iter().map(|row| row[i]).collect::<Vec<_>>(), residual.epochs_s());
    let [(step_hz, x), (_, y), (_, z)] = [0, 1, 2].map(component);
    let power = |k: usize| {
        let parts = [Vector3::new(x[k].re, y[k].re, z[k].re), Vector3::new(x[k].im, y[k].im, z[k].im)];
        let squares: f64 = parts.iter().map(|part| residual.explained(*part)).sum();
        2.0 * squares / residual.power_of_sine(k as f64 * step_hz)
    };
    (step_hz, (0..x.len() / 2).map(power).collect())
}

/// Powers over the level around them, where that is above the one of noise: what is broad hides what is sharp.
fn levelled(powers: &[f64]) -> Vec<f64> {
    (0..powers.len())
        .map(|k| {
            let near = &powers[k.saturating_sub(LEVEL_STEPS)..(k + LEVEL_STEPS + 1).min(powers.len())];
            powers[k] / (median(near.to_vec()) / MEDIAN_OF_SIX).max(1.0)
        })
        .collect()
}

/// By how much the first harmonics of a fundamental, in steps of the spectrum, stand out together: of the same spread for
/// any number of them.
fn score(powers: &[f64], fundamental: f64, harmonics: usize) -> f64 {
    let indices = (1..=harmonics).map(|h| (fundamental * h as f64).round() as usize);
    let used: Vec<usize> = indices.take_while(|&k| k < powers.len()).collect();
    let sum: f64 = used.iter().map(|&k| powers[k]).sum();
    (sum - MEAN_OF_SIX * used.len() as f64) / (used.len() as f64).sqrt()
}

/// The periods of the highest scores, none so near to another one that the recording hardly tells them apart.
fn best_apart(mut scored: Vec<(f64, f64)>, duration_s: f64) -> Vec<f64> {
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut taken: Vec<f64> = Vec::new();
    for (_, period_s) in scored {
        if taken.iter().all(|other| (other / period_s - 1.0).abs() > 0.5 * period_s / duration_s) {
            taken.push(period_s);
        }
        if taken.len() == FOLDED {
            break;
        }
    }
    taken
}

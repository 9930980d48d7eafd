//! The noise of a residual as a smooth spectrum, blind to lines and bursts, and as an autocovariance.

use std::ops::Range;

use towmag_fourier::Complex;

use super::blocks::Block;
use super::direction_spectrum::DirectionSpectrum;
use super::levels::Levels;
use super::periodogram::{NYQUIST_HZ, Periodogram, periodograms, periodograms_of_all};
use super::shape::Knot;
use crate::diagnosis::policy::{LEAST_NOISE_NT, RATE_HZ, SPECTRUM_FAR_ABOVE};

/// Length of the transform that makes the autocovariance.
const DENSE: usize = 2048;
/// Rounds in which known noise is taken out.
const ROUNDS: usize = 25;
/// A smooth noise spectrum: logarithms of power density at logarithms of frequency, straight lines between.
#[derive(Clone, Debug)]
pub(crate) struct NoiseSpectrum {
    /// Of all of it, of a sensor's shape.
    levels: Levels,
    /// Where the direction's matters: what a sensor has beside it, and that.
    beside_direction: Option<(Levels, DirectionSpectrum)>,
}

impl NoiseSpectrum {
    /// Of a residual over the rows, nT; one-sided, nT^2/Hz. `left` is what was left of the power of white noise in each
    /// periodogram. `None` when there is nothing to estimate it from.
    pub(crate) fn of(
        residual: &[f64],
        blocks: &[Block],
        left: &[Vec<f64>],
        of_direction: Option<&DirectionSpectrum>,
    ) -> Option<Self> {
        Self::smooth(&periodograms_of_all(residual, blocks, left), of_direction)
    }

    /// Of all that is there most of the time, lines and what follows the motion too: what anything else must stand out of.
    /// In each band from the window than which this share is `quieter`; `None` when there is nothing to estimate it from.
    pub(crate) fn of_all(residual: &[f64], blocks: &[Block], quieter: f64) -> Option<Self> {
        let levels = Levels::of_quieter(&periodograms(residual, blocks), quieter)?;
        Some(Self { levels, beside_direction: None })
    }

    /// The spectrum of a residual without the independent noise that is known to be in each row, of variance
    /// `row_variance`, nT^2; `self` is the estimate to start from.
    ///
    /// Each power is exponentially distributed about the sum of both spectra: it is scaled by the share of the one that is
    /// sought, which is smoothed again, [`ROUNDS`] times. A row counts the less the louder it is: the residual there tells
    /// little of the noise of the other rows.
    pub(crate) fn without(
        self,
        residual: &[f64],
        blocks: &[Block],
        left: &[Vec<f64>],
        row_variance: &[f64],
        of_direction: Option<&DirectionSpectrum>,
    ) -> Self {
        let own = self.autocovariance()[0];
        let weights: Vec<f64> = row_variance.iter().map(|added| own / (own + added)).collect();
        let weighted: Vec<f64> = residual.iter().zip(&weights).map(|(x, weight)| x * weight.sqrt()).collect();
        let known: Vec<f64> = row_variance.iter().zip(&weights).map(|(added, weight)| added * weight).collect();
        let mean = |values: &[f64], rows: &Range<usize>| values[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
        let sums: Vec<Sum> = periodograms_of_all(&weighted, blocks, left)
            .into_iter()
            .map(|both| Sum { known: mean(&known, &both.rows) / NYQUIST_HZ, weight: mean(&weights, &both.rows), both })
            .collect();
        let mut spectrum = self;
        for _ in 0..ROUNDS {
            let sought: Vec<Periodogram> = sums.iter().map(|sum| sum.without_known(&spectrum)).collect();
            let Some(next) = Self::smooth(&sought, of_direction) else { break };
            spectrum = next;
        }
        spectrum
    }

    /// This one, but for the frequencies where another one is far quieter.
    pub(crate) fn where_not_far_above(self, other: &Self) -> Self {
        let levels = not_far_above(self.levels, &other.levels);
        let beside_direction = match (self.beside_direction, &other.beside_direction) {
            (Some((own, of_direction)), Some((other, _))) => Some((not_far_above(own, other), of_direction)),
            (own, _) => own,
        };
        Self { levels, beside_direction }
    }

    fn smooth(periodograms: &[Periodogram], of_direction: Option<&DirectionSpectrum>) -> Option<Self> {
        let levels = Levels::of(periodograms)?;
        let beside_direction = of_direction.and_then(|all| all.in_residual(&levels)).map(|of_direction| {
            let beside = |knot: Knot| knot.without(of_direction.in_band(knot.log_hz.exp()));
            (levels.clone().changed(beside).of_a_sensor(), of_direction)
        });
        Some(Self { levels: levels.of_a_sensor(), beside_direction })
    }

    /// Power at a frequency, nT^2/Hz. The direction's adds to what a sensor may have, and takes nothing away.
    pub(crate) fn at(&self, hz: f64) -> f64 {
        let all = self.levels.at(hz);
        self.beside_direction
            .as_ref()
            .map_or(all, |(beside, of_direction)| all.max(beside.at(hz) + of_direction.at(hz)))
    }

    /// Autocovariance of the noise, nT^2, lag 0 first, with the least that every sensor has: where known noise is told to be all there
    /// is, or a filter of the sensor's leaves a band empty, nothing is predicted better than that.
    pub(crate) fn autocovariance(&self) -> Vec<f64> {
        let mut powers: Vec<Complex<f64>> = (0..DENSE)
            .map(|k| {
                let hz = k.min(DENSE - k) as f64 * RATE_HZ / DENSE as f64;
                Complex::new(self.at(hz) * 0.5 * RATE_HZ, 0.0)
            })
            .collect();
        towmag_fourier::inverse(DENSE).process(&mut powers);
        let mut autocovariance: Vec<f64> = powers[..DENSE / 8].iter().map(|value| value.re / DENSE as f64).collect();
        autocovariance[0] += LEAST_NOISE_NT.powi(2);
        autocovariance
    }

    /// Standard deviation from 0.04 to 5 Hz, nT, with the least that every sensor has.
    pub(crate) fn std_nt(&self) -> f64 {
        let steps = 500;
        let step_hz = (NYQUIST_HZ - 0.04) / f64::from(steps);
        let power = (0..steps).map(|k| self.at(0.04 + (f64::from(k) + 0.5) * step_hz) * step_hz).sum::<f64>();
        power.sqrt().hypot(LEAST_NOISE_NT)
    }
}

/// Levels that go down to others where those are far lower.
fn not_far_above(levels: Levels, other: &Levels) -> Levels {
    let lower = |knot: Knot| {
        let other = other.at(knot.log_hz.exp()).ln();
        let is_far_above = knot.log_power > other + SPECTRUM_FAR_ABOVE.ln();
        Knot { log_power: if is_far_above { other } else { knot.log_power }, ..knot }
    };
    levels.changed(lower).of_a_sensor()
}

/// A periodogram of weighted rows that holds white noise of known power beside the noise that is sought.
struct Sum {
    both: Periodogram,
    /// Power density of the known noise as weighted, nT^2/Hz.
    known: f64,
    /// Mean weight of the rows: what the weights leave of the power that is sought.
    weight: f64,
}

impl Sum {
    /// Each power scaled to the share of the sought noise, if that has `spectrum`, and without the weights.
    fn without_known(&self, spectrum: &NoiseSpectrum) -> Periodogram {
        let Periodogram { rows, step_hz, powers } = &self.both;
        let share = |k: usize| {
            let sought = spectrum.at(k as f64 * step_hz);
            sought / (self.weight * sought + self.known)
        };
        let powers = powers.iter().enumerate().map(|(k, power)| power * share(k)).collect();
        Periodogram { rows: rows.clone(), step_hz: *step_hz, powers }
    }
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
        let blocks: Vec<_> =
            (0..12).map(|b| Block { rows: b * 1000..(b + 1) * 1000, missing: vec![], targets: vec![] }).collect();
        let spectrum = NoiseSpectrum::of(&noise, &blocks, &[], None).expect("enough");
        for hz in [0.1, 0.3, 1.0, 4.0] {
            assert!((spectrum.at(hz) / 0.2 - 1.0).abs() < 0.35, "{hz} Hz: {}", spectrum.at(hz));
        }
        assert!((spectrum.autocovariance()[0] - 1.0).abs() < 0.15);
    }
}

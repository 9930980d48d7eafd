//! The noise of a residual as a smooth spectrum, blind to lines and bursts, and as an autocovariance.

use std::ops::Range;

use statrs::distribution::{ContinuousCDF, Normal};
use towmag_fourier::{Complex, Planner};

use super::shape::{self, Knot};
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::policy::{
    LEAST_NOISE_NT, RATE_HZ, SPECTRUM_FAR_ABOVE, SPECTRUM_LEAST_LEFT, SPECTRUM_LEAST_POWERS, SPECTRUM_LOWEST_HZ,
    SPECTRUM_MOST_RATIO, SPECTRUM_TRUSTED_SHARE,
};
use crate::diagnosis::reconstruct::prepared::fill_holes;

/// Half of the rate, Hz: one-sided power densities of white noise are its variance over this.
const NYQUIST_HZ: f64 = 0.5 * RATE_HZ;
/// Longest window of a periodogram, rows.
const WINDOW: usize = 512;
/// Length of the transform that makes the autocovariance.
const DENSE: usize = 2048;
/// Rounds in which known noise is taken out.
const ROUNDS: usize = 25;
/// Ratio of the edges of a band.
const BAND_RATIO: f64 = 1.35;
/// What a quantile of the power of few frequencies is at least, over its mean.
const LEAST_QUANTILE: f64 = 0.2;
/// Powers that tell a level as well as one independent one: windows overlap by half, Hann's taper smears one frequency over its
/// neighbours, and the largest are not counted. A test draws them.
const POWERS_PER_INDEPENDENT: f64 = 3.0;
/// Bands that a spectrum needs: the slope towards 0 Hz is taken over several.
const LEAST_BANDS: usize = 3;

/// A smooth noise spectrum: logarithms of power density at logarithms of frequency, straight lines between.
#[derive(Clone, Debug)]
pub(crate) struct NoiseSpectrum {
    /// By frequency, ascending.
    knots: Vec<Knot>,
}

impl NoiseSpectrum {
    /// Of a residual over the rows, nT; one-sided, nT^2/Hz. `left` is what was left of the power of white noise in each
    /// periodogram. `None` when there is nothing to estimate it from.
    pub(crate) fn of(residual: &[f64], blocks: &[Block], left: &[Vec<f64>]) -> Option<Self> {
        Self::smooth(&periodograms_of_all(residual, blocks, left))
    }

    /// Of all that is there most of the time, lines and what follows the motion too: what anything else must stand out of.
    /// In each band from the window than which this share is `quieter`; `None` when there is nothing to estimate it from.
    pub(crate) fn of_all(residual: &[f64], blocks: &[Block], quieter: f64) -> Option<Self> {
        let periodograms = periodograms(residual, blocks);
        let knot = |band_hz| quantile_knot(&periodograms, band_hz, quieter);
        let knots: Vec<Knot> = bands_hz().filter_map(knot).collect();
        (knots.len() >= LEAST_BANDS).then_some(Self { knots })
    }

    /// The spectrum of a residual without the independent noise that is known to be in each row, of variance
    /// `row_variance`, nT^2; `self` is the estimate to start from.
    ///
    /// Each power is exponentially distributed about the sum of both spectra: it is scaled by the share of the one that is
    /// sought, which is smoothed again, [`ROUNDS`] times. A row counts the less the louder it is: the residual there tells
    /// little of the noise of the other rows.
    pub(crate) fn without(self, residual: &[f64], blocks: &[Block], left: &[Vec<f64>], row_variance: &[f64]) -> Self {
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
            let Some(next) = Self::smooth(&sought) else { break };
            spectrum = next;
        }
        spectrum
    }

    /// This one, but for the frequencies where another one is far quieter.
    pub(crate) fn where_not_far_above(self, other: &Self) -> Self {
        let lower = |knot: Knot| {
            let other = other.at(knot.log_hz.exp()).ln();
            let is_far_above = knot.log_power > other + SPECTRUM_FAR_ABOVE.ln();
            Knot { log_power: if is_far_above { other } else { knot.log_power }, ..knot }
        };
        Self { knots: self.knots.into_iter().map(lower).collect() }.of_a_sensor()
    }

    fn smooth(periodograms: &[Periodogram]) -> Option<Self> {
        let knots: Vec<Knot> = bands_hz().filter_map(|band_hz| knot(periodograms, band_hz)).collect();
        (knots.len() >= LEAST_BANDS).then(|| Self { knots }.of_a_sensor())
    }

    /// Of no other shape than a sensor's, and no louder anywhere than that is beside its quietest band: what is, is a gap, however
    /// long it lasts.
    fn of_a_sensor(self) -> Self {
        let mut noise = Self { knots: shape::of_noise(&self.knots) };
        let most = noise.most();
        noise.knots.iter_mut().for_each(|knot| knot.log_power = knot.log_power.min(most));
        noise
    }

    /// Logarithm of the largest power density that is taken for noise.
    fn most(&self) -> f64 {
        self.knots.iter().map(|knot| knot.log_power).fold(f64::INFINITY, f64::min) + SPECTRUM_MOST_RATIO.ln()
    }

    /// Power at a frequency, nT^2/Hz. Below the first band it goes on with the slope there, never steeper than 1/f^2
    /// nor falling towards 0 Hz.
    pub(crate) fn at(&self, hz: f64) -> f64 {
        let x = hz.max(0.02).ln();
        let knots = &self.knots;
        let first = knots[0];
        let slope = |a: Knot, b: Knot| (b.log_power - a.log_power) / (b.log_hz - a.log_hz);
        if x <= first.log_hz {
            let slope = slope(first, knots[(knots.len() - 1).min(3)]).clamp(-2.0, 0.0);
            return (first.log_power + slope * (x - first.log_hz)).min(self.most().max(first.log_power)).exp();
        }
        let next = knots.iter().position(|knot| knot.log_hz >= x);
        let Some(next) = next else { return knots[knots.len() - 1].log_power.exp() };
        let (a, b) = (knots[next - 1], knots[next]);
        (a.log_power + slope(a, b) * (x - a.log_hz)).exp()
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

/// Edges of the bands that a spectrum is smoothed over, Hz, ascending; the last one reaches beyond half of the rate.
fn bands_hz() -> impl Iterator<Item = [f64; 2]> {
    let mut low_hz = SPECTRUM_LOWEST_HZ;
    std::iter::from_fn(move || {
        if low_hz >= NYQUIST_HZ {
            return None;
        }
        // The last band takes what would be less than a band of its own.
        let is_last = low_hz * BAND_RATIO * 1.1 > NYQUIST_HZ;
        let band_hz = [low_hz, if is_last { 1.002 * NYQUIST_HZ } else { low_hz * BAND_RATIO }];
        low_hz = band_hz[1];
        Some(band_hz)
    })
}

/// Frequencies and powers of a periodogram in a band, Hz.
fn in_band(periodogram: &Periodogram, [low_hz, high_hz]: [f64; 2]) -> impl Iterator<Item = (f64, f64)> {
    let at = move |(k, power): (usize, &f64)| (k as f64 * periodogram.step_hz, *power);
    periodogram.powers.iter().enumerate().map(at).filter(move |(hz, _)| (low_hz..high_hz).contains(hz))
}

/// The level of one band; `None` where there are too few powers.
fn knot(periodograms: &[Periodogram], band_hz: [f64; 2]) -> Option<Knot> {
    let mut powers: Vec<f64> = Vec::new();
    let mut sum_log_hz = 0.0;
    let inside = periodograms.iter().flat_map(|periodogram| in_band(periodogram, band_hz));
    for (hz, power) in inside.filter(|(_, power)| power.is_finite()) {
        powers.push(power);
        sum_log_hz += hz.ln();
    }
    if powers.len() < SPECTRUM_LEAST_POWERS {
        return None;
    }
    powers.sort_by(f64::total_cmp);
    let level = trimmed_mean(&powers);
    level_knot(level, sum_log_hz, powers.len())
}

/// Of the mean level of so many powers.
fn level_knot(level: f64, sum_log_hz: f64, count: usize) -> Option<Knot> {
    let count = count as f64;
    let error = (POWERS_PER_INDEPENDENT / count).sqrt();
    let knot = || Knot { log_hz: sum_log_hz / count, log_power: level.ln(), error };
    (level > 0.0 && level.is_finite()).then(knot)
}

/// The same of one band, from the window than which a share is quieter.
fn quantile_knot(periodograms: &[Periodogram], band_hz: [f64; 2], quieter: f64) -> Option<Knot> {
    let (mut means, mut sum_log_hz, mut count): (Vec<f64>, _, _) = (Vec::new(), 0.0, 0);
    for periodogram in periodograms {
        let inside: Vec<(f64, f64)> = in_band(periodogram, band_hz).collect();
        if inside.is_empty() {
            continue;
        }
        means.push(inside.iter().map(|(_, power)| power).sum::<f64>() / inside.len() as f64);
        sum_log_hz += inside.iter().map(|(hz, _)| hz.ln()).sum::<f64>();
        count += inside.len();
    }
    if count < SPECTRUM_LEAST_POWERS {
        return None;
    }
    means.sort_by(f64::total_cmp);
    let quiet = means[((means.len() - 1) as f64 * quieter).round() as usize];
    // Where a quantile of the mean of so many exponential variables lies (Wilson and Hilferty, 1931).
    let ninth = means.len() as f64 / (9.0 * count as f64);
    let level =
        quiet / (1.0 - ninth + Normal::standard().inverse_cdf(quieter) * ninth.sqrt()).powi(3).max(LEAST_QUANTILE);
    level_knot(level, sum_log_hz, count)
}

/// Mean of exponential variables, sorted, of which a minority may be anything larger: from the lower ones.
fn trimmed_mean(sorted: &[f64]) -> f64 {
    let count = ((sorted.len() as f64 * SPECTRUM_TRUSTED_SHARE).round() as usize).clamp(1, sorted.len());
    // Mean of an exponential variable below its quantile q: 1 + (1 - q) ln(1 - q) / q of the mean.
    let q = count as f64 / sorted.len() as f64;
    let bias = if q < 1.0 { 1.0 + (1.0 - q) * (1.0 - q).ln() / q } else { 1.0 };
    sorted[..count].iter().sum::<f64>() / count as f64 / bias
}

/// Periodogram of some rows.
pub(super) struct Periodogram {
    rows: Range<usize>,
    step_hz: f64,
    /// From 0 Hz on, nT^2/Hz; not a number where too little was left of the noise.
    pub(super) powers: Vec<f64>,
}

impl Periodogram {
    /// Power density of white noise of variance 1, 1/Hz.
    pub(super) const WHITE_NOISE: f64 = 1.0 / NYQUIST_HZ;
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

/// Periodograms of a residual as they were before something was taken out of it.
fn periodograms_of_all(residual: &[f64], blocks: &[Block], left: &[Vec<f64>]) -> Vec<Periodogram> {
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
    let all = periodograms(residual, blocks);
    let Some(longest) = all.iter().map(|periodogram| periodogram.powers.len()).max() else { return Vec::new() };
    let of_length: Vec<_> = all.iter().filter(|periodogram| periodogram.powers.len() == longest).collect();
    (1..longest)
        .map(|k| {
            let mean = of_length.iter().map(|periodogram| periodogram.powers[k]).sum::<f64>() / of_length.len() as f64;
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
        let blocks: Vec<_> =
            (0..12).map(|b| Block { rows: b * 1000..(b + 1) * 1000, missing: vec![], targets: vec![] }).collect();
        let spectrum = NoiseSpectrum::of(&noise, &blocks, &[]).expect("enough");
        for hz in [0.1, 0.3, 1.0, 4.0] {
            assert!((spectrum.at(hz) / 0.2 - 1.0).abs() < 0.35, "{hz} Hz: {}", spectrum.at(hz));
        }
        assert!((spectrum.autocovariance()[0] - 1.0).abs() < 0.15);
    }

    #[test]
    fn levels_of_white_noise_are_off_by_their_errors() {
        let blocks: Vec<_> =
            (0..8).map(|b| Block { rows: b * 300..(b + 1) * 300, missing: vec![], targets: vec![] }).collect();
        let mut squares = vec![0.0; 14];
        for seed in 0..60 {
            let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
            let noise: Vec<f64> = (0..2400).map(|_| StandardNormal.sample(&mut random)).collect();
            let knots: Vec<Knot> =
                bands_hz().filter_map(|band_hz| knot(&periodograms(&noise, &blocks), band_hz)).collect();
            let off = |knot: &Knot| ((knot.log_power - 0.2_f64.ln()) / knot.error).powi(2) / 60.0;
            squares.iter_mut().zip(&knots).for_each(|(sum, knot)| *sum += off(knot));
        }
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        assert!((0.5..1.2).contains(&mean), "{mean} {squares:?}");
    }
}

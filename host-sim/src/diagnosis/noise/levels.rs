//! The levels of a spectrum in bands, each wider than the one below: blind to lines and bursts.

use statrs::distribution::{ContinuousCDF, Normal};

use super::periodogram::{NYQUIST_HZ, Periodogram};
use super::shape::{self, Knot};
use crate::diagnosis::policy::{
    SPECTRUM_LEAST_POWERS, SPECTRUM_LOWEST_HZ, SPECTRUM_MOST_RATIO, SPECTRUM_TRUSTED_SHARE,
};

/// Ratio of the edges of a band.
const BAND_RATIO: f64 = 1.35;
/// What a quantile of the power of few frequencies is at least, over its mean.
const LEAST_QUANTILE: f64 = 0.2;
/// Powers that tell a level as well as one independent one: windows overlap by half, Hann's taper smears one frequency over its
/// neighbours, and the largest are not counted. A test draws them.
const POWERS_PER_INDEPENDENT: f64 = 3.0;
/// Bands that a spectrum needs: the slope towards 0 Hz is taken over several.
const LEAST_BANDS: usize = 3;

/// Logarithms of power density at logarithms of frequency, ascending; straight lines between.
#[derive(Clone, Debug)]
pub(super) struct Levels(Vec<Knot>);

impl Levels {
    /// Of most of the powers in each band; `None` where there are too few.
    pub(super) fn of(periodograms: &[Periodogram]) -> Option<Self> {
        Self::by(|band_hz| knot(periodograms, band_hz))
    }

    /// Of all of them, in each band from the window than which this share is `quieter`.
    pub(super) fn of_quieter(periodograms: &[Periodogram], quieter: f64) -> Option<Self> {
        Self::by(|band_hz| quantile_knot(periodograms, band_hz, quieter))
    }

    fn by(knot: impl Fn([f64; 2]) -> Option<Knot>) -> Option<Self> {
        let knots: Vec<Knot> = bands_hz().filter_map(knot).collect();
        (knots.len() >= LEAST_BANDS).then_some(Self(knots))
    }

    /// Frequency, Hz, and power density, nT^2/Hz, of each band.
    pub(super) fn densities(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.0.iter().map(|knot| (knot.log_hz.exp(), knot.log_power.exp()))
    }

    /// With each band changed.
    pub(super) fn changed(self, change: impl Fn(Knot) -> Knot) -> Self {
        Self(self.0.into_iter().map(change).collect())
    }

    /// Of no other shape than a sensor's, and no louder anywhere than that is beside its quietest band: what is, is a gap, however
    /// long it lasts.
    pub(super) fn of_a_sensor(self) -> Self {
        let noise = Self(shape::of_noise(&self.0));
        let most = noise.most();
        noise.changed(|knot| Knot { log_power: knot.log_power.min(most), ..knot })
    }

    /// Logarithm of the largest power density that is taken for noise.
    fn most(&self) -> f64 {
        self.0.iter().map(|knot| knot.log_power).fold(f64::INFINITY, f64::min) + SPECTRUM_MOST_RATIO.ln()
    }

    /// Power at a frequency, nT^2/Hz. Below the first band it goes on with the slope there, never steeper than 1/f^2
    /// nor falling towards 0 Hz.
    pub(super) fn at(&self, hz: f64) -> f64 {
        let x = hz.max(0.02).ln();
        let knots = &self.0;
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

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::diagnosis::noise::blocks::Block;
    use crate::diagnosis::noise::periodogram::periodograms;

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

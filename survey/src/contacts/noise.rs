//! The noise that contacts are told from: its spectrum, and how its power in each band changes with time.

use rayon::prelude::*;
use towmag_fourier::Complex;

use super::bands::{self, BANDS, Powers};
use super::levelled::RATE_HZ;
use super::spectrum::Spectrum;
use super::stretch::Stretch;
use super::whitening::{Transform, Whitener};
use crate::statistics::{bell_sums, median};

/// Rounds in which the spectrum is corrected by what its whitening leaves: the first takes off the steep part, so that no power
/// leaks in the second; the third changes it by less than a tenth.
const ROUNDS: usize = 3;
/// Cells between the times at which the powers are given.
pub(super) const NODE: usize = 50;
/// Powers in time are means over this at least, s: a turn is no shorter.
const LEAST_MEAN_S: f64 = 45.0;
/// And over at least so many independent values in the band (half the degrees of freedom), so that their own scatter stays
/// below one third.
const LEAST_VALUES: f64 = 8.0;
/// Squares beyond so many variances are cut while targets are not known yet, or not fitted well.
const CUT: f64 = 12.0;
/// No band is quieter than this share of its mean: of so few values that would be chance.
const LEAST_POWER: f64 = 0.2;
/// Steps of the mean over frequency: a hundredth of a hertz each.
const LN_STEPS: usize = 500;
/// Band of the noise floor, Hz.
const FLOOR_HZ: [f64; 2] = [0.1, 0.9];

/// The noise of a recording.
#[derive(Clone, Debug)]
pub struct Noise {
    pub(super) spectrum: Spectrum,
    /// For each stretch the powers of the bands relative to the spectrum, one every [`NODE`] cells.
    pub(super) powers: Vec<Vec<Powers>>,
    /// For each stretch its rows of the recording, a cell each.
    rows: Vec<Vec<Option<usize>>>,
}

impl Noise {
    /// Of what is left beside the targets that are known. `is_first`: none are known yet, so what stands out is cut.
    /// `is_cut`: what is loud for a while is a contact that is not fitted well, not noise.
    pub(super) fn measured(stretches: &[Stretch], transforms: &[Transform], is_first: bool, is_cut: bool) -> Self {
        let spectrum = spectrum(stretches, transforms, is_first, is_cut);
        let pairs: Vec<_> = stretches.iter().zip(transforms).collect();
        let powers = |(stretch, transform): &(&Stretch, &Transform)| {
            let in_bands = Whitener::new(transform, &spectrum).in_bands(&stretch.values);
            powers(stretch, &in_bands, if is_first || is_cut { CUT } else { f64::INFINITY })
        };
        let powers = pairs.iter().map(powers).collect();
        let rows = stretches.iter().map(|stretch| stretch.rows.clone()).collect();
        Self { spectrum, powers, rows }
    }

    /// Powers of the bands at a cell of a stretch.
    pub(super) fn powers_at(&self, stretch: usize, cell: usize) -> Powers {
        let nodes = &self.powers[stretch];
        let place = (cell as f64 / NODE as f64 - 0.5).clamp(0.0, (nodes.len() - 1) as f64);
        let (below, above) = (place as usize, (place as usize + 1).min(nodes.len() - 1));
        let share = place - below as f64;
        std::array::from_fn(|band| (1.0 - share) * nodes[below][band] + share * nodes[above][band])
    }

    /// Powers of the bands at a row; `None` where none are known at all.
    pub(super) fn powers_near(&self, row: usize) -> Option<Powers> {
        let first = |rows: &Vec<Option<usize>>| rows.iter().flatten().next().copied();
        let stretch = self.rows.iter().rposition(|rows| first(rows).is_some_and(|first| first <= row)).unwrap_or(0);
        let rows = self.rows.get(stretch)?;
        // Cells and rows go up together, but for holes.
        let off = row.saturating_sub(first(rows)?);
        Some(self.powers_at(stretch, off.min(rows.len() - 1)))
    }

    /// Signal to noise of an anomaly about a row, nT every tenth of a second: `sqrt(s' C^-1 s)`.
    pub fn snr(&self, row: usize, anomaly_nt: &[f64]) -> f64 {
        let Some(powers) = self.powers_near(row) else { return 0.0 };
        let length = (2 * anomaly_nt.len()).next_power_of_two();
        let mut values: Vec<Complex<f64>> = anomaly_nt.iter().map(|nt| Complex::new(*nt, 0.0)).collect();
        values.resize(length, Complex::ZERO);
        towmag_fourier::forward(length).process(&mut values);
        let of = |place: usize| {
            let hz = place as f64 * RATE_HZ / length as f64;
            let variance = self.spectrum.variance_at(hz) * bands::factor(&powers, hz);
            2.0 * values[place].norm_sqr() / (length as f64 * variance)
        };
        (1..length / 2).map(of).sum::<f64>().sqrt()
    }

    /// Density of the noise, nT^2/Hz, where the bands have these powers.
    pub(super) fn density(&self, powers: &Powers, hz: f64) -> f64 {
        self.spectrum.at(hz) * bands::factor(powers, hz)
    }

    /// Standard deviation in the band 0.1 to 0.9 Hz where the bands have these powers, nT.
    pub(super) fn floor_nt(&self, powers: &Powers) -> f64 {
        const STEPS: usize = 200;
        let step = (FLOOR_HZ[1] - FLOOR_HZ[0]) / STEPS as f64;
        let sum: f64 = (0..STEPS).map(|k| self.density(powers, FLOOR_HZ[0] + (k as f64 + 0.5) * step)).sum();
        (sum * step).sqrt()
    }

    /// Mean of the logarithm of the density over time and up to half the rate, of nT^2/Hz.
    pub(super) fn mean_ln_density(&self) -> f64 {
        let nodes: Vec<&Powers> = self.powers.iter().flatten().collect();
        let step_hz = 0.5 * RATE_HZ / LN_STEPS as f64;
        let of = |step: usize| {
            let hz = (step as f64 + 0.5) * step_hz;
            let factors = nodes.iter().map(|powers| bands::factor(powers, hz).ln()).sum::<f64>();
            self.spectrum.at(hz).ln() + factors / nodes.len().max(1) as f64
        };
        (0..LN_STEPS).map(of).sum::<f64>() / LN_STEPS as f64
    }

    /// Hours of all stretches.
    pub(crate) fn hours(&self) -> f64 {
        self.rows.iter().map(|rows| rows.len() as f64).sum::<f64>() / (3600.0 * RATE_HZ)
    }

    /// Standard deviation of the noise in the band 0.1 to 0.9 Hz, median over time, nT; `None` if nothing was long enough.
    pub fn median_floor_nt(&self) -> Option<f64> {
        let mut floors: Vec<f64> = self.powers.iter().flatten().map(|powers| self.floor_nt(powers)).collect();
        median(&mut floors)
    }
}

/// The spectrum that whitens all stretches together.
fn spectrum(stretches: &[Stretch], transforms: &[Transform], is_first: bool, is_cut: bool) -> Spectrum {
    let mut spectrum = Spectrum::first();
    for _ in 0..ROUNDS {
        let whitened: Vec<Vec<f64>> = stretches
            .par_iter()
            .zip(transforms)
            .map(|(stretch, transform)| Whitener::new(transform, &spectrum).whitened(&stretch.values))
            .collect();
        spectrum = spectrum.corrected(&whitened.iter().map(Vec::as_slice).collect::<Vec<_>>(), is_first, is_cut);
    }
    spectrum
}

/// Width of a band, Hz: that of a rectangular one of the same power.
fn width_hz(band: usize) -> f64 {
    const STEPS: usize = 2000;
    let step = 0.5 * RATE_HZ / STEPS as f64;
    (0..STEPS).map(|k| bands::share(band, (k as f64 + 0.5) * step)).sum::<f64>() * step
}

/// The powers of whitened series in bands, one every [`NODE`] cells.
fn powers(stretch: &Stretch, in_bands: &[Vec<f64>], cut: f64) -> Vec<Powers> {
    let nodes = stretch.rows.len().div_ceil(NODE);
    let mut out = vec![[1.0; BANDS]; nodes];
    let all: Vec<Vec<f64>> =
        (0..BANDS).into_par_iter().map(|band| band_powers(stretch, &in_bands[band], width_hz(band), cut)).collect();
    for (band, powers) in all.iter().enumerate() {
        out.iter_mut().zip(powers).for_each(|(node, power)| node[band] = *power);
    }
    out
}

fn band_powers(stretch: &Stretch, series: &[f64], width_hz: f64, cut: f64) -> Vec<f64> {
    let mean = width_hz / (0.5 * RATE_HZ);
    let sums: Vec<[f64; 2]> = series
        .chunks(NODE)
        .zip(stretch.rows.chunks(NODE))
        .map(|(values, rows)| {
            let known = values.iter().zip(rows).filter(|(_, row)| row.is_some());
            known.fold([0.0, 0.0], |[sum, count], (x, _)| [sum + (x * x / mean).min(cut), count + 1.0])
        })
        .collect();
    let mean_s = LEAST_MEAN_S.max(LEAST_VALUES / width_hz);
    // A bell of this spread averages over as many values as a rectangle of that length.
    let spread = mean_s * RATE_HZ / NODE as f64 / (2.0 * std::f64::consts::PI.sqrt());
    let smoothed = bell_sums(&sums, spread).map(|[sum, count]| if count > 0.0 { sum / count } else { 1.0 }).collect();
    // Exact for a Gaussian series of that width: the relative variance of a mean square over a time is 1 / (width time).
    shrunk(smoothed, 1.0 / (width_hz * mean_s))
}

/// Powers drawn to their mean by the share of their scatter that chance alone gives (empirical Bayes: Efron and Morris 1973).
fn shrunk(powers: Vec<f64>, chance: f64) -> Vec<f64> {
    let mean = powers.iter().sum::<f64>() / powers.len() as f64;
    let scatter = powers.iter().map(|p| (p / mean - 1.0).powi(2)).sum::<f64>() / powers.len() as f64;
    let kept = ((scatter - chance) / scatter.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    powers.iter().map(|p| (mean + kept * (p - mean)).max(LEAST_POWER * mean)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn mean_logarithm_of_the_density_counts_what_is_loud_for_as_long_as_it_is() {
        let std_nt = 0.1;
        let unit: Vec<f64> = StandardNormal.sample_iter(ChaCha8Rng::seed_from_u64(1)).take(20_000).collect();
        let values: Vec<f64> = unit.iter().map(|x| std_nt * x).collect();
        let measured = |values: Vec<f64>| {
            let stretch = Stretch { rows: (0..values.len()).map(Some).collect(), values };
            let transforms = [Transform::of(stretch.rows.len())];
            Noise::measured(&[stretch], &transforms, false, false).mean_ln_density()
        };
        let white = (2.0 * std_nt * std_nt / RATE_HZ).ln();
        let halves: Vec<f64> = values.iter().enumerate().map(|(k, x)| if k < 10_000 { *x } else { 4.0 * x }).collect();
        let [even, louder] = [measured(values), measured(halves)];
        assert!((even - white).abs() < 0.05, "{even} {white}");
        // Half the time sixteen times the power: half of that logarithm, and less than that of the mean power, where time counts for nothing.
        assert!((0.5 * 16_f64.ln()..8.5_f64.ln() - 0.3).contains(&(louder - white)), "{louder} {white}");
    }
}

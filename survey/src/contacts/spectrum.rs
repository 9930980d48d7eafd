//! The power spectrum of the noise, at places evenly apart in the logarithm of the frequency.

use std::f64::consts::TAU;

use towmag_fourier::Complex;

use super::levelled::RATE_HZ;

/// Lowest frequency at which the spectrum is measured, Hz: one and a half cells of the longest piece. Below, the background is
/// taken to rise as steeply as that of geology seen from a few hundred metres does at most.
const LOWEST_HZ: f64 = 0.004;
const RISE: i32 = 4;
/// Below this it is level, Hz; no target is so slow.
const FLAT_HZ: f64 = 0.0005;
/// Places an octave: the pieces resolve an eighth of a frequency.
const PER_OCTAVE: f64 = 8.0;
/// Lengths of the pieces, rows: for each frequency the longest that has it at cell 16 or before.
const LENGTHS: [usize; 6] = [128, 256, 512, 1024, 2048, 4096];
const LAST_CELL: f64 = 16.0;
/// And where a strong contact may not be fitted well: short ones, so that it is in few of them.
const LAST_CELL_OF_SHORT: f64 = 5.0;
/// Powers beyond so many medians are cut: targets that are not found yet. Of exponential powers that leaves a share of
/// `1 - 2^-5` of the mean.
const CUT_MEDIANS: f64 = 5.0;
const LEFT_BY_CUT: f64 = 1.0 - 1.0 / 32.0;

/// While no target is known the eighth of the pieces with the least power stands for all, an exponential one's quantile. On laps past strong
/// iron few pieces are without it: of 436 dipoles of the trial's seeds 941 to 1040, spent, 407, 410 and 403 are found with a quarter, this and a sixteenth, with 51,
/// 42 and 73 false ones.
const FIRST_QUANTILE: usize = 8;

/// A one-sided power spectral density, nT^2/Hz.
#[derive(Clone, Debug)]
pub(super) struct Spectrum {
    ln_density: Vec<f64>,
}

fn knots() -> usize {
    (PER_OCTAVE * (0.5 * RATE_HZ / LOWEST_HZ).log2()).ceil() as usize + 1
}

fn knot_hz(knot: usize) -> f64 {
    (LOWEST_HZ * (knot as f64 / PER_OCTAVE).exp2()).min(0.5 * RATE_HZ)
}

impl Spectrum {
    /// A first guess of the shape: white above a twentieth of a hertz, red below.
    pub(super) fn first() -> Self {
        Self { ln_density: (0..knots()).map(|k| (1.0 + (0.05 / knot_hz(k)).powi(RISE)).ln()).collect() }
    }

    /// Variance of white noise at 10 Hz of the density at a frequency, nT^2.
    pub(super) fn variance_at(&self, hz: f64) -> f64 {
        0.5 * RATE_HZ * self.at(hz)
    }

    /// Density at a frequency, nT^2/Hz.
    pub(super) fn at(&self, hz: f64) -> f64 {
        if hz < LOWEST_HZ {
            return self.ln_density[0].exp() * (LOWEST_HZ / hz.max(FLAT_HZ)).powi(RISE);
        }
        let place = ((hz / LOWEST_HZ).log2() * PER_OCTAVE).min((self.ln_density.len() - 1) as f64);
        let below = (place as usize).min(self.ln_density.len() - 2);
        let share = place - below as f64;
        ((1.0 - share) * self.ln_density[below] + share * self.ln_density[below + 1]).exp()
    }

    /// This one times what pieces of a series have that was whitened by it; `is_first`: with targets in it; `is_cut`: with some that
    /// are not fitted well.
    pub(super) fn corrected(&self, whitened: &[&[f64]], is_first: bool, is_cut: bool) -> Self {
        let last_cell = if is_cut { LAST_CELL_OF_SHORT } else { LAST_CELL };
        let periodograms: Vec<Periodogram> =
            LENGTHS.iter().map(|&rows| Periodogram::of(whitened, rows, is_first)).collect();
        let correction = |knot: usize| {
            let hz = knot_hz(knot);
            let fits = |p: &&Periodogram| p.count > 0 && hz * p.rows as f64 / RATE_HZ <= last_cell;
            let chosen = periodograms.iter().rfind(fits).or_else(|| periodograms.iter().find(|p| p.count > 0));
            chosen.map_or(0.0, |p| p.near(hz).max(1e-12).ln())
        };
        let ln_density = self.ln_density.iter().enumerate().map(|(k, ln)| ln + correction(k)).collect();
        Self { ln_density }
    }
}

/// Mean periodogram of pieces with a Hann window, half overlapping, outliers cut; one everywhere for white noise of variance one.
struct Periodogram {
    rows: usize,
    count: usize,
    power: Vec<f64>,
}

impl Periodogram {
    fn of(series: &[&[f64]], rows: usize, is_first: bool) -> Self {
        let fft = towmag_fourier::forward(rows);
        let window: Vec<f64> = (0..rows).map(|k| 0.5 - 0.5 * (TAU * (k as f64 + 0.5) / rows as f64).cos()).collect();
        let scale = 1.0 / window.iter().map(|w| w * w).sum::<f64>();
        let mut pieces: Vec<Vec<f64>> = Vec::new();
        for series in series {
            for start in (0..(series.len() + 1).saturating_sub(rows)).step_by(rows / 2) {
                let windowed = series[start..start + rows].iter().zip(&window).map(|(x, w)| Complex::new(x * w, 0.0));
                let mut buffer: Vec<Complex<f64>> = windowed.collect();
                fft.process(&mut buffer);
                pieces.push(buffer[..=rows / 2].iter().map(|c| scale * c.norm_sqr()).collect());
            }
        }
        let power = if pieces.is_empty() {
            Vec::new()
        } else {
            (0..=rows / 2).map(|cell| cut_mean(pieces.iter().map(|piece| piece[cell]).collect(), is_first)).collect()
        };
        Self { rows, count: pieces.len(), power }
    }

    /// Mean over the cells that belong to the place of a frequency.
    fn near(&self, hz: f64) -> f64 {
        let cell = hz * self.rows as f64 / RATE_HZ;
        let half = (0.5 / PER_OCTAVE).exp2();
        let last = self.power.len() - 1;
        let from = ((cell / half).round() as usize).clamp(1, last);
        let to = ((cell * half).round() as usize).clamp(from, last);
        self.power[from..=to].iter().sum::<f64>() / (to - from + 1) as f64
    }
}

/// Mean of exponentially distributed values, those far beyond the median cut.
fn cut_mean(mut values: Vec<f64>, is_first: bool) -> f64 {
    if is_first {
        let place = values.len() / FIRST_QUANTILE;
        let (_, quantile, _) = values.select_nth_unstable_by(place, f64::total_cmp);
        return *quantile / (1.0 - 1.0 / FIRST_QUANTILE as f64).recip().ln();
    }
    let middle = values.len() / 2;
    let (_, &mut median, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    if values.len() < 4 {
        return values.iter().sum::<f64>() / values.len() as f64;
    }
    values.iter().map(|x| x.min(CUT_MEDIANS * median)).sum::<f64>() / (LEFT_BY_CUT * values.len() as f64)
}

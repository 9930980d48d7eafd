//! Octave bands whose powers add up to one: the noise is told apart in time by its power in each.

use std::f64::consts::FRAC_PI_2;

/// How many bands.
pub(super) const BANDS: usize = 10;
/// Middle of the lowest, Hz; it takes all below too, and the highest all above.
const LOWEST_HZ: f64 = 0.01;

/// A power in each band, relative to that of the spectrum.
pub(super) type Powers = [f64; BANDS];

/// The two bands that hold a frequency: the lower one, and the shares of power of both.
pub(super) fn shares(hz: f64) -> (usize, [f64; 2]) {
    let place = (hz.max(1e-9) / LOWEST_HZ).log2().clamp(0.0, (BANDS - 1) as f64);
    let lower = (place as usize).min(BANDS - 2);
    let upper = (FRAC_PI_2 * (place - lower as f64)).sin().powi(2);
    (lower, [1.0 - upper, upper])
}

/// Share of power of a band at a frequency.
pub(super) fn share(band: usize, hz: f64) -> f64 {
    let (lower, shares) = shares(hz);
    band.checked_sub(lower).and_then(|k| shares.get(k).copied()).unwrap_or(0.0)
}

/// What the density of the spectrum is multiplied by at a frequency, if the bands have these powers: their harmonic mean, as
/// the weights of the bands in a product of two series are the inverses of the powers.
pub(super) fn factor(powers: &Powers, hz: f64) -> f64 {
    let (lower, [a, b]) = shares(hz);
    1.0 / (a / powers[lower] + b / powers[lower + 1])
}

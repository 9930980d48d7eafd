//! What makes the noise of a stretch white, in frequency, without delay: `1 / sqrt(S)`, split into bands.

use std::f64::consts::PI;

use towmag_fourier::{Complex, Plan, Planner};

use super::bands::{BANDS, shares};
use super::covariance::Continuation;
use super::levelled::RATE_HZ;
use super::spectrum::Spectrum;

/// A stretch goes on beyond its ends for so many rows, as is most likely, the outer half faded: longer than whitening reaches.
const BEYOND_ROWS: usize = 1200;
/// Its end values are means of so many.
const END_ROWS: usize = 10;

/// Transforms of a stretch of some length.
#[derive(Clone)]
pub(super) struct Transform {
    rows: usize,
    beyond: usize,
    forward: Plan,
    inverse: Plan,
}

impl Transform {
    pub(super) fn of(rows: usize) -> Self {
        let beyond = BEYOND_ROWS.min(rows - 1);
        let length = fast_length(rows + 2 * beyond);
        let mut planner = Planner::new();
        Self { rows, beyond, forward: planner.forward(length), inverse: planner.inverse(length) }
    }

    pub(super) fn length(&self) -> usize {
        self.forward.len()
    }

    /// Frequency of a place of a transform, Hz, not negative.
    pub(super) fn hz(&self, place: usize) -> f64 {
        place.min(self.length() - place) as f64 * RATE_HZ / self.length() as f64
    }

    /// Transform of a real series that is longer than a stretch by nothing.
    pub(super) fn forward(&self, mut values: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
        values.resize(self.length(), Complex::ZERO);
        self.forward.process(&mut values);
        values
    }

    /// Back, as two series: the real and the imaginary part.
    pub(super) fn back(&self, mut values: Vec<Complex<f64>>, from: usize) -> [Vec<f64>; 2] {
        self.inverse.process(&mut values);
        let scale = 1.0 / self.length() as f64;
        let own = (0..self.rows).map(|k| values[(k + from) % values.len()] * scale);
        own.map(|c| (c.re, c.im)).unzip::<f64, f64, Vec<f64>, Vec<f64>>().into()
    }

    /// A stretch with what is likely before and after it, faded to the line that joins both.
    fn extended(&self, values: &[f64], continuation: &Continuation) -> Vec<Complex<f64>> {
        let (rows, beyond) = (self.rows, self.beyond);
        let before = continuation.after(values.iter().rev().copied(), beyond);
        let after = continuation.after(values.iter().copied(), beyond);
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let ends = END_ROWS.min(rows);
        let (head, tail) = (mean(&values[..ends]), mean(&values[rows - ends..]));
        let slope = (tail - head) / (rows.saturating_sub(ends).max(1)) as f64;
        let line = |place: usize| head + slope * (place as f64 - beyond as f64 - 0.5 * (ends - 1) as f64);
        let fade = |off: usize| {
            let outer = (2.0 * off as f64 / beyond as f64 - 1.0).max(0.0);
            0.5 + 0.5 * (PI * outer).cos()
        };
        let parts = before.iter().rev().chain(values).chain(&after);
        let faded = |(place, x): (usize, &f64)| {
            let off = beyond.saturating_sub(place).max((place + 1).saturating_sub(beyond + rows));
            Complex::new((x - line(place)) * fade(off), 0.0)
        };
        parts.enumerate().map(faded).collect()
    }
}

/// Smallest length from `least` on that has no prime factor above 5.
fn fast_length(least: usize) -> usize {
    let is_fast = |n: &usize| {
        let mut rest = *n;
        for prime in [2, 3, 5] {
            while rest.is_multiple_of(prime) {
                rest /= prime;
            }
        }
        rest == 1
    };
    (least..).find(is_fast).unwrap_or(least)
}

/// Whitening of a stretch by a spectrum.
pub(super) struct Whitener<'t> {
    transform: &'t Transform,
    /// `1 / sqrt(S)` of every place of the transform.
    gain: Vec<f64>,
    continuation: Continuation,
}

impl<'t> Whitener<'t> {
    pub(super) fn new(transform: &'t Transform, spectrum: &Spectrum) -> Self {
        let length = transform.length();
        let mut gain: Vec<f64> =
            (0..=length / 2).map(|place| spectrum.variance_at(transform.hz(place)).sqrt().recip()).collect();
        // The level is no part of an anomaly.
        gain[0] = 0.0;
        (length / 2 + 1..length).for_each(|place| gain.push(gain[length - place]));
        Self { transform, gain, continuation: Continuation::of(|hz| spectrum.at(hz)) }
    }

    fn spectrum_of(&self, values: &[f64]) -> Vec<Complex<f64>> {
        let mut spectrum = self.transform.forward(self.transform.extended(values, &self.continuation));
        spectrum.iter_mut().zip(&self.gain).for_each(|(c, gain)| *c *= gain);
        spectrum
    }

    /// The whitened series: variance one where the noise is as the spectrum says.
    pub(super) fn whitened(&self, values: &[f64]) -> Vec<f64> {
        let [whitened, _] = self.transform.back(self.spectrum_of(values), self.transform.beyond);
        whitened
    }

    /// The whitened series in each band.
    pub(super) fn in_bands(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let spectrum = self.spectrum_of(values);
        let roots = self.roots();
        let pair = |pair: usize| {
            let part = |(place, c): (usize, &Complex<f64>)| {
                *c * Complex::new(root_of(&roots[place], 2 * pair), root_of(&roots[place], 2 * pair + 1))
            };
            let mixed = spectrum.iter().enumerate().map(part).collect();
            self.transform.back(mixed, self.transform.beyond)
        };
        (0..BANDS / 2).flat_map(pair).collect()
    }

    /// The sum of series in bands, each in its band whitened once more: with [`Self::in_bands`] and a division by the powers of
    /// the bands in between it is the inverse of the noise covariance.
    pub(super) fn gathered(&self, bands: &[Vec<f64>]) -> Vec<f64> {
        let roots = self.roots();
        let length = self.transform.length();
        let mut sum = vec![Complex::ZERO; length];
        for pair in 0..BANDS / 2 {
            let values = bands[2 * pair].iter().zip(&bands[2 * pair + 1]).map(|(a, b)| Complex::new(*a, *b));
            let both = self.transform.forward(values.collect());
            for place in 0..length {
                // Of two real series in one transform, the even part belongs to the first, the odd one to the second.
                let (here, mirrored) = (both[place], both[(length - place) % length].conj());
                let (first, second) = (0.5 * (here + mirrored), Complex::new(0.0, -0.5) * (here - mirrored));
                let [a, b] = [2 * pair, 2 * pair + 1].map(|band| root_of(&roots[place], band));
                sum[place] += self.gain[place] * (a * first + b * second);
            }
        }
        let [out, _] = self.transform.back(sum, 0);
        out
    }

    /// Square roots of the shares of the bands, of every place.
    fn roots(&self) -> Vec<(usize, [f64; 2])> {
        let root = |place: usize| {
            let (lower, shares) = shares(self.transform.hz(place));
            (lower, shares.map(f64::sqrt))
        };
        (0..self.transform.length()).map(root).collect()
    }
}

fn root_of((lower, roots): &(usize, [f64; 2]), band: usize) -> f64 {
    band.checked_sub(*lower).and_then(|k| roots.get(k).copied()).unwrap_or(0.0)
}

//! How often noise alone explains so much: the expected Euler characteristic of the places where it does (Worsley 1994 for
//! chi-squared fields; Adler and Taylor 2007). At high thresholds that is the number of peaks.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{DMatrix, Matrix3, Vector3};
use towmag_fourier::Complex;

use super::dipole::{directions, profiles};
use super::levelled::RATE_HZ;
use super::scan::distances_s;
use super::spectrum::Spectrum;

/// Length of the transforms: the longest profile reaches ten distances to either side.
const LENGTH: usize = 4096;
/// Difference quotients by time and logarithm of the distance, in distances.
const STEP: f64 = 0.02;
/// Directions of amplitudes over which the metric is averaged.
const DIRECTIONS: usize = 40;
/// Where the peaks of the recording itself are counted: some 100 an hour, few of which are targets.
const COUNTED_GLRT: f64 = 15.0;
/// Tails are no heavier than this: beyond, the count is one of targets (on loops over iron half of all peaks are), and the
/// threshold would be above them. Seeds 5 and 26 of the trial: 24 without it, and nothing found.
const MOST_INFLATION: f64 = 3.0;
/// Fewer peaks than this tell nothing of their scale.
const LEAST_PEAKS: usize = 10;

/// How often noise has peaks of the detector above a value.
#[derive(Clone, Copy, Debug)]
pub(super) struct NullRate {
    /// Area an hour of times and distances, in units in which a component of the detector changes by its own size.
    area: f64,
    /// Half the length an hour of its two edges, the shortest and the longest distance.
    edge: f64,
    /// What values are divided by: more than one where the noise has heavier tails than measured.
    pub(super) inflation: f64,
}

impl NullRate {
    pub(super) fn of(spectrum: &Spectrum, range: [f64; 2]) -> Self {
        let distances = distances_s(range);
        let metrics: Vec<[f64; 2]> = distances.iter().map(|distance_s| metric(spectrum, *distance_s)).collect();
        let steps = distances.windows(2).zip(metrics.windows(2));
        let area = steps.map(|(d, m)| 0.5 * (m[0][0] + m[1][0]) * (d[1] / d[0]).ln()).sum::<f64>();
        let edge = 0.5 * (metrics[0][1] + metrics[metrics.len() - 1][1]);
        Self { area: 3600.0 * area, edge: 3600.0 * edge, inflation: 1.0 }
    }

    /// Peaks an hour above a value.
    fn per_hour(&self, glrt: f64) -> f64 {
        let t = glrt / self.inflation;
        self.inside_per_hour(glrt) + common(t) * self.edge * t / TAU.sqrt()
    }

    /// The same without those at the shortest and the longest distance, whose dipoles lie beyond.
    pub(super) fn inside_per_hour(&self, glrt: f64) -> f64 {
        let t = glrt / self.inflation;
        common(t) * self.area * t.sqrt() * (t - 2.0) / TAU
    }

    /// The value that peaks of noise exceed so often.
    pub(super) fn threshold(&self, per_hour: f64) -> f64 {
        self.exceeded(per_hour, Self::per_hour)
    }

    /// The value that those inside exceed so often.
    pub(super) fn inside_threshold(&self, per_hour: f64) -> f64 {
        self.exceeded(per_hour, Self::inside_per_hour)
    }

    fn exceeded(&self, per_hour: f64, rate: impl Fn(&Self, f64) -> f64) -> f64 {
        // From four on the rate falls; at a thousand there is none left.
        let (mut low, mut high) = (6.0 * self.inflation, 1000.0 * self.inflation);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if rate(self, middle) > per_hour { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// With the inflation that makes the count of a recording's own peaks, the largest first, what is expected of so many hours.
    pub(super) fn scaled_to(self, peaks: &[f64], hours: f64) -> Self {
        let expected = (self.per_hour(COUNTED_GLRT) * hours).round() as usize;
        if expected < LEAST_PEAKS {
            return self;
        }
        let Some(glrt) = peaks.get(expected) else { return self };
        Self { inflation: (glrt / COUNTED_GLRT).clamp(1.0, MOST_INFLATION), ..self }
    }
}

/// Of the densities for three degrees of freedom what both have: Gamma(3/2) sqrt(2) is sqrt(pi / 2).
fn common(t: f64) -> f64 {
    (-0.5 * t).exp() / FRAC_PI_2.sqrt()
}

/// Of one distance: the area a second and a unit of the logarithm of the distance, and the length a second.
fn metric(spectrum: &Spectrum, distance_s: f64) -> [f64; 2] {
    let products = products(spectrum, distance_s);
    let block = |i: usize, j: usize| Matrix3::from(products.fixed_view::<3, 3>(3 * i, 3 * j));
    let gram = block(0, 0);
    let (Some(inverse), Some(root)) = (gram.try_inverse(), gram.cholesky()) else { return [0.0; 2] };
    let Some(root) = root.l().try_inverse() else { return [0.0; 2] };
    // What a change of time or distance adds to the normalised profiles across the space that they span.
    let across = |i: usize, j: usize| root * (block(i, j) - block(i, 0) * inverse * block(0, j)) * root.transpose();
    let (tt, td, dd) = (across(1, 1), across(1, 2), across(2, 2));
    let mut sums = [0.0; 2];
    for n in directions(DIRECTIONS) {
        let of = |m: &Matrix3<f64>| n.dot(&(m * n));
        sums[0] += (of(&tt) * of(&dd) - of(&td).powi(2)).max(0.0).sqrt();
        sums[1] += of(&tt).max(0.0).sqrt();
    }
    sums.map(|sum| sum / DIRECTIONS as f64)
}

/// Products, weighted by the inverse of the spectrum, of the three profiles, their derivatives by time, and those by the
/// logarithm of the distance.
fn products(spectrum: &Spectrum, distance_s: f64) -> DMatrix<f64> {
    let fft = towmag_fourier::forward(LENGTH);
    let functions = |time_s: f64| {
        let at = |time_s: f64, distance_s: f64| Vector3::from(profiles(time_s / distance_s));
        let h = STEP * distance_s;
        let by_time = (at(time_s - h, distance_s) - at(time_s + h, distance_s)) / (2.0 * h);
        let nearer = at(time_s, distance_s * (-STEP).exp());
        let by_distance = (at(time_s, distance_s * STEP.exp()) - nearer) / (2.0 * STEP);
        [at(time_s, distance_s), by_time, by_distance]
    };
    let rows: Vec<[Vector3<f64>; 3]> =
        (0..LENGTH).map(|k| functions((k as f64 - LENGTH as f64 / 2.0) / RATE_HZ)).collect();
    let transforms: Vec<Vec<Complex<f64>>> = (0..9)
        .map(|k| {
            let mut values: Vec<_> = rows.iter().map(|row| Complex::new(row[k / 3][k % 3], 0.0)).collect();
            fft.process(&mut values);
            values
        })
        .collect();
    let weights: Vec<f64> = (0..LENGTH / 2)
        .map(|k| 2.0 / (LENGTH as f64 * spectrum.variance_at(k as f64 * RATE_HZ / LENGTH as f64)))
        .collect();
    DMatrix::from_fn(9, 9, |i, j| {
        (1..LENGTH / 2).map(|k| weights[k] * (transforms[i][k].conj() * transforms[j][k]).re).sum()
    })
}

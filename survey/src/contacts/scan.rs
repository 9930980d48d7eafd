//! The matched subspace detector (Scharf and Friedlander 1994): how much a dipole of any moment explains, at all times and
//! distances, in a field whose noise covariance is known.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use towmag_fourier::Complex;

use super::bands::{BANDS, Powers, shares};
use super::dipole::profiles;
use super::levelled::RATE_HZ;
use super::noise::{NODE, Noise};
use super::whitening::{Transform, Whitener};

/// Ratio of a distance to the next smaller one: half way, a dipole loses less than 1 % of what it explains.
const DISTANCE_RATIO: f64 = 1.2;
/// Times are this share of the distance apart, for the same loss.
const TIME_STEP: f64 = 0.125;
/// Profiles are followed to so many distances: there they have 1 / 500 of their peaks.
const REACH_DISTANCES: f64 = 8.0;
/// Peaks below this explain no more than chance does every few seconds.
const LEAST_GLRT: f64 = 10.0;

/// Where a dipole explains more than a little earlier, later, nearer or further.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Peak {
    /// Which stretch.
    pub(super) stretch: usize,
    /// Cell of the closest approach.
    pub(super) cell: usize,
    /// Distance over speed, s.
    pub(super) distance_s: f64,
    /// Twice the log likelihood ratio.
    pub(super) glrt: f64,
}

/// Distances that are looked at, s.
pub(super) fn distances_s(range: [f64; 2]) -> Vec<f64> {
    let steps = ((range[1] / range[0]).ln() / DISTANCE_RATIO.ln()).ceil().max(1.0) as usize;
    (0..=steps).map(|k| range[0] * (range[1] / range[0]).powf(k as f64 / steps as f64)).collect()
}

/// All peaks of a stretch of some values, the largest first.
pub(super) fn peaks(
    noise: &Noise,
    transform: &Transform,
    stretch: usize,
    values: &[f64],
    range: [f64; 2],
) -> Vec<Peak> {
    let weighted = weighted(noise, transform, stretch, values);
    let spectrum = transform.forward(weighted.iter().map(|x| Complex::new(*x, 0.0)).collect());
    let distances = distances_s(range);
    let explained: Vec<Explained> = distances
        .par_iter()
        .map(|distance_s| Explained::of(noise, transform, stretch, &spectrum, *distance_s, values.len()))
        .collect();
    let mut peaks: Vec<Peak> = (0..distances.len()).flat_map(|k| peaks_at(&explained, k, stretch)).collect();
    peaks.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
    peaks
}

/// The values times the inverse of the noise covariance.
fn weighted(noise: &Noise, transform: &Transform, stretch: usize, values: &[f64]) -> Vec<f64> {
    let whitener = Whitener::new(transform, &noise.spectrum);
    let mut in_bands = whitener.in_bands(values);
    let powers: Vec<Powers> = (0..values.len()).map(|cell| noise.powers_at(stretch, cell)).collect();
    for (band, series) in in_bands.iter_mut().enumerate() {
        series.iter_mut().zip(&powers).for_each(|(x, powers)| *x /= powers[band]);
    }
    whitener.gathered(&in_bands)
}

/// What a dipole at one distance explains, every so many cells.
struct Explained {
    distance_s: f64,
    step: usize,
    glrt: Vec<f64>,
}

/// Transforms of the profiles at a distance: all real but for the second, which is real times -i.
pub(super) struct ProfileSpectra {
    even: Vec<[f64; 2]>,
    odd: Vec<f64>,
}

impl ProfileSpectra {
    pub(super) fn of(transform: &Transform, distance_rows: f64) -> Self {
        let length = transform.length();
        let half = ((REACH_DISTANCES * distance_rows) as usize).min(length / 2 - 1);
        let mut series = vec![Complex::ZERO; length];
        for off in 0..=half {
            let [a, b, c] = profiles(off as f64 / distance_rows);
            series[off] = Complex::new(a, b + c);
            if off > 0 {
                series[length - off] = Complex::new(a, c - b);
            }
        }
        let both = transform.forward(series);
        let mirrored = |place: usize| both[(length - place) % length];
        let even = (0..length).map(|k| [0.5 * (both[k].re + mirrored(k).re), both[k].im]).collect();
        let odd = (0..length).map(|k| 0.5 * (both[k].re - mirrored(k).re)).collect();
        Self { even, odd }
    }

    /// Products of the profiles weighted by the inverse of the spectrum, the part of each band: first with first, first with
    /// third, third with third, second with second. The others are zero, as one is even and the other odd.
    pub(super) fn grams(&self, noise: &Noise, transform: &Transform) -> [[f64; 4]; BANDS] {
        let length = transform.length();
        let mut grams = [[0.0; 4]; BANDS];
        for place in 1..=length / 2 {
            let hz = transform.hz(place);
            let weight = if 2 * place == length { 1.0 } else { 2.0 } / (noise.spectrum.variance_at(hz) * length as f64);
            let ([first, third], second) = (self.even[place], self.odd[place]);
            let (lower, shares) = shares(hz);
            for (gram, share) in grams[lower..].iter_mut().zip(shares) {
                let weight = weight * share;
                let products = [first * first, first * third, third * third, second * second];
                gram.iter_mut().zip(products).for_each(|(sum, product)| *sum += weight * product);
            }
        }
        grams
    }
}

impl Explained {
    fn of(
        noise: &Noise,
        transform: &Transform,
        stretch: usize,
        spectrum: &[Complex<f64>],
        distance_s: f64,
        rows: usize,
    ) -> Self {
        let distance_rows = distance_s * RATE_HZ;
        let profiles = ProfileSpectra::of(transform, distance_rows);
        let grams = profiles.grams(noise, transform);
        let evens = spectrum.iter().zip(&profiles.even).zip(&profiles.odd);
        // Correlation with an odd profile is a product with i times its real part; as imaginary part, that is times -1.
        let first_two = evens.map(|((y, even), odd)| y * (even[0] - odd)).collect();
        let third = spectrum.iter().zip(&profiles.even).map(|(y, even)| y * even[1]).collect();
        let [first, second] = transform.back(first_two, 0);
        let [third, _] = transform.back(third, 0);
        let step = ((TIME_STEP * distance_rows) as usize).max(1);
        let (mut glrt, mut inverse, mut node) = (Vec::with_capacity(rows / step + 1), Matrix3::zeros(), usize::MAX);
        for cell in (0..rows).step_by(step) {
            if cell / (NODE / 5) != node {
                node = cell / (NODE / 5);
                let gram = gram_at(&grams, &noise.powers_at(stretch, cell));
                inverse = gram.try_inverse().unwrap_or_else(Matrix3::zeros);
            }
            let q = Vector3::new(first[cell], second[cell], third[cell]);
            glrt.push(q.dot(&(inverse * q)));
        }
        Self { distance_s, step, glrt }
    }

    /// Largest within a step of a cell.
    fn near(&self, cell: usize) -> f64 {
        let k = (cell as f64 / self.step as f64).round() as usize;
        let near = k.saturating_sub(1)..(k + 2).min(self.glrt.len());
        self.glrt[near.start.min(near.end)..near.end].iter().copied().fold(0.0, f64::max)
    }
}

/// Products of the profiles at these powers of the bands.
pub(super) fn gram_at(grams: &[[f64; 4]; BANDS], powers: &Powers) -> Matrix3<f64> {
    let mut sum = [0.0; 4];
    for (gram, power) in grams.iter().zip(powers) {
        sum.iter_mut().zip(gram).for_each(|(sum, g)| *sum += g / power);
    }
    Matrix3::new(sum[0], 0.0, sum[1], 0.0, sum[3], 0.0, sum[1], 0.0, sum[2])
}

fn peaks_at(all: &[Explained], index: usize, stretch: usize) -> Vec<Peak> {
    let own = &all[index];
    let at = |k: usize| own.glrt.get(k).copied().unwrap_or(0.0);
    let peak = |k: usize| {
        let (glrt, cell) = (own.glrt[k], k * own.step);
        let (before, after) = (if k == 0 { 0.0 } else { at(k - 1) }, at(k + 1));
        if glrt < LEAST_GLRT || glrt < before || glrt <= after {
            return None;
        }
        let nearer = index.checked_sub(1).map(|k| all[k].near(cell));
        let further = all.get(index + 1).map(|other| other.near(cell));
        if [nearer, further].into_iter().flatten().any(|other| other > glrt) {
            return None;
        }
        let by_distance = nearer.zip(further).map_or(0.0, |(a, b)| rise(a, glrt, b));
        let glrt = glrt + rise(before, glrt, after) + by_distance;
        Some(Peak { stretch, cell, distance_s: own.distance_s, glrt })
    };
    (0..own.glrt.len()).filter_map(peak).collect()
}

/// How far the top of the parabola through three values is above the middle one, which is the largest.
fn rise(before: f64, middle: f64, after: f64) -> f64 {
    let curvature = 2.0 * middle - before - after;
    if curvature > 0.0 { (after - before).powi(2) / (8.0 * curvature) } else { 0.0 }
}

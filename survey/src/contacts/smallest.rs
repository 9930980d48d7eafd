//! The smallest object that would be found.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use statrs::distribution::{ContinuousCDF, Normal};

use super::bands::BANDS;
use super::dipole::{NT_M3_PER_AM2, amplitudes_of_moment, directions};
use super::found::Found;
use super::levelled::{Levelled, RATE_HZ};
use super::noise::{NODE, Noise};
use super::scan::{ProfileSpectra, gram_at};
use super::way::Way;
use super::whitening::Transform;

/// Probability with which it is found.
const PROBABILITY: f64 = 0.9;
/// Directions of moments over which that is meant.
const DIRECTIONS: usize = 40;
/// Distances are told apart by this ratio; the moment goes with their third power exactly.
const DISTANCE_RATIO: f64 = 1.1;
/// Rows of the transform that profiles are weighed in.
const ROWS: usize = 4000;
/// Halvings of the factor between the least and the largest moment that is thought of, A m^2.
const HALVINGS: usize = 40;
const MOMENTS_AM2: [f64; 2] = [1e-6, 1e9];

/// The smallest moment that is found with a probability of 0.9 straight below the track, all directions alike, A m^2, a value a
/// row; NaN where speed or distance is not known. The distance is the altitude, or `distance_m` where that is not known.
pub fn smallest_moments_am2(levelled: &Levelled<'_>, found: &Found, distance_m: Option<f64>) -> Vec<f64> {
    let way = Way::by_positions(levelled);
    let mut grams = Grams { transform: Transform::of(ROWS), of_steps: BTreeMap::new() };
    let mut out = vec![f64::NAN; levelled.time_s.len()];
    for from in (0..out.len()).step_by(NODE).filter(|_| way.is_metres) {
        let to = (from + NODE).min(out.len());
        let row = (from + to) / 2;
        let altitude_m = levelled.altitude_m.map(|altitude_m| altitude_m[row]).filter(|m| *m > 0.0);
        let Some(distance_m) = altitude_m.or(distance_m) else { continue };
        let direction = levelled.direction.get(row).map(|d| Vector3::from(*d));
        let field = direction.filter(|d| d.iter().all(|x| x.is_finite())).unwrap_or_else(Vector3::z);
        if let Some(snrs) = grams.snrs(&found.noise, row, (distance_m, way.per_s[row]), field) {
            let moment_am2 = smallest(&snrs, found.threshold);
            (from..to).filter(|row| levelled.is_valid[*row]).for_each(|row| out[row] = moment_am2);
        }
    }
    out
}

/// Products of the profiles, by distance over speed.
struct Grams {
    transform: Transform,
    of_steps: BTreeMap<i32, [[f64; 4]; BANDS]>,
}

impl Grams {
    /// Signal to noise of 1 A m^2 in each of some directions.
    fn snrs(
        &mut self,
        noise: &Noise,
        row: usize,
        (distance_m, speed): (f64, f64),
        field: Vector3<f64>,
    ) -> Option<Vec<f64>> {
        let step = ((distance_m / speed).ln() / DISTANCE_RATIO.ln()).round() as i32;
        let transform = &self.transform;
        let grams = self.of_steps.entry(step).or_insert_with(|| {
            ProfileSpectra::of(transform, DISTANCE_RATIO.powi(step) * RATE_HZ).grams(noise, transform)
        });
        let gram = gram_at(grams, &noise.powers_near(row)?);
        let matrix = amplitudes_of_moment(Vector3::z(), field) * (NT_M3_PER_AM2 / distance_m.powi(3));
        let of = |direction: Vector3<f64>| {
            let amplitudes = matrix * direction;
            amplitudes.dot(&(gram * amplitudes)).sqrt()
        };
        Some(directions(DIRECTIONS).map(of).collect())
    }
}

/// The moment that is found with the probability, on the mean over these signals to noise of one unit.
fn smallest(snrs: &[f64], threshold: f64) -> f64 {
    let normal = Normal::standard();
    let found = |moment: f64| {
        // The root of what a dipole explains scatters by one about that of its mean: three amplitudes explain one each of noise.
        let of = |snr: &f64| normal.cdf(((moment * snr).powi(2) + 2.0).sqrt() - threshold.sqrt());
        snrs.iter().map(of).sum::<f64>() / snrs.len() as f64
    };
    let [mut low, mut high] = MOMENTS_AM2.map(f64::ln);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if found(middle.exp()) < PROBABILITY { low = middle } else { high = middle }
    }
    high.exp()
}

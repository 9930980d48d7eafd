//! What a fit leaves open: place, distance and moment, as weighted samples.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix2, Matrix3, SMatrix, SymmetricEigen, Vector2, Vector3};

use statrs::distribution::{ContinuousCDF, Normal};

use super::dipole::{Dipole, NT_M3_PER_AM2, amplitudes_of_moment};
use super::fit::model_error;
use super::told::{self, Numbers};
use super::window::{Fitted, Window};
use crate::result::Estimate;

/// Steps of the difference quotients by place, in distances, and by the logarithm of the distance, over the signal to noise.
const STEP: f64 = 0.3;
/// Places of the grid along each of its axes, and how far it reaches, in standard deviations.
const PLACES: i32 = 17;
const REACH: f64 = 4.5;
/// What the noise is larger in a window than its spectrum says, in power: at the long periods of wide targets half an hour holds
/// but a few of them, and neighbours too weak to be found add to it. Measured: errors of simulated tows (seeds 1040 to 1084
/// of `tests/measure_contacts.rs`) are 1.0 to 1.3 times what the spectrum alone gives.
const NOISE_BEYOND: f64 = 1.5;
/// The way is not straight and even, as a fit takes it to be, and a sensor reads the size of the field, not its projection. That
/// leaves a share of an anomaly of about the heave over the distance, squared: 0.1 m rms of heave in 1 m to 0.03 at 3 m.
const MODEL_ERROR: f64 = 0.01;
/// What the distance itself is off by, m and as a share, and the moment with its third power: a body heaves by 0.1 to 0.3 m rms,
/// of which a pass sees part as one offset, and where yaw makes the way longer by 1 in `cos(yaw)`, or the speed is off by some
/// per cent, so is the distance. Tuned on seeds 1 to 40 of the trial: intervals hold 0.87 there, 0.46 without.
pub(super) const HEAVE_M: f64 = 0.1;
pub(super) const UNEVEN: f64 = 0.03;
/// Samples of amplitudes and side at each.
const SAMPLES: usize = 12;
/// Places of less than this share of the largest weight count for nothing.
const LEAST_WEIGHT: f64 = 1e-4;
/// An object on the bottom: its depth below that, m, lies between these in this share of cases; else it may be anywhere below.
const ON_BOTTOM_M: [f64; 2] = [-0.7, 2.0];
const ON_BOTTOM_SHARE: f64 = 0.9;

/// What is known of the surroundings of a contact whose way is in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surroundings {
    /// Unit vector of the Earth's field in axes (forward, starboard, down).
    pub(super) field: Vector3<f64>,
    /// Height of the sensor above the bottom, m.
    pub(super) altitude_m: Option<f64>,
    /// Its depth below the surface, m.
    pub(super) depth_m: Option<f64>,
}

/// One possibility.
#[derive(Clone, Copy, Debug)]
struct Sample {
    weight: f64,
    at: f64,
    distance: f64,
    moment_am2: f64,
}

impl Sample {
    /// Of a distance that is off by so large a share, and the moment with its third power.
    fn further(self, share: f64, index: usize) -> Self {
        let even = (0.5 + index as f64 * GOLDEN).fract();
        let by = (share * Normal::standard().inverse_cdf(even)).exp();
        Self { distance: self.distance * by, moment_am2: self.moment_am2 * by.powi(3), ..self }
    }
}

/// Multiples of this fill the unit interval evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// What is known after a fit.
#[derive(Clone, Debug)]
pub(super) struct Posterior {
    pub(super) at: Estimate,
    pub(super) at_std: f64,
    pub(super) distance: Estimate,
    /// A m^2; meaningless without surroundings.
    pub(super) moment_am2: Estimate,
    /// Mean and covariance of place, distance and amplitudes, without what heave and an uneven speed add.
    pub(super) told: Option<(Numbers, SMatrix<f64, 5, 5>)>,
}

/// The posterior about the best fit. All moments are of any direction alike and, of sizes, every factor is as likely (the one
/// prior that does not depend on the unit); every distance is as likely.
///
/// Moment and distance trade: the amplitudes go as moment over the third power of distance, so 10 % of the distance are 33 % of
/// the moment. The part of a moment that is across both track and direction to the object shows by the Earth's field across alone:
/// under a track along the magnetic meridian it hardly does, and the interval says so.
pub(super) fn posterior(
    window: &Window<'_>,
    modes: &[Fitted],
    surroundings: Option<&Surroundings>,
) -> Option<Posterior> {
    let best = modes.first()?;
    let beyond = NOISE_BEYOND + model_error(window, best).max(MODEL_ERROR).powi(2) * best.glrt;
    let mut places: Vec<(f64, Fitted)> = Vec::new();
    for mode in modes.iter().filter(|mode| 0.5 * (best.glrt - mode.glrt) / beyond < -LEAST_WEIGHT.ln()) {
        let axes = axes(window, mode, beyond)?;
        // Each mode has places of its own, further apart where it is wider.
        let area = axes.determinant().abs() * mode.dipole.distance;
        for fitted in about(window, mode, &axes) {
            // Even in place and logarithm of the distance, times the distance: even in both. With the amplitudes
            // integrated out each place has the volume of what they may be.
            let volume = area * fitted.gram.determinant().sqrt().recip();
            places.push(((0.5 * (fitted.glrt - best.glrt) / beyond).exp() * volume * fitted.dipole.distance, fitted));
        }
    }
    let largest = places.iter().map(|place| place.0).fold(0.0, f64::max);
    places.retain(|place| place.0 > LEAST_WEIGHT * largest);
    let mut samples = Vec::with_capacity(SAMPLES * places.len());
    let mut index = 0;
    for (weight, fitted) in &places {
        let Some(root) = (fitted.gram / beyond).try_inverse().and_then(Matrix3::cholesky).map(|c| c.l()) else {
            continue;
        };
        for _ in 0..SAMPLES {
            index += 1;
            let uneven = surroundings.map_or(UNEVEN, |_| UNEVEN.hypot(HEAVE_M / fitted.dipole.distance));
            samples.push(sample(weight / largest, fitted, &root, surroundings, index).further(uneven, index));
        }
    }
    summary(samples, told::moments(&places, beyond))
}

/// The fits at places of a grid about a mode.
fn about(window: &Window<'_>, mode: &Fitted, axes: &Matrix2<f64>) -> Vec<Fitted> {
    let Dipole { at, distance, side_rad, .. } = mode.dipole;
    let off = |k: i32| REACH * (2.0 * f64::from(k) / f64::from(PLACES - 1) - 1.0);
    let place = |k: i32| {
        let by = axes * Vector2::new(off(k / PLACES), off(k % PLACES));
        window.at(at + by[0] * distance, distance * by[1].exp(), side_rad)
    };
    (0..PLACES * PLACES).filter_map(place).collect()
}

/// Standard deviations along the axes of the likelihood, by place in distances and by the logarithm of the distance.
fn axes(window: &Window<'_>, best: &Fitted, beyond: f64) -> Option<Matrix2<f64>> {
    let step = STEP / best.glrt.sqrt().max(1.0);
    let dipole = best.dipole;
    let glrt = |i: f64, j: f64| {
        let fitted =
            window.at(dipole.at + i * step * dipole.distance, dipole.distance * (j * step).exp(), dipole.side_rad);
        fitted.map(|fitted| 0.5 * fitted.glrt)
    };
    let (middle, along) = (glrt(0.0, 0.0)?, [glrt(1.0, 0.0)?, glrt(-1.0, 0.0)?]);
    let (away, both) = ([glrt(0.0, 1.0)?, glrt(0.0, -1.0)?], [glrt(1.0, 1.0)?, glrt(-1.0, -1.0)?]);
    let tt = 2.0 * middle - along[0] - along[1];
    let dd = 2.0 * middle - away[0] - away[1];
    let td = 0.5 * (2.0 * middle - both[0] - both[1] - tt - dd);
    let eigen = SymmetricEigen::new(Matrix2::new(tt, td, td, dd) / (step * step));
    // A likelihood that is flat to one side is looked at as far as half the distance.
    let stds = eigen.eigenvalues.map(|value| value.max(4.0 * REACH * REACH / 4.0).sqrt().recip());
    Some(eigen.eigenvectors * Matrix2::from_diagonal(&(stds * beyond.sqrt())))
}

/// A point of the sequence that fills the unit cube of four dimensions most evenly (Roberts 2018, R4).
fn even_point(index: usize) -> [f64; 4] {
    const ROOT: f64 = 1.167_303_978_261_418_7;
    std::array::from_fn(|k| (0.5 + index as f64 * ROOT.powi(-(k as i32 + 1))).fract())
}

fn sample(
    weight: f64,
    fitted: &Fitted,
    root: &Matrix3<f64>,
    surroundings: Option<&Surroundings>,
    index: usize,
) -> Sample {
    let [a, b, c, side] = even_point(index);
    let normal = |a: f64, b: f64| (-2.0 * a.max(1e-12).ln()).sqrt() * Vector2::new((TAU * b).cos(), (TAU * b).sin());
    let (first, second) = (normal(a, b), normal(c, (17.0 * (a + b)).fract()));
    let amplitudes = Vector3::from(fitted.dipole.amplitudes_nt) + root * Vector3::new(first[0], first[1], second[0]);
    let (at, distance) = (fitted.dipole.at, fitted.dipole.distance);
    let Some(surroundings) = surroundings else {
        let weight = weight * amplitudes.norm().powi(-3);
        return Sample { weight, at, distance, moment_am2: amplitudes.norm() };
    };
    let angle = PI * (side - 0.5);
    let toward = Vector3::new(0.0, angle.sin(), angle.cos());
    let matrix = amplitudes_of_moment(toward, surroundings.field);
    let determinant = matrix.determinant().abs();
    let Some(moment) = matrix.try_inverse().map(|inverse| inverse * amplitudes) else {
        return Sample { weight: 0.0, at, distance, moment_am2: 0.0 };
    };
    // Even in the logarithm of the moment is 1 / moment^3 in its space; the determinant leads there from the amplitudes.
    let weight =
        weight * moment.norm().powi(-3) / determinant * bottom(surroundings.altitude_m, distance * angle.cos());
    Sample { weight, at, distance, moment_am2: moment.norm() * distance.powi(3) / NT_M3_PER_AM2 }
}

/// How likely an object is so far below the sensor.
fn bottom(altitude_m: Option<f64>, below_m: f64) -> f64 {
    let Some(altitude_m) = altitude_m else { return 1.0 };
    let [from, to] = ON_BOTTOM_M;
    let is_there = (from..to).contains(&(below_m - altitude_m));
    let there = if is_there { ON_BOTTOM_SHARE / (to - from) } else { 0.0 };
    there + (1.0 - ON_BOTTOM_SHARE) / (altitude_m + to).max(to)
}

fn summary(samples: Vec<Sample>, told: Option<(Numbers, SMatrix<f64, 5, 5>)>) -> Option<Posterior> {
    let samples: Vec<Sample> = samples.into_iter().filter(|s| s.weight.is_finite() && s.weight > 0.0).collect();
    let total: f64 = samples.iter().map(|s| s.weight).sum();
    let mean = samples.iter().map(|s| s.weight * s.at).sum::<f64>() / total;
    let variance = samples.iter().map(|s| s.weight * (s.at - mean).powi(2)).sum::<f64>() / total;
    let estimate = |of: fn(&Sample) -> f64| {
        let mut values: Vec<(f64, f64)> = samples.iter().map(|s| (of(s), s.weight)).collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut sum = 0.0;
        let sums: Vec<f64> = values
            .iter()
            .map(|(_, weight)| {
                sum += weight;
                sum
            })
            .collect();
        let at = |share: f64| values[sums.partition_point(|sum| *sum < share * total).min(values.len() - 1)].0;
        Estimate { value: at(0.5), low: at(0.025), high: at(0.975) }
    };
    (total > 0.0).then(|| Posterior {
        at: estimate(|s| s.at),
        at_std: variance.sqrt(),
        distance: estimate(|s| s.distance),
        moment_am2: estimate(|s| s.moment_am2),
        told,
    })
}

//! Recordings made from physics: body motion, the Earth's field, 18-term interference, sensors.
//!
//! A [`Scenario`] is evaluated at any time, so that derivatives are true ones and not differences of samples. All
//! functions are `libm`'s: the same seed gives the same bytes on every platform.

mod motion;
mod sample;
pub mod scenario;
pub mod signals;

pub use motion::{Attitude, Course, Motion, Oscillation};
pub use sample::{sample_calibration, sample_survey};

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use towmag::Epoch;
use towmag::model::TERMS;

use crate::recording::RATE_HZ;

/// The Earth's field where the body is: constant in direction, slowly varying in strength.
#[derive(Clone, Copy, Debug)]
pub struct EarthField {
    /// Magnitude, nT.
    pub strength_nt: f64,
    /// Inclination below the horizon, degrees.
    pub inclination_deg: f64,
    /// Declination east of north, degrees.
    pub declination_deg: f64,
    /// Amplitude of the geological background along the track, nT.
    pub geology_nt: f64,
    /// Longest period of the geological background, s.
    pub geology_period_s: f64,
}

/// A dipole that the body passes: what a survey is for.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Time of closest approach, s.
    pub time_s: f64,
    /// Peak of its anomaly, nT.
    pub peak_nt: f64,
    /// Time that the peak takes at half its height, s.
    pub width_s: f64,
}

/// Everything that makes a recording. The same scenario gives the same recording.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// Seed of the sensor noise.
    pub seed: u64,
    /// Length, s.
    pub duration_s: f64,
    /// How the body moves.
    pub motion: Motion,
    /// Where it is.
    pub field: EarthField,
    /// Its 18 coefficients in the units of eq. (4).
    pub coefficients: [f64; TERMS],
    /// What it passes.
    pub targets: Vec<Target>,
    /// White noise of the scalar sensor, nT rms.
    pub scalar_noise_nt: f64,
    /// White noise of each fluxgate axis, nT rms.
    pub flux_noise_nt: f64,
}

/// One row of a made recording.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds since the start.
    pub time_s: f64,
    /// Scalar sensor, nT, as it resolves it: 0.001 nT.
    pub scalar_nt: f64,
    /// Fluxgate in body axes, nT, as it resolves it: 0.01 nT.
    pub flux_nt: [f64; 3],
    /// True attitude.
    pub attitude: Attitude,
    /// The epoch as the core sees it.
    pub epoch: Epoch,
}

impl Scenario {
    /// The recording, sample by sample.
    pub fn samples(&self) -> impl Iterator<Item = Sample> + '_ {
        let mut noise = ChaCha8Rng::seed_from_u64(self.seed);
        let count = (self.duration_s * RATE_HZ).round() as u32;
        (0..count).map(move |tick| self.sample(tick, &mut noise))
    }

    fn sample(&self, tick: u32, noise: &mut ChaCha8Rng) -> Sample {
        let mut gauss = |rms: f64| -> f64 {
            let unit: f64 = StandardNormal.sample(noise);
            rms * unit
        };
        let time_s = f64::from(tick) / RATE_HZ;
        let (field_nt, cosines) = (self.field_nt(time_s), self.direction_cosines(time_s));
        let scalar_nt = field_nt + self.interference_nt(time_s, field_nt) + gauss(self.scalar_noise_nt);
        let scalar_pt = (scalar_nt * 1000.0).round();
        let flux_nt = cosines.map(|cosine| ((field_nt * cosine + gauss(self.flux_noise_nt)) * 100.0).round() / 100.0);
        Sample {
            time_s,
            scalar_nt: scalar_pt / 1000.0,
            flux_nt,
            attitude: self.motion.attitude(time_s),
            epoch: Epoch { tick, scalar_pt: Some(scalar_pt as i32), flux_nt: Some(flux_nt.map(|c| c as f32)) },
        }
    }

    /// The body's interference at a time, nT.
    pub fn interference_at_nt(&self, time_s: f64) -> f64 {
        self.interference_nt(time_s, self.field_nt(time_s))
    }

    /// The Earth's field with geology and targets, nT.
    fn field_nt(&self, time_s: f64) -> f64 {
        let EarthField { strength_nt, geology_nt, geology_period_s, .. } = self.field;
        let turns = time_s / geology_period_s * std::f64::consts::TAU;
        let geology: f64 = [(1.0, 0.4), (0.62, 1.73), (0.23, 3.31)].iter().map(|(a, f)| a * libm::sin(turns * f)).sum();
        let targets: f64 = self.targets.iter().map(|target| target.anomaly_nt(time_s)).sum();
        strength_nt + geology_nt * geology + targets
    }

    /// Direction cosines of the field in body axes.
    fn direction_cosines(&self, time_s: f64) -> [f64; 3] {
        let (inclination, declination) =
            (self.field.inclination_deg.to_radians(), self.field.declination_deg.to_radians());
        let (sin_inclination, cos_inclination) = libm::sincos(inclination);
        let (sin_declination, cos_declination) = libm::sincos(declination);
        let north_east_down = [cos_inclination * cos_declination, cos_inclination * sin_declination, sin_inclination];
        self.motion.attitude(time_s).to_body(north_east_down)
    }

    /// `A beta` of eq. (4) with the true time derivative of the direction cosines, nT.
    fn interference_nt(&self, time_s: f64, field_nt: f64) -> f64 {
        /// Half the span of the difference that stands for the derivative, s: its error is of order h^2.
        const HALF_STEP_S: f64 = 1e-3;
        let u = self.direction_cosines(time_s);
        let (before, after) =
            (self.direction_cosines(time_s - HALF_STEP_S), self.direction_cosines(time_s + HALF_STEP_S));
        let rate = std::array::from_fn::<f64, 3, _>(|i| (after[i] - before[i]) / (2.0 * HALF_STEP_S));
        let beta = &self.coefficients;
        let mut interference_nt = u[0] * beta[0] + u[1] * beta[1] + u[2] * beta[2];
        let mut next = 3;
        for i in 0..3 {
            for j in i..3 {
                interference_nt += field_nt * u[i] * u[j] * beta[next];
                next += 1;
            }
        }
        for cosine in u {
            for rate in rate {
                interference_nt += field_nt * cosine * rate * beta[next];
                next += 1;
            }
        }
        interference_nt
    }
}

impl Target {
    /// Anomaly at a time, nT: profile of a vertical dipole passed at constant speed, `(1 - x^2 / 2) / (1 + x^2)^(5/2)`.
    pub fn anomaly_nt(&self, time_s: f64) -> f64 {
        // The profile falls to half its peak at x = 0.41.
        let x = (time_s - self.time_s) / (self.width_s / 2.0) * 0.41;
        self.peak_nt * (1.0 - x * x / 2.0) / libm::pow(1.0 + x * x, 2.5)
    }
}

//! Tows made for these tests alone, from the dipole law and coloured noise; nothing of it is the crate's.

#![allow(dead_code, reason = "each test file uses its own part")]

use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use towmag_survey::contacts::Levelled;
use towmag_survey::navigation::Track;

/// Random numbers.
pub(crate) struct Random(ChaCha8Rng);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    pub(crate) fn uniform(&mut self, from: f64, to: f64) -> f64 {
        self.0.random_range(from..to)
    }

    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// A direction, any alike.
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        let z = self.uniform(-1.0, 1.0);
        let (sin, cos) = self.uniform(0.0, TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        [r * cos, r * sin, z]
    }
}

/// A dipole beside the track of a tow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    /// Way at the closest approach, m.
    pub(crate) along_m: f64,
    pub(crate) distance_m: f64,
    /// From straight down, positive to starboard, rad.
    pub(crate) side_rad: f64,
    /// A m^2, axes (forward, starboard, down).
    pub(crate) moment: [f64; 3],
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Target {
    pub(crate) fn random(random: &mut Random, along_m: f64) -> Self {
        let size = 0.1 * 1000.0_f64.powf(random.uniform(0.0, 1.0));
        let moment = random.direction().map(|x| size * x);
        let side_rad = random.uniform(-1.4, 1.4);
        Self { along_m, distance_m: random.uniform(2.0, 12.0), side_rad, moment }
    }

    pub(crate) fn moment_am2(&self) -> f64 {
        dot(self.moment, self.moment).sqrt()
    }

    /// The dipole law, `mu0 / 4 pi (3 (m . r) r / r^5 - m / r^3) . f`, nT.
    pub(crate) fn anomaly_nt(&self, along_m: f64, field: [f64; 3]) -> f64 {
        let (sin, cos) = self.side_rad.sin_cos();
        let r = [along_m - self.along_m, -self.distance_m * sin, -self.distance_m * cos];
        let square = dot(r, r);
        let length = square.sqrt();
        100.0 * (3.0 * dot(self.moment, r) * dot(r, field) / square - dot(self.moment, field)) / length.powi(3)
    }
}

/// The colours of noise of a tow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Colours {
    pub(crate) white_nt: f64,
    pub(crate) pink_nt: f64,
    pub(crate) swell_nt: f64,
    /// Red, of a minute and slower.
    pub(crate) geology_nt: f64,
    /// By how much the loudest of the time is louder than the quietest, in every band but geology.
    pub(crate) changes: f64,
}

pub(crate) const LAKE: Colours =
    Colours { white_nt: 0.02, pink_nt: 0.02, swell_nt: 0.0, geology_nt: 10.0, changes: 1.0 };
pub(crate) const SEA: Colours = Colours { white_nt: 0.03, pink_nt: 0.05, swell_nt: 0.1, geology_nt: 5.0, changes: 3.0 };

pub(crate) fn noise(random: &mut Random, rows: usize, colours: &Colours) -> Vec<f64> {
    let mut pink = [0.0; 10];
    let (mut swell, mut slower) = ([0.0; 2], [0.0; 3]);
    let changing_s = random.uniform(400.0, 900.0);
    let waves: Vec<[f64; 3]> = (0..20)
        .map(|_| {
            let period_s = random.uniform(60.0, 600.0);
            [TAU / period_s, random.uniform(0.0, TAU), random.normal() * (period_s / 600.0) * colours.geology_nt / 3.0]
        })
        .collect();
    (0..rows + 3000)
        .map(|row| {
            let time_s = row as f64 / 10.0;
            let loud = 1.0 + (colours.changes - 1.0) * (0.5 + 0.5 * (TAU * time_s / changing_s).sin()).powi(2);
            for (k, x) in pink.iter_mut().enumerate() {
                let rate = 0.9 * 0.5_f64.powi(k as i32);
                *x += -rate * *x + (2.0 * rate - rate * rate).sqrt() * random.normal() / 10.0_f64.sqrt();
            }
            // A resonance of 7 s.
            let (decay, angle) = (0.995, TAU * 0.1 / 7.0);
            let (sin, cos) = f64::sin_cos(angle);
            let driven = [
                (1.0_f64 - decay * decay).sqrt() * random.normal(),
                (1.0_f64 - decay * decay).sqrt() * random.normal(),
            ];
            swell = [
                decay * (cos * swell[0] - sin * swell[1]) + driven[0],
                decay * (sin * swell[0] + cos * swell[1]) + driven[1],
            ];
            slower[0] += -slower[0] / 600.0 + random.normal() * (2.0_f64 / 600.0).sqrt();
            slower[1] += (slower[0] - slower[1]) / 200.0;
            slower[2] += (slower[1] - slower[2]) / 200.0;
            let geology: f64 = waves.iter().map(|[w, phase, nt]| nt * (w * time_s + phase).sin()).sum();
            let fast = colours.white_nt * random.normal() + colours.pink_nt * pink.iter().sum::<f64>();
            50_000.0 + loud * (fast + colours.swell_nt * swell[0]) + geology + 0.3 * colours.geology_nt * slower[2]
        })
        .skip(3000)
        .collect()
}

/// A tow on a straight line.
pub(crate) struct Straight {
    pub(crate) time_s: Vec<f64>,
    pub(crate) is_valid: Vec<bool>,
    pub(crate) field_nt: Vec<f64>,
    pub(crate) terms: Vec<[f64; 18]>,
    pub(crate) direction: Vec<[f64; 3]>,
    pub(crate) track: Track,
    pub(crate) targets: Vec<Target>,
}

impl Straight {
    /// Northwards, in noise of some colours, past targets given by a function of the way.
    pub(crate) fn new(random: &mut Random, rows: usize, speed: f64, colours: &Colours, targets: Vec<Target>) -> Self {
        let heading = random.uniform(0.0, TAU);
        let dip = random.uniform(0.9, 1.3);
        let field = [dip.cos() * heading.cos(), -dip.cos() * heading.sin(), dip.sin()];
        let time_s: Vec<f64> = (0..rows).map(|row| row as f64 / 10.0).collect();
        let phase = random.uniform(0.0, TAU);
        // A speed that breathes by a tenth over a minute.
        let along =
            |time_s: f64| speed * (time_s + 0.1 * (60.0 / TAU) * ((TAU * time_s / 60.0 + phase).sin() - phase.sin()));
        let along_m: Vec<f64> = time_s.iter().map(|s| along(*s)).collect();
        let noise = noise(random, rows, colours);
        let signal = |along_m: f64| targets.iter().map(|target| target.anomaly_nt(along_m, field)).sum::<f64>();
        let field_nt = noise.iter().zip(&along_m).map(|(noise, along_m)| noise + signal(*along_m)).collect();
        let track = Track {
            easting_m: vec![0.0; rows],
            northing_m: along_m.clone(),
            speed_m_per_s: vec![speed; rows],
            course_deg: vec![0.0; rows],
            latitude_deg: along_m.iter().map(|m| 45.0 + m / 111_132.0).collect(),
            longitude_deg: vec![10.0; rows],
            along_m,
        };
        let terms = terms(random, &time_s);
        Self { is_valid: vec![true; rows], direction: vec![field; rows], time_s, field_nt, terms, track, targets }
    }

    pub(crate) fn levelled(&self) -> Levelled<'_> {
        Levelled {
            time_s: &self.time_s,
            is_valid: &self.is_valid,
            field_nt: &self.field_nt,
            variance_nt2: None,
            terms: &self.terms,
            direction: &self.direction,
            track: Some(&self.track),
            altitude_m: None,
            depth_m: None,
        }
    }
}

/// Terms that swing with the body.
fn terms(random: &mut Random, time_s: &[f64]) -> Vec<[f64; 18]> {
    let waves: Vec<[f64; 3]> =
        (0..18).map(|_| [TAU / random.uniform(4.0, 9.0), random.uniform(0.0, TAU), random.uniform(0.1, 1.0)]).collect();
    time_s.iter().map(|s| std::array::from_fn(|k| waves[k][2] * (waves[k][0] * s + waves[k][1]).sin())).collect()
}

//! A fluxgate that is off, turned in a homogeneous field: f64, from the equations alone.

use crate::rng::Rng;
use towmag::Epoch;
use towmag::sensors::fluxgate::FluxgateSettings;

pub type Vector = [f64; 3];
pub type Matrix = [Vector; 3];

/// Of the field in mid northern latitudes, north, east and down.
const FIELD: Vector = [0.400, 0.040, 0.916];

/// Readings within the 0.1 s that an epoch is a mean of.
const READINGS: usize = 5;

/// Random numbers.
pub struct Draw(Rng);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(Rng(seed))
    }

    /// Evenly from -1 to 1.
    pub fn even(&mut self) -> f64 {
        self.0.draw() as f64 / u64::MAX as f64 * 2.0 - 1.0
    }

    /// Standard normal, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (0.5 + 0.5 * self.even()).max(1e-300).ln()).sqrt();
        radius * (std::f64::consts::PI * self.even()).cos()
    }

    pub fn direction(&mut self) -> Vector {
        unit([self.normal(), self.normal(), self.normal()])
    }
}

/// A sensor: `count = (axis . field + bias + noise) / scale`, and a scalar sensor beside it.
#[derive(Clone, Copy)]
pub struct TurnedSensor {
    /// The axes, unit vectors in the body's.
    pub axes: Matrix,
    pub bias_nt: Vector,
    pub nt_per_count: Vector,
    pub noise_nt: f64,
    pub scalar_noise_nt: f64,
    /// Magnitude of the field, nT.
    pub field_nt: f64,
    /// A field that sits in the body and that the scalar sensor alone reads, nT in body axes.
    pub scalar_permanent_nt: Vector,
}

/// How the sensor sits in the body: along its axes, or swapped and reversed.
pub const MOUNTINGS: [Matrix; 4] = [
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
    [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
];

impl TurnedSensor {
    /// Off by as much as they come: 2,000 nT, 3 %, 2 degrees between two axes, noise of 0.5 nT.
    pub fn drawn(draw: &mut Draw, mounting: usize) -> Self {
        let nominal = FluxgateSettings::default().nt_per_count;
        let lean = 2_f64.to_radians();
        // Rows: each leans towards the ones before it, which is all that the angles between them know.
        let [a, b, c] = [draw.even() * lean, draw.even() * lean, draw.even() * lean];
        let axes = [[1.0, 0.0, 0.0], unit([a, 1.0, 0.0]), unit([b, c, 1.0])];
        // Sensor axis i lies along the body axis that `body_from_sensor` takes it to.
        let mounting = MOUNTINGS[mounting];
        Self {
            axes: axes.map(|axis| std::array::from_fn(|body| dot(mounting[body], axis))),
            bias_nt: std::array::from_fn(|_| 2_000.0 * draw.even()),
            nt_per_count: nominal.map(|nominal| nominal * (1.0 + 0.03 * draw.even())),
            noise_nt: 0.5,
            scalar_noise_nt: 0.05,
            field_nt: 50_000.0,
            scalar_permanent_nt: [0.0; 3],
        }
    }

    /// Angles between x and y, x and z, y and z, degrees.
    pub fn angles_deg(&self) -> Vector {
        [(0, 1), (0, 2), (1, 2)].map(|(a, b)| dot(self.axes[a], self.axes[b]).acos().to_degrees())
    }

    fn counts(&self, body_nt: Vector) -> Vector {
        std::array::from_fn(|i| (dot(self.axes[i], body_nt) + self.bias_nt[i]) / self.nt_per_count[i])
    }

    /// The counts of a body that points so, without noise, and the field.
    pub fn quiet(&self, attitude: &Attitude) -> (Vector, f64) {
        (self.counts(self.body_nt(attitude)), self.field_nt)
    }

    fn body_nt(&self, attitude: &Attitude) -> Vector {
        attitude.map(|axis| self.field_nt * dot(axis, unit(FIELD)))
    }

    /// Epochs of the body while it turns, made with `settings`. `is_mean`: each the mean of the readings in it, else the
    /// reading in its middle.
    pub fn epochs(&self, turning: &Turning, settings: &FluxgateSettings, is_mean: bool, draw: &mut Draw) -> Vec<Epoch> {
        let fluxgate = settings.build().unwrap();
        let epoch = |(tick, attitudes): (usize, &[Attitude])| {
            let middle = &attitudes[READINGS / 2];
            let attitudes = if is_mean { attitudes } else { std::slice::from_ref(middle) };
            let mut counts: Vector = std::array::from_fn(|i| self.noise_nt * draw.normal() / self.nt_per_count[i]);
            for attitude in attitudes {
                let share = self.counts(self.body_nt(attitude)).map(|count| count / attitudes.len() as f64);
                counts = add(counts, share);
            }
            let permanent_nt = dot(self.scalar_permanent_nt, unit(self.body_nt(middle)));
            let scalar_nt = self.field_nt + permanent_nt + self.scalar_noise_nt * draw.normal();
            Epoch {
                tick: tick as u32,
                scalar_pt: Some((scalar_nt * 1_000.0).round() as i32),
                flux_nt: Some(fluxgate.convert(&counts.map(|count| count as f32))),
            }
        };
        turning.attitudes.chunks_exact(READINGS).enumerate().map(epoch).collect()
    }
}

/// Body axes as rows, in north, east and down.
pub type Attitude = Matrix;

/// What the body is turned through, five attitudes to an epoch.
pub struct Turning {
    pub attitudes: Vec<Attitude>,
    rate_deg_per_s: f64,
}

impl Turning {
    /// A body that lies level.
    pub fn new(rate_deg_per_s: f64) -> Self {
        Self { attitudes: vec![MOUNTINGS[0]], rate_deg_per_s }
    }

    /// Turn on about an axis in the body.
    pub fn about(mut self, axis: Vector, angle_deg: f64) -> Self {
        let step_deg = self.rate_deg_per_s / (10 * READINGS) as f64;
        let steps = (angle_deg / step_deg).abs().round();
        for _ in 0..steps as usize {
            let last = self.attitudes[self.attitudes.len() - 1];
            // In body axes the world turns the other way.
            self.attitudes.push(turned(last, axis, -step_deg.to_radians() * angle_deg.signum()));
        }
        self
    }

    /// For `seconds` at 12 degrees a second, as a person tumbles it: some seconds about one axis, then about another.
    pub fn tumbled(draw: &mut Draw, seconds: usize) -> Self {
        let mut turning = Self::new(12.0);
        while turning.attitudes.len() < seconds * 10 * READINGS {
            turning = turning.about(draw.direction(), 60.0 + 40.0 * draw.even());
        }
        turning.attitudes.truncate(seconds * 10 * READINGS);
        turning
    }

    /// The same, but there and back about the given axes in turn and hardly about others.
    pub fn swung(draw: &mut Draw, axes: &[Vector], angle_deg: f64, seconds: usize) -> Self {
        let mut turning = Self::new(12.0);
        for swing in 0.. {
            if turning.attitudes.len() >= seconds * 10 * READINGS {
                break;
            }
            let axis = unit(add(axes[swing / 2 % axes.len()], draw.direction().map(|part| 0.02 * part)));
            turning = turning.about(axis, if swing % 2 == 0 { angle_deg } else { -angle_deg });
        }
        turning.attitudes.truncate(seconds * 10 * READINGS);
        turning
    }
}

/// The columns of `attitude` turned about `axis` by Rodrigues' formula.
fn turned(attitude: Attitude, axis: Vector, angle_rad: f64) -> Attitude {
    let (sine, cosine) = angle_rad.sin_cos();
    let mut turned = attitude;
    for column in 0..3 {
        let v = attitude.map(|row| row[column]);
        let along = dot(axis, v) * (1.0 - cosine);
        let across = cross(axis, v);
        for row in 0..3 {
            turned[row][column] = v[row] * cosine + across[row] * sine + axis[row] * along;
        }
    }
    turned
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub fn unit(a: Vector) -> Vector {
    let length = norm(a);
    a.map(|part| part / length)
}

fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

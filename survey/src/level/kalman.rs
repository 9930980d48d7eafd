//! The forward pass: a Kalman filter over coefficients and background, and its likelihood.

use super::series::Sample;
use super::terms::{COMBINATIONS, TOLD};

/// Coefficients, then background and its slope.
pub(crate) const STATES: usize = COMBINATIONS + 2;
/// Place of the background among the states.
pub(crate) const BACKGROUND: usize = COMBINATIONS;
/// Place of its slope.
const SLOPE: usize = COMBINATIONS + 1;

pub(crate) type Vector = [f64; STATES];
pub(crate) type Matrix = [[f64; STATES]; STATES];

/// How far coefficients may be from zero, nT at 50,000 nT: a magnet beside the sensor. Large enough that no recording with
/// manoeuvres feels it, small enough that f64 keeps nine digits of the variance.
const COEFFICIENT_STD: f64 = 3_000.0;
/// Of a coefficient that is left out; not zero, so that a covariance keeps its inverse.
const LEFT_OUT_STD: f64 = 1e-3;
/// How far a background may be from the first reading, nT, and its slope from none, nT/s.
const BACKGROUND_STD_NT: f64 = 1_000.0;
const SLOPE_STD_NT_PER_S: f64 = 10.0;

/// Variance of the reading's noise, and powers of what moves, all over that variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Model {
    /// Of the reading's noise, nT^2.
    pub(crate) noise_nt2: f64,
    /// Of the background's random steps, 1/s.
    pub(crate) background: f64,
    /// Of the random steps of its slope, 1/s^3.
    pub(crate) slope: f64,
    /// Of the coefficients' random steps, 1/s.
    pub(crate) coefficients: f64,
}

/// Mean and covariance of the coefficients before the first row.
#[derive(Clone, Debug)]
pub(crate) struct Start {
    pub(crate) mean: [f64; COMBINATIONS],
    pub(crate) covariance: [[f64; COMBINATIONS]; COMBINATIONS],
}

impl Start {
    /// Nothing is known.
    pub(crate) fn unknown() -> Self {
        let mut covariance = [[0.0; COMBINATIONS]; COMBINATIONS];
        (0..COMBINATIONS).for_each(|k| covariance[k][k] = COEFFICIENT_STD * COEFFICIENT_STD);
        Self { mean: [0.0; COMBINATIONS], covariance }
    }
}

impl Start {
    /// Known to be near zero: each within `std`.
    pub(crate) fn near_zero(std: f64) -> Self {
        let mut start = Self::unknown();
        (0..COMBINATIONS).for_each(|k| start.covariance[k][k] = std * std);
        start
    }

    /// With what a fluxgate does of its own left out.
    pub(crate) fn without_fluxgate(mut self) -> Self {
        (TOLD..COMBINATIONS).for_each(|k| self.covariance[k][k] = LEFT_OUT_STD * LEFT_OUT_STD);
        self
    }
}

/// The filter between two rows.
#[derive(Clone, Debug)]
pub(crate) struct Filter {
    pub(crate) mean: Vector,
    pub(crate) covariance: Matrix,
}

/// What a reading does to the filter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Update {
    /// Reading less its prediction, nT.
    pub(crate) innovation_nt: f64,
    /// Its variance, nT^2.
    pub(crate) variance_nt2: f64,
    /// Covariance of the state with the prediction; over the variance it is the gain.
    pub(crate) covariance_nt: Vector,
}

impl Filter {
    /// Before the first row; the background is where that reading is.
    pub(crate) fn new(start: &Start) -> Self {
        let (mut mean, mut covariance) = ([0.0; STATES], [[0.0; STATES]; STATES]);
        mean[..COMBINATIONS].copy_from_slice(&start.mean);
        for (row, of_start) in covariance.iter_mut().zip(&start.covariance) {
            row[..COMBINATIONS].copy_from_slice(of_start);
        }
        Self { mean, covariance }
    }

    /// To the time of the next row, where something may begin.
    pub(crate) fn predict(&mut self, sample: &Sample, model: &Model) {
        let step_s = sample.step_s;
        if sample.begins {
            self.begin_background(sample.scalar_nt);
        } else {
            self.drift_background(step_s, model);
        }
        if sample.moved {
            (0..TOLD).for_each(|k| self.forget(k, COEFFICIENT_STD));
        }
        // What the fluxgate does of its own does not change.
        for k in 0..TOLD {
            self.covariance[k][k] += model.coefficients * model.noise_nt2 * step_s;
        }
    }

    fn begin_background(&mut self, scalar_nt: f64) {
        for (place, mean, std) in [(BACKGROUND, scalar_nt, BACKGROUND_STD_NT), (SLOPE, 0.0, SLOPE_STD_NT_PER_S)] {
            self.forget(place, std);
            self.mean[place] = mean;
        }
    }

    fn forget(&mut self, place: usize, std: f64) {
        self.covariance[place] = [0.0; STATES];
        self.covariance.iter_mut().for_each(|row| row[place] = 0.0);
        self.covariance[place][place] = std * std;
    }

    fn drift_background(&mut self, step_s: f64, model: &Model) {
        self.mean[BACKGROUND] += step_s * self.mean[SLOPE];
        let slope = self.covariance[SLOPE];
        (0..STATES).for_each(|k| self.covariance[BACKGROUND][k] += step_s * slope[k]);
        for row in &mut self.covariance {
            row[BACKGROUND] += step_s * row[SLOPE];
        }
        let slope_nt2 = model.slope * model.noise_nt2;
        self.covariance[BACKGROUND][BACKGROUND] +=
            model.background * model.noise_nt2 * step_s + slope_nt2 * step_s.powi(3) / 3.0;
        self.covariance[BACKGROUND][SLOPE] += 0.5 * slope_nt2 * step_s * step_s;
        self.covariance[SLOPE][BACKGROUND] += 0.5 * slope_nt2 * step_s * step_s;
        self.covariance[SLOPE][SLOPE] += slope_nt2 * step_s;
    }

    /// To the next row, and learn from it.
    pub(crate) fn step(&mut self, sample: &Sample, model: &Model) -> Update {
        self.predict(sample, model);
        self.update(sample, model)
    }

    fn update(&mut self, sample: &Sample, model: &Model) -> Update {
        let of = |vector: &Vector| dot(vector, &sample.columns) + vector[BACKGROUND];
        let covariance_nt: Vector = std::array::from_fn(|k| of(&self.covariance[k]));
        let variance_nt2 = of(&covariance_nt) + model.noise_nt2 * sample.variance_ratio;
        let innovation_nt = sample.scalar_nt - of(&self.mean);
        for i in 0..STATES {
            let gain = covariance_nt[i] / variance_nt2;
            self.mean[i] += gain * innovation_nt;
            for (cell, with) in self.covariance[i].iter_mut().zip(&covariance_nt) {
                *cell -= gain * with;
            }
        }
        Update { innovation_nt, variance_nt2, covariance_nt }
    }
}

/// Product of the coefficients' part of a state with weights.
pub(crate) fn dot(state: &Vector, weights: &[f64; COMBINATIONS]) -> f64 {
    state.iter().zip(weights).map(|(a, b)| a * b).sum()
}

/// The logarithm of the likelihood, and the variance of the reading's noise that makes it largest, nT^2, with all powers in
/// proportion to it.
pub(crate) fn likelihood(samples: &[Sample], start: &Start, model: &Model) -> (f64, f64) {
    let mut filter = Filter::new(start);
    let (mut rows, mut squares, mut logs) = (0.0, 0.0, 0.0);
    for sample in samples {
        let update = filter.step(sample, model);
        rows += 1.0;
        squares += update.innovation_nt.powi(2) / update.variance_nt2;
        logs += (update.variance_nt2 / model.noise_nt2).ln();
    }
    let noise_nt2 = model.noise_nt2 * squares / f64::max(rows, 1.0);
    (-0.5 * (rows * noise_nt2.ln() + logs), noise_nt2)
}

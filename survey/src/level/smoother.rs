//! The backward pass: a fixed-interval smoother (de Jong, Smoothing and interpolation with the state-space model, JASA 84,
//! 1989), with the statistics of shocks (de Jong and Penzer, Diagnosing shocks in time series, JASA 93, 1998).

use nalgebra::{Cholesky, SMatrix, SVector};

use super::kalman::{BACKGROUND, Filter, Matrix, Model, STATES, Start, Update, Vector, dot};
use super::series::Sample;
use super::terms::{COMBINATIONS, TOLD};

/// What is known of a row after all of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smoothed {
    /// Coefficients, background and its slope.
    pub(crate) state: Vector,
    /// What the reading is off all others, in standard deviations.
    pub(crate) off: f64,
    /// Twice the logarithm of the likelihood ratio of a move of the coefficients at this row, where that was asked for.
    pub(crate) move_glrt: f64,
}

impl Smoothed {
    /// Interference for some columns, nT.
    pub(crate) fn interference_nt(&self, columns: &[f64; COMBINATIONS]) -> f64 {
        dot(&self.state, columns)
    }
}

/// Smooth. `move_every` says at which rows moves are looked for.
pub(crate) fn smooth(samples: &[Sample], start: &Start, model: &Model, move_every: Option<usize>) -> Vec<Smoothed> {
    let mut filter = Filter::new(start);
    let updates: Vec<Update> = samples.iter().map(|sample| filter.step(sample, model)).collect();
    let mut later = Later::none();
    let mut smoothed: Vec<Smoothed> = Vec::with_capacity(samples.len());
    for (row, (sample, update)) in samples.iter().zip(&updates).enumerate().rev() {
        let off = later.include(sample, update);
        let is_looked_at = move_every.is_some_and(|every| row.is_multiple_of(every));
        let move_glrt = if is_looked_at { later.move_glrt() } else { 0.0 };
        smoothed.push(Smoothed { state: later.score, off, move_glrt });
        later.step_back(sample);
    }
    smoothed.reverse();
    states_of_scores(samples, start, model, &mut smoothed);
    smoothed
}

/// From the scores to the states: each is the one before, moved by what its random step is expected to have been.
fn states_of_scores(samples: &[Sample], start: &Start, model: &Model, smoothed: &mut [Smoothed]) {
    let mut before = Filter::new(start);
    for (row, (sample, smoothed)) in samples.iter().zip(smoothed).enumerate() {
        // A filter that is certain of the row before has the covariance of the random step after its prediction.
        if row > 0 {
            before.covariance = [[0.0; STATES]; STATES];
        }
        before.predict(sample, model);
        let step = product(&before.covariance, &smoothed.state);
        (0..STATES).for_each(|k| before.mean[k] += step[k]);
        smoothed.state = before.mean;
    }
}

/// Score and information of the state that all later rows give.
struct Later {
    score: Vector,
    information: Matrix,
}

impl Later {
    fn none() -> Self {
        Self { score: [0.0; STATES], information: [[0.0; STATES]; STATES] }
    }

    /// Include a row. Returns its disturbance over its standard deviation.
    fn include(&mut self, sample: &Sample, update: &Update) -> f64 {
        let gain = update.covariance_nt.map(|covariance| covariance / update.variance_nt2);
        let gained = product(&self.information, &gain);
        let along = inner(&gain, &gained);
        let disturbance = update.innovation_nt / update.variance_nt2 - inner(&gain, &self.score);
        let variance = 1.0 / update.variance_nt2 + along;
        let row = |k: usize| if k < COMBINATIONS { sample.columns[k] } else { f64::from(u8::from(k == BACKGROUND)) };
        let row: Vector = std::array::from_fn(row);
        for i in 0..STATES {
            self.score[i] += row[i] * disturbance;
            for k in 0..STATES {
                self.information[i][k] += row[i] * row[k] * variance - row[i] * gained[k] - gained[i] * row[k];
            }
        }
        disturbance / variance.sqrt()
    }

    /// Back to just after the row before.
    fn step_back(&mut self, sample: &Sample) {
        if sample.moved {
            self.forget(0..TOLD);
        }
        if sample.begins {
            self.forget(COMBINATIONS..STATES);
            return;
        }
        let step_s = sample.step_s;
        self.score[BACKGROUND + 1] += step_s * self.score[BACKGROUND];
        let background = self.information[BACKGROUND];
        (0..STATES).for_each(|k| self.information[BACKGROUND + 1][k] += step_s * background[k]);
        self.information.iter_mut().for_each(|row| row[BACKGROUND + 1] += step_s * row[BACKGROUND]);
    }

    fn forget(&mut self, places: std::ops::Range<usize>) {
        for place in places {
            self.score[place] = 0.0;
            self.information[place] = [0.0; STATES];
            self.information.iter_mut().for_each(|row| row[place] = 0.0);
        }
    }

    /// Twice the logarithm of the likelihood ratio of coefficients that change here.
    fn move_glrt(&self) -> f64 {
        let information = SMatrix::<f64, COMBINATIONS, COMBINATIONS>::from_fn(|i, k| self.information[i][k]);
        let largest = information.diagonal().max();
        let ridge = SMatrix::identity() * (1e-9 * largest);
        let score = SVector::<f64, COMBINATIONS>::from_fn(|k, _| self.score[k]);
        Cholesky::new(information + ridge).map_or(0.0, |factor| score.dot(&factor.solve(&score)))
    }
}

fn inner(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn product(matrix: &Matrix, vector: &Vector) -> Vector {
    std::array::from_fn(|k| inner(&matrix[k], vector))
}

//! What the fluxgate's noise adds to the variance of the residual.

use super::variance::{innovation_variance, squares};
use super::whitening::Whitening;
use crate::diagnosis::policy::{BETWEEN_ROWS_MOST_PER_S, DIRECTION_LEAST_GLRT, DIRECTION_MOST};
use crate::diagnosis::reconstruct::direction_noise::DirectionNoise;
use crate::diagnosis::reconstruct::tangent_plane::sixth_difference;
use crate::simulator::signals::{Signals, tolles_lawson};

/// Steps of the fit.
const STEPS: usize = 100;
/// The white part of the variance is at least this share of the mean, or nothing would be left to compare with.
const LEAST_WHITE_SHARE: f64 = 1e-3;

/// Noise of the direction in a whitened residual.
#[derive(Clone, Debug)]
pub(crate) struct DirectionGrowth {
    /// One factor a sample, their mean 1, by which its variance differs from that of all.
    pub(crate) growth: Vec<f64>,
    /// Variance of the noise that the smoothing leaves, over that of the draws of it.
    pub(crate) of_draws: f64,
}

/// How the variance of each sample grows by the fluxgate's noise, as draws of it say, and by the motion that its smoothing misses. Both
/// enter through the 18 terms, more on some headings than on others.
///
/// `residual_whitened` is whitened without weights. What is more than the noise of the recorded direction can make is no noise of the
/// direction. `None` when the data do not ask for it.
pub(crate) fn direction_growth(
    signals: &Signals,
    whitening: &Whitening,
    residual_whitened: &[f64],
    noise: &DirectionNoise,
) -> Option<DirectionGrowth> {
    let squares = squares(residual_whitened, None);
    let mean = mean(&squares);
    let shapes: Vec<Shape> =
        [of_draws(signals, whitening, noise), between_rows(signals, whitening)].into_iter().flatten().collect();
    if shapes.is_empty() || mean <= 0.0 {
        return None;
    }
    let mut model = VarianceModel::new(shapes, mean);
    for _ in 0..STEPS {
        model.update(&squares);
    }
    let variances = model.variances(squares.len());
    (glrt_over_equal(&squares, &variances) > DIRECTION_LEAST_GLRT)
        .then(|| DirectionGrowth { growth: over_mean(&variances), of_draws: model.of_draws() })
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn over_mean(values: &[f64]) -> Vec<f64> {
    let mean = mean(values);
    values.iter().map(|value| value / mean).collect()
}

/// Twice the log likelihood ratio of variances of normal samples over one for all of them.
fn glrt_over_equal(squares: &[f64], variances: &[f64]) -> f64 {
    let n = squares.len() as f64;
    let deviance = squares.iter().zip(variances).map(|(square, m)| square / m + m.ln()).sum::<f64>();
    n * mean(squares).ln() + n - deviance
}

/// A known course of the variance over the samples, its mean 1, and how much of it there may be at most.
struct Shape {
    course: Vec<f64>,
    most: f64,
    /// What the mean was; none of a course that no draw has.
    of_draws: Option<f64>,
}

/// The variance of the noise that the smoothing leaves.
fn of_draws(signals: &Signals, whitening: &Whitening, noise: &DirectionNoise) -> Option<Shape> {
    let coefficients = signals.coefficients();
    let variance = noise.variance(signals, coefficients, |column| whitening.apply(column));
    let mean = mean(&variance);
    shape(&variance, mean * DIRECTION_MOST, Some(mean))
}

/// The variance of what the rows cannot resolve.
fn between_rows(signals: &Signals, whitening: &Whitening) -> Option<Shape> {
    let variance = innovation_variance(whitening, &between_rows_nt2(signals));
    shape(&variance, mean(&variance) * BETWEEN_ROWS_MOST_PER_S * BETWEEN_ROWS_MOST_PER_S, None)
}

/// None of what does not show on this recording.
fn shape(variance: &[f64], most: f64, of_draws: Option<f64>) -> Option<Shape> {
    let mean = mean(variance);
    (mean > 0.0 && mean.is_finite()).then(|| Shape { course: over_mean(variance), most, of_draws })
}

/// The variance of each sample as `white` plus shapes times amplitudes: its likeliest values for normal samples.
struct VarianceModel {
    shapes: Vec<Shape>,
    white: f64,
    amplitudes: Vec<f64>,
    least_white: f64,
}

impl VarianceModel {
    /// To start from: half of the mean square to the white part, half to the shapes.
    fn new(shapes: Vec<Shape>, mean_square: f64) -> Self {
        let share = 0.5 * mean_square / shapes.len() as f64;
        let amplitudes = shapes.iter().map(|shape| share.min(shape.most)).collect();
        Self { shapes, white: 0.5 * mean_square, amplitudes, least_white: LEAST_WHITE_SHARE * mean_square }
    }

    fn variances(&self, samples: usize) -> Vec<f64> {
        let mut variances = vec![self.white; samples];
        for (amplitude, shape) in self.amplitudes.iter().zip(&self.shapes) {
            variances.iter_mut().zip(&shape.course).for_each(|(m, v)| *m += amplitude * v);
        }
        variances
    }

    /// Variance of the noise that the smoothing leaves, over that of its draws; 0 without any.
    fn of_draws(&self) -> f64 {
        let of = |(amplitude, shape): (&f64, &Shape)| shape.of_draws.map(|mean| amplitude / mean);
        self.amplitudes.iter().zip(&self.shapes).find_map(of).unwrap_or(0.0)
    }

    /// One multiplicative step of all amplitudes, each by the root of the ratio of the two parts of the likelihood's
    /// gradient (as in non-negative matrix factorisation by the Itakura-Saito divergence, Fevotte and Idier 2011): nothing
    /// becomes negative, and the likelihood never falls.
    fn update(&mut self, squares: &[f64]) {
        let variances = self.variances(squares.len());
        let pull: Vec<f64> = squares.iter().zip(&variances).map(|(square, m)| square / (m * m)).collect();
        let root = |up: f64, down: f64| (up / down.max(f64::MIN_POSITIVE)).sqrt();
        let factor = |course: &[f64]| {
            let up: f64 = pull.iter().zip(course).map(|(p, v)| p * v).sum();
            root(up, variances.iter().zip(course).map(|(m, v)| v / m).sum())
        };
        let of_white = root(pull.iter().sum(), variances.iter().map(|m| 1.0 / m).sum());
        self.white = (self.white * of_white).max(self.least_white);
        for (amplitude, shape) in self.amplitudes.iter_mut().zip(&self.shapes) {
            *amplitude = (*amplitude * factor(&shape.course)).min(shape.most);
        }
    }
}

/// Squared change of the interference with an error of the rate, nT^2 s^2, at rows where the motion has what rows at 10 Hz
/// cannot resolve, which the sixth difference of the direction shows: where a hand or a wave sets in, the rate is off for
/// a row or two.
fn between_rows_nt2(signals: &Signals) -> Vec<f64> {
    let sharpness = squared_sixth_differences(&signals.rows().direction);
    let n = sharpness.len();
    let [_, _, _, x, y, z] = squared_slopes(signals);
    let beside = |row: usize| sharpness[row.saturating_sub(1)..(row + 2).min(n)].iter().copied().fold(0.0, f64::max);
    (0..n).map(|row| (x[row] + y[row] + z[row]) * beside(row)).collect()
}

/// Of the seven directions about each row; 0 within three rows of the ends.
fn squared_sixth_differences(direction: &[[f64; 3]]) -> Vec<f64> {
    let at = |row: usize| {
        let Some(near) = row.checked_sub(3).and_then(|first| direction.get(first..row + 4)) else { return 0.0 };
        sixth_difference(near).into_iter().map(|component| component * component).sum()
    };
    (0..direction.len()).map(at).collect()
}

/// Squared change of the interference at each row with each component of an error of the direction across it (nT^2),
/// then of its rate (nT^2 s^2).
pub(crate) fn squared_slopes(signals: &Signals) -> [Vec<f64>; 6] {
    let rows = signals.rows();
    let at = |row: usize| -> [f64; 6] {
        let c = rows.direction[row];
        let slopes = tolles_lawson::slopes(signals.coefficients(), rows.field_nt[row], c);
        let across = |v: [f64; 3]| {
            let along = v[0] * c[0] + v[1] * c[1] + v[2] * c[2];
            [0, 1, 2].map(|k| (v[k] - along * c[k]).powi(2))
        };
        let ([a, b, c], [d, e, f]) = (across(slopes.by_direction_nt), across(slopes.by_rate_nt_s));
        [a, b, c, d, e, f]
    };
    let all: Vec<[f64; 6]> = (0..signals.len()).map(at).collect();
    [0, 1, 2, 3, 4, 5].map(|k| all.iter().map(|squares| squares[k]).collect())
}

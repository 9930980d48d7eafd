//! What is left, folded over periods whose harmonics stand out.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::explained;
use crate::diagnosis::search::tone::transform;

/// Rows per second.
pub(crate) const RATE_HZ: f64 = 10.0;
/// Periods that are looked for, s; the longest also not above a third of the recording.
const PERIODS_S: [f64; 2] = [1.0, 300.0];
/// Numbers of harmonics that are added up.
const HARMONICS: [usize; 4] = [1, 3, 6, 12];
/// Periods that are folded, of each number of harmonics.
const FOLDED: usize = 4;
/// Shares of a period that are tried first.
const DUTIES: [f64; 9] = [0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7];
/// Median of chi-squared with six degrees of degrees of freedom.
const MEDIAN_OF_SIX: f64 = 5.348;
/// Parts of a period that a fold tells apart, at most: with a few duties, and with every one.
const BINS: usize = 100;
const FINE_BINS: usize = 300;
/// Duties of a period that are fitted.
const KEPT: usize = 2;
/// Steps of the spectrum on either side over which its level is taken.
const LEVEL_STEPS: usize = 60;

/// A period with its best phase and duty.
pub(crate) struct Fold {
    pub(crate) glrt: f64,
    pub(crate) period_s: f64,
    pub(crate) duty: f64,
    pub(crate) phase: f64,
}

/// What is left times each cosine of the direction, ready to be folded.
pub(crate) struct Folds<'a> {
    problem: &'a RegressionProblem<'a>,
    left: Vec<[f64; 3]>,
    /// Inverse of the mean products of the cosines.
    inverse: Matrix3<f64>,
    samples: f64,
}

impl<'a> Folds<'a> {
    pub(crate) fn new(problem: &'a RegressionProblem<'a>, fit: &Fit) -> Self {
        let adjoint = problem.whitening.transposed(&fit.residual_whitened, problem.signals.len());
        let direction = &problem.signals.rows().direction;
        let left = adjoint.iter().zip(direction).map(|(left, c)| c.map(|cosine| cosine * left)).collect();
        let samples = problem.whitening.samples() as f64;
        let mean = |i: usize, j: usize| {
            problem.whitening.rows().map(|row| direction[row][i] * direction[row][j]).sum::<f64>() / samples
        };
        Self { problem, left, inverse: pseudo_inverse(&DMatrix::from_fn(3, 3, mean)), samples }
    }

    /// Periods whose harmonics stand out.
    pub(crate) fn periods_s(&self) -> Vec<f64> {
        let epochs_s = self.problem.signals.epochs_s();
        let component = |i: usize| transform(&self.left.iter().map(|left| left[i]).collect::<Vec<_>>(), epochs_s);
        let [(step_hz, x), (_, y), (_, z)] = [0, 1, 2].map(component);
        let half = x.len() / 2;
        let powers: Vec<f64> = (0..half)
            .map(|k| {
                let parts = [Vector3::new(x[k].re, y[k].re, z[k].re), Vector3::new(x[k].im, y[k].im, z[k].im)];
                let squares: f64 = parts.iter().map(|part| part.dot(&(self.inverse * part))).sum();
                let response = self.problem.whitening.predictor().response(k as f64 * step_hz / RATE_HZ);
                2.0 * squares / (self.samples * response)
            })
            .collect();
        let powers = levelled(&powers);
        let longest_s = PERIODS_S[1].min(self.problem.duration_s() / 3.0);
        let (from, to) =
            ((1.0 / longest_s / step_hz).ceil() as usize, ((1.0 / PERIODS_S[0] / step_hz) as usize).min(half));
        let mut periods = Vec::new();
        for count in HARMONICS {
            let mut scores: Vec<(f64, f64)> = (4 * from.max(1)..4 * to)
                .map(|quarter| {
                    // Quarters of a step: the harmonics multiply what the fundamental is off.
                    let fundamental = 0.25 * quarter as f64;
                    let harmonics = (1..=count).map(|h| (fundamental * h as f64).round() as usize);
                    let used: Vec<usize> = harmonics.take_while(|&k| k < half).collect();
                    let sum: f64 = used.iter().map(|&k| powers[k]).sum();
                    ((sum - 6.0 * used.len() as f64) / (used.len() as f64).sqrt(), 1.0 / (fundamental * step_hz))
                })
                .collect();
            scores.sort_by(|a, b| b.0.total_cmp(&a.0));
            let mut taken: Vec<f64> = Vec::new();
            for (_, period_s) in scores {
                if taken.iter().all(|other| (other / period_s - 1.0).abs() > 0.5 * period_s / self.problem.duration_s())
                {
                    taken.push(period_s);
                }
                if taken.len() == FOLDED {
                    break;
                }
            }
            periods.extend(taken);
        }
        periods
    }

    /// The best folds of a few duties at a period, or so near to it that the ends of the recording move by less than a
    /// row.
    pub(crate) fn best_near(&self, period_s: f64) -> Vec<Fold> {
        let step = 0.1 * period_s / self.problem.duration_s();
        let bins = ((period_s * RATE_HZ).round() as usize).clamp(4, BINS);
        let widths = DUTIES.map(|duty| (duty * bins as f64).round() as usize);
        let shapes = self.shapes(period_s, bins, widths.into_iter().filter(|width| (1..bins).contains(width)));
        let mut best: Vec<Fold> = Vec::new();
        for k in -12..=12 {
            let folds = self.folds(period_s + 0.5 * f64::from(k) * step, bins, &shapes);
            if best.is_empty() {
                best = folds;
            } else {
                let better = best.iter_mut().zip(folds).filter(|(best, fold)| fold.glrt > best.glrt);
                better.for_each(|(best, fold)| *best = fold);
            }
        }
        kept(best)
    }

    /// The best folds of all duties at a period.
    pub(crate) fn every_duty(&self, period_s: f64) -> Vec<Fold> {
        let bins = ((period_s * RATE_HZ).round() as usize).clamp(4, FINE_BINS);
        kept(self.folds(period_s, bins, &self.shapes(period_s, bins, 1..=bins / 2)))
    }

    /// Widths of pulses, bins, with the whitened power of their train.
    fn shapes(&self, period_s: f64, bins: usize, widths: impl Iterator<Item = usize>) -> Vec<(usize, f64)> {
        widths.map(|width| (width, self.power(period_s, width as f64 / bins as f64))).collect()
    }

    /// The best phase of each duty, given as bins and whitened power, at a period.
    fn folds(&self, period_s: f64, bins: usize, shapes: &[(usize, f64)]) -> Vec<Fold> {
        let mut sums = vec![[0.0; 3]; 2 * bins + 1];
        let mut folded = vec![[0.0; 3]; bins];
        for (left, time_s) in self.left.iter().zip(self.problem.signals.epochs_s()) {
            let cycles = time_s / period_s;
            let bin = (((cycles - cycles.floor()) * bins as f64) as usize).min(bins - 1);
            (0..3).for_each(|i| folded[bin][i] += left[i]);
        }
        for k in 0..2 * bins {
            for i in 0..3 {
                sums[k + 1][i] = sums[k][i] + folded[k % bins][i];
            }
        }
        let of_shape = |&(width, power): &(usize, f64)| {
            let glrt = |start: usize| {
                let q = Vector3::from_fn(|i, _| sums[start + width][i] - sums[start][i]);
                q.dot(&(self.inverse * q)) / power
            };
            let (start, glrt) =
                (0..bins).map(|start| (start, glrt(start))).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
            let phase = (1.0 - start as f64 / bins as f64).rem_euclid(1.0);
            Fold { glrt, period_s, duty: width as f64 / bins as f64, phase }
        };
        shapes.iter().map(of_shape).collect()
    }

    /// Whitened power of a unit pulse train, by its harmonics.
    fn power(&self, period_s: f64, duty: f64) -> f64 {
        let mut power = 0.0;
        let last = ((0.5 * RATE_HZ * period_s) as usize).min(200);
        for h in 1..=last {
            let amplitude = 2.0 * (std::f64::consts::PI * h as f64 * duty).sin() / (std::f64::consts::PI * h as f64);
            let hz = h as f64 / period_s;
            // The background takes what is below 0.05 Hz.
            let kept = if hz > 0.05 { 1.0 } else { 0.02 };
            power += 0.5 * amplitude * amplitude * kept * self.problem.whitening.predictor().response(hz / RATE_HZ);
        }
        (power * self.samples).max(f64::MIN_POSITIVE)
    }
}

fn kept(mut folds: Vec<Fold>) -> Vec<Fold> {
    folds.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
    folds.truncate(KEPT);
    folds
}

/// Powers over the level around them, where that is above the one of noise, 6: what is broad hides what is sharp.
fn levelled(powers: &[f64]) -> Vec<f64> {
    (0..powers.len())
        .map(|k| {
            let mut near = powers[k.saturating_sub(LEVEL_STEPS)..(k + LEVEL_STEPS + 1).min(powers.len())].to_vec();
            let middle = near.len() / 2;
            let median = *near.select_nth_unstable_by(middle, f64::total_cmp).1;
            powers[k] / (median / MEDIAN_OF_SIX).max(1.0)
        })
        .collect()
}

fn pseudo_inverse(matrix: &DMatrix<f64>) -> Matrix3<f64> {
    let unit = |k: usize| DVector::from_fn(3, |i, _| f64::from(u8::from(i == k)));
    Matrix3::from_columns(&[0, 1, 2].map(|k| Vector3::from_column_slice(explained(matrix, &unit(k)).1.as_slice())))
}

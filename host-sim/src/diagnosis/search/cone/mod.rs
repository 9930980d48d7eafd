//! `dead_zone`: variance larger within a cone, in either sense of its axis.

mod climb;
mod geometry;

use rayon::prelude::*;

use crate::diagnosis::noise::direction::squared_slopes;
use crate::diagnosis::noise::variance::{VarianceFit, deviance, fit_variance, innovation_variance, scale, squares};
use crate::diagnosis::numerics::golden_section_minimum;
use crate::diagnosis::policy::{
    CONE_HALF_LEAST_GLRT, CONE_LEAST_GLRT, CONE_LEAST_SAMPLES, CONE_SLOPES_MOST_GLRT, CONE_SLOPES_MOST_SHARE,
    CONE_TRIALS, CONE_WIDEST_DEG, VARIANCE_LEAST_GROWTH,
};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::Candidate;
use crate::diagnosis::search::axis::{axis, half_sphere};
use climb::{Likelihood, drawn_about, step_by_step};
use geometry::{Cone, HALF_ANGLE_STEP_DEG, cosine};

/// Axes that are tried first.
const AXES: usize = 300;
/// Bracket of `ln kappa` on either side of where it starts: without and with a cone near by to start from.
const LOG_KAPPA_REACH: [f64; 2] = [6.0, 0.7];
/// Width of the last bracket: the likelihood of a cone need not be known better to choose one.
const LOG_KAPPA_TOLERANCE: f64 = 0.1;
/// Rows that count as the same time where a cone is met in one half of the recording alone: ten seconds.
const TURN_ROWS: usize = 100;

/// The best cone, if the variance is larger within it and nothing else makes it so. `last` is what was
/// found before, with another noise model.
pub(crate) fn scan(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    effect: usize,
    last: Option<&Candidate>,
) -> Option<Candidate> {
    let search = ConeSearch::new(problem, fit, last.and_then(Candidate::growth));
    let (glrt, coarse) = search.coarse();
    if glrt < CONE_LEAST_GLRT {
        return None;
    }
    let cone = search.best(coarse, last.map(|last| &last.term.at[..]));
    search.candidate(cone, effect)
}

/// Squares of some samples: how many, and their sum.
#[derive(Clone, Copy, Debug, Default)]
struct Squares {
    count: f64,
    sum: f64,
}

impl Squares {
    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    fn add(&mut self, square: f64) {
        *self = Self { count: self.count + 1.0, sum: self.sum + square };
    }
}

/// Twice the log likelihood ratio of a variance of their own for those inside; 0 unless it is the larger one.
fn glrt_of_two(inside: Squares, outside: Squares) -> f64 {
    if inside.mean() <= outside.mean() {
        return 0.0;
    }
    let all = Squares { count: inside.count + outside.count, sum: inside.sum + outside.sum };
    all.count * all.mean().ln() - inside.count * inside.mean().ln() - outside.count * outside.mean().ln()
}

/// The samples of a residual, among which a cone is looked for.
struct ConeSearch<'a> {
    problem: &'a RegressionProblem<'a>,
    squares: Vec<f64>,
    /// Direction of each sample.
    directions: Vec<[f64; 3]>,
}

impl<'a> ConeSearch<'a> {
    fn new(problem: &'a RegressionProblem<'a>, fit: &Fit, growth: Option<&[f64]>) -> Self {
        let direction = &problem.signals.rows().direction;
        let directions = problem.whitening.rows().map(|row| direction[row]).collect();
        Self { problem, squares: squares(&fit.residual_whitened, growth), directions }
    }

    /// The best cone near the coarse one; where one was found before (azimuth, elevation and half angle, degrees), the
    /// better of the two by small steps.
    fn best(&self, coarse: Cone, last: Option<&[f64]>) -> Cone {
        let likelihood = |cone: Cone, near: Option<f64>| self.likelihood(cone, near);
        let closer = drawn_about(coarse, likelihood);
        let Some(last) = last else { return closer };
        let last = Cone { axis: axis(last[0], last[1]), half_angle_deg: last[2] };
        let (first, other) = (step_by_step(closer, likelihood), step_by_step(last, likelihood));
        if first.0.total_cmp(&other.0).is_gt() { first.1 } else { other.1 }
    }

    /// The best of evenly spread axes and its likelihood ratio, as if whitening left noise where it was.
    fn coarse(&self) -> (f64, Cone) {
        let of_axis = |(azimuth_deg, elevation_deg)| {
            let axis = axis(azimuth_deg, elevation_deg);
            let (glrt, half_angle_deg) = self.best_angle(axis);
            (glrt, Cone { axis, half_angle_deg })
        };
        let none = (0.0, Cone { axis: [1.0, 0.0, 0.0], half_angle_deg: HALF_ANGLE_STEP_DEG });
        let axes: Vec<(f64, f64)> = half_sphere(AXES).collect();
        let tried: Vec<(f64, Cone)> = axes.into_par_iter().map(of_axis).collect();
        tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or(none)
    }

    /// Likelihood ratio and half angle, degrees, of the best cone about an axis.
    fn best_angle(&self, axis: [f64; 3]) -> (f64, f64) {
        let (n, all) = (self.squares.len() as f64, self.squares.iter().sum::<f64>());
        let mut inside = Squares::default();
        let mut best = (0.0, HALF_ANGLE_STEP_DEG);
        for (bin, squares) in self.by_angle(axis).iter().enumerate() {
            inside.count += squares.count;
            inside.sum += squares.sum;
            if inside.count < CONE_LEAST_SAMPLES || n - inside.count < CONE_LEAST_SAMPLES {
                continue;
            }
            let glrt = glrt_of_two(inside, Squares { count: n - inside.count, sum: all - inside.sum });
            if glrt > best.0 {
                best = (glrt, (bin + 1) as f64 * HALF_ANGLE_STEP_DEG);
            }
        }
        best
    }

    /// The squares by their angle to an axis, in steps of the half angle, as far as the widest cone goes.
    fn by_angle(&self, axis: [f64; 3]) -> Vec<Squares> {
        let bins = (CONE_WIDEST_DEG / HALF_ANGLE_STEP_DEG) as usize;
        let mut histogram = vec![Squares::default(); bins];
        let outside = (CONE_WIDEST_DEG + HALF_ANGLE_STEP_DEG).to_radians().cos();
        let cosines = self.directions.iter().map(|&direction| cosine(axis, direction));
        // Most are outside, and need no angle.
        for (square, cosine) in self.squares.iter().zip(cosines).filter(|(_, cosine)| *cosine > outside) {
            let bin = (cosine.acos().to_degrees() / HALF_ANGLE_STEP_DEG) as usize;
            if let Some(squares) = histogram.get_mut(bin) {
                squares.add(*square);
            }
        }
        histogram
    }

    /// The likelihood of a cone, with what whitening makes of its noise, which leaks out of it into later samples; near
    /// that of another cone, given by its `log_kappa`.
    fn likelihood(&self, cone: Cone, near: Option<f64>) -> Likelihood {
        let inside = cone.holds(&self.problem.signals.rows().direction);
        let row_variance: Vec<f64> = inside.into_iter().map(|inside| f64::from(u8::from(inside))).collect();
        let v = innovation_variance(&self.problem.whitening, &row_variance);
        let affected: Vec<(f64, f64)> =
            self.squares.iter().zip(&v).filter(|(_, v)| **v > 0.0).map(|(square, v)| (*square, *v)).collect();
        let (n, count) = (self.squares.len() as f64, affected.len() as f64);
        if count < CONE_LEAST_SAMPLES || n - count < CONE_LEAST_SAMPLES {
            return Likelihood { glrt: 0.0, log_kappa: near.unwrap_or(0.0) };
        }
        let all: f64 = self.squares.iter().sum();
        let unaffected = all - affected.iter().map(|(square, _)| square).sum::<f64>();
        let deviance = |log_kappa: f64| deviance(n, unaffected, affected.iter().copied(), log_kappa);
        let start = -(v.iter().sum::<f64>() / count).ln();
        let [far, close] = LOG_KAPPA_REACH;
        let (start, reach) = near.map_or((start, far), |near| (near, close));
        let log_kappa = golden_section_minimum(deviance, [start - reach, start + reach], LOG_KAPPA_TOLERANCE);
        Likelihood { glrt: n * (all / n).ln() - deviance(log_kappa), log_kappa }
    }

    /// The effect with a cone, the variance within it at its likeliest.
    fn candidate(&self, cone: Cone, effect: usize) -> Option<Candidate> {
        let problem = self.problem;
        let [azimuth_deg, elevation_deg, half_angle_deg] = cone.degrees();
        let mut at = vec![azimuth_deg, elevation_deg, half_angle_deg, 1.0];
        let row_variance = problem.library[effect].variance(&problem.signals, &at)?.scalar_nt;
        let v = innovation_variance(&problem.whitening, &row_variance);
        let added = fit_variance(&self.squares, &v);
        let variance = VarianceFit::new(&v, &added);
        let is_enough = added.glrt > 0.0 && variance.most() >= 1.0 + VARIANCE_LEAST_GROWTH;
        if !is_enough || !self.is_lasting(cone, &variance.growth, added.glrt) {
            return None;
        }
        at[3] = (added.kappa * scale(&self.squares, &v, added.kappa)).sqrt();
        let term = Term { effect, at, coordinates: Vec::new() };
        Some(Candidate { term, glrt: added.glrt, dof: 2.0, trials_factor: CONE_TRIALS, variance: Some(variance) })
    }

    /// Whether the variance is larger within the cone in both halves of the time, and not with the slopes of the
    /// interference.
    fn is_lasting(&self, cone: Cone, growth: &[f64], glrt_of_all: f64) -> bool {
        let inside = cone.holds(&self.directions);
        let n = self.squares.len();
        let least_of_half = 0.5 * CONE_LEAST_SAMPLES;
        let halves = [0..n / 2, n / 2..n].map(|half| self.glrt_of_part(&inside, least_of_half, half));
        let halves = match halves {
            [Some(first), Some(second)] => [first, second],
            // Visited in one half alone: every other ten seconds.
            _ => [0, 1].map(|turn| {
                let part = (0..n).filter(|k| (k / TURN_ROWS) % 2 == turn);
                self.glrt_of_part(&inside, CONE_LEAST_SAMPLES, part).unwrap_or(0.0)
            }),
        };
        halves.iter().all(|glrt| *glrt >= CONE_HALF_LEAST_GLRT) && !self.follows_slopes(&inside, growth, glrt_of_all)
    }

    /// Likelihood ratio on some of the samples; `None` where fewer than `least` of them are inside, or outside.
    fn glrt_of_part(&self, inside: &[bool], least: f64, part: impl Iterator<Item = usize>) -> Option<f64> {
        let mut sums = [Squares::default(); 2];
        part.for_each(|k| sums[usize::from(inside[k])].add(self.squares[k]));
        let [outside, inside] = sums;
        (inside.count >= least && outside.count >= least).then(|| glrt_of_two(inside, outside))
    }

    /// Whether the variance within the cone goes with a slope of the interference, which an error of the direction would
    /// multiply: not a dead zone then.
    fn follows_slopes(&self, inside: &[bool], growth: &[f64], glrt_of_all: f64) -> bool {
        let within = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(inside).filter(|(_, inside)| **inside).map(|(value, _)| *value).collect()
        };
        let squares: Vec<f64> = self.squares.iter().zip(growth).map(|(square, growth)| square / growth).collect();
        let squares = within(&squares);
        let most = CONE_SLOPES_MOST_GLRT.max(CONE_SLOPES_MOST_SHARE * glrt_of_all);
        squared_slopes(&self.problem.signals).iter().any(|slope| {
            let v = within(&innovation_variance(&self.problem.whitening, slope));
            fit_variance(&squares, &v).glrt >= most
        })
    }
}

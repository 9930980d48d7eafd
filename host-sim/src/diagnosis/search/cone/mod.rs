//! `dead_zone`: variance larger within a cone, in either sense of its axis.

mod climb;
mod coarse;
mod geometry;
mod reach;

use crate::diagnosis::noise::direction::squared_slopes;
use crate::diagnosis::noise::louder::Differences;
use crate::diagnosis::noise::variance::{VarianceFit, deviance, fit_variance, innovation_variance, scale, squares};
use crate::diagnosis::numerics::golden_section_minimum;
use crate::diagnosis::policy::{
    CONE_HALF_LEAST_GLRT, CONE_LEAST_GLRT, CONE_LEAST_RANKS_GLRT, CONE_LEAST_SAMPLES, CONE_SLOPES_MOST_GLRT,
    CONE_SLOPES_MOST_SHARE, CONE_TRIALS, INDISTINGUISHABLE, VARIANCE_LEAST_GROWTH,
};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::Candidate;
use crate::diagnosis::search::axis::axis;
use climb::{Likelihood, drawn_about, step_by_step};
use coarse::{Squares, best_of_axes, glrt_of_two};
use geometry::Cone;
pub(crate) use reach::Reach;

/// Bracket of `ln kappa` below and above where it starts, where the addition is as large as the noise, and on either side of that of a
/// cone near by.
const LOG_KAPPA_FAR: [f64; 2] = [6.0, 18.0];
const LOG_KAPPA_NEAR: [f64; 2] = [0.7; 2];
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
    let search = ConeSearch::new(problem, &fit.residual_whitened, last.and_then(Candidate::growth));
    let (glrt, coarse) = best_of_axes(&search.squares, &search.directions);
    if glrt < CONE_LEAST_GLRT {
        return None;
    }
    let cone = search.best(coarse, last.map(|last| &last.term.at[..]));
    search.candidate(search.by_differences(cone, &fit.residual_whitened), effect)
}

/// How far a cone that was found may be from the likeliest one, with the noise that others leave.
pub(crate) fn reach(problem: &RegressionProblem<'_>, residual_whitened: &[f64], found: &Candidate) -> Reach {
    let search = ConeSearch::new(problem, residual_whitened, found.growth());
    let at = &found.term.at;
    let cone = Cone { axis: axis(at[0], at[1]), half_angle_deg: at[2] };
    let near = search.likelihood(cone, None).log_kappa;
    reach::reach(cone, |cone| search.likelihood(cone, Some(near)).glrt)
}

/// The samples of a residual, among which a cone is looked for.
struct ConeSearch<'a> {
    problem: &'a RegressionProblem<'a>,
    squares: Vec<f64>,
    /// Direction of each sample.
    directions: Vec<[f64; 3]>,
}

impl<'a> ConeSearch<'a> {
    fn new(problem: &'a RegressionProblem<'a>, residual_whitened: &[f64], growth: Option<&[f64]>) -> Self {
        let direction = &problem.signals.rows().direction;
        let directions = problem.whitening.rows().map(|row| direction[row]).collect();
        Self { problem, squares: squares(residual_whitened, growth), directions }
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

    /// The likelihood of a cone, with what whitening makes of its noise, which leaks out of it into later samples; near
    /// that of another cone, given by its `log_kappa`.
    fn likelihood(&self, cone: Cone, near: Option<f64>) -> Likelihood {
        self.likelihood_of(&self.unit_variance(cone), near)
    }

    /// The same from the variance of the samples for a cone of unit variance.
    fn likelihood_of(&self, v: &[f64], near: Option<f64>) -> Likelihood {
        let affected: Vec<(f64, f64)> =
            self.squares.iter().zip(v).filter(|(_, v)| **v > 0.0).map(|(square, v)| (*square, *v)).collect();
        let (n, count) = (self.squares.len() as f64, affected.len() as f64);
        if count < CONE_LEAST_SAMPLES || n - count < CONE_LEAST_SAMPLES {
            return Likelihood { glrt: 0.0, log_kappa: near.unwrap_or(0.0) };
        }
        let all: f64 = self.squares.iter().sum();
        let unaffected = all - affected.iter().map(|(square, _)| square).sum::<f64>();
        let deviance = |log_kappa: f64| deviance(n, unaffected, affected.iter().copied(), log_kappa);
        let start = -(v.iter().sum::<f64>() / count).ln();
        let (start, [below, above]) = near.map_or((start, LOG_KAPPA_FAR), |near| (near, LOG_KAPPA_NEAR));
        let log_kappa = golden_section_minimum(deviance, [start - below, start + above], LOG_KAPPA_TOLERANCE);
        Likelihood { glrt: n * (all / n).ln() - deviance(log_kappa), log_kappa }
    }

    /// Variance of the samples for an addition of 1 nT2 to each row within a cone.
    fn unit_variance(&self, cone: Cone) -> Vec<f64> {
        let inside = cone.holds(&self.problem.signals.rows().direction);
        let row_variance: Vec<f64> = inside.into_iter().map(|inside| f64::from(u8::from(inside))).collect();
        innovation_variance(&self.problem.whitening, &row_variance)
    }

    /// The best cone by the differences of what is left, as if they had heavy tails, where it is clearly better than one by the squares:
    /// what is loud in turns, or not fitted yet, moves the likelihood of those by tens of degrees. One that is not louder from row to row
    /// by its ranks is not worth the search.
    fn by_differences(&self, by_squares: Cone, left: &[f64]) -> Cone {
        let differences = Differences::of(left, Vec::new());
        let growth = |cone: Cone, near: Option<f64>| {
            let v = self.unit_variance(cone);
            let log_kappa = self.likelihood_of(&v, near).log_kappa;
            (log_kappa, v.iter().map(|v| (log_kappa.exp() * v).ln_1p()).collect::<Vec<f64>>())
        };
        let (_, own) = growth(by_squares, None);
        if differences.glrt(own.clone()) < CONE_LEAST_RANKS_GLRT {
            return by_squares;
        }
        let likelihood = |cone: Cone, near: Option<f64>| {
            let (log_kappa, growth) = growth(cone, near);
            Likelihood { glrt: -differences.deviance_of(vec![growth]), log_kappa }
        };
        let by_ranks = best_of_axes(differences.squared_scores(), &self.directions).1;
        let (first, other) = (step_by_step(by_squares, likelihood), step_by_step(by_ranks, likelihood));
        let (glrt, best) = if first.0 > other.0 { first } else { other };
        if glrt > INDISTINGUISHABLE - differences.deviance_of(vec![own]) { best } else { by_squares }
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

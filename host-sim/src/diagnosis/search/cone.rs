//! `dead_zone`: variance larger within a cone, in either sense.

use nalgebra::{Matrix3, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::diagnosis::noise::direction::slopes;
use crate::diagnosis::noise::variance::{VarianceFit, fit_variance, innovation_variance, scale, squares};
use crate::diagnosis::policy::LEAST_GROWTH;
use crate::diagnosis::reconstruct::tangent_plane::{cross, unit};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::Candidate;
use crate::diagnosis::search::axis::{axis, half_sphere};

/// Axes that are tried first.
const AXES: usize = 300;
/// Half angles that are told apart, degrees.
const STEP_DEG: f64 = 0.5;
/// Widest half angle that is tried, degrees.
const WIDEST_DEG: f64 = 45.0;
/// Samples that a dead zone must hold, and must leave.
const LEAST_SAMPLES: f64 = 30.0;
/// Rounds of the search for the best cone, cones of each, and how many of them the next round goes by.
const ROUNDS: usize = 8;
const DRAWS: usize = 60;
const ELITE: usize = 12;
/// Steps from there, degrees, and how many of a length at most.
const STEPS_DEG: [f64; 4] = [4.0, 2.0, 1.0, 0.5];
const MOST_STEPS: usize = 4;
/// Spread of the first round, two sides and half angle, and what every later one has at least, degrees.
const FIRST_SPREAD_DEG: [f64; 3] = [9.0, 9.0, 6.0];
const LEAST_SPREAD_DEG: f64 = 0.15;
/// Gain of the first search from which it is worth to look closer.
const WORTH: f64 = 25.0;
/// Twice the log likelihood that a dead zone must gain in each half of the time.
const LEAST_GAIN_OF_HALF: f64 = 5.0;
/// Twice the log likelihood that noise in proportion to the slopes may gain within a dead zone.
const MOST_GAIN_OF_SLOPES: f64 = 12.0;
/// The same as a share of what the dead zone gains.
const MOST_SHARE_OF_SLOPES: f64 = 0.02;
/// Independent cones, as far as a whitened residual that is not quite normal tells them apart.
const CONES: f64 = 4000.0;

/// A cone in both senses of its axis.
#[derive(Clone, Copy, Debug)]
struct Cone {
    axis: [f64; 3],
    half_angle_deg: f64,
}

impl Cone {
    /// Which directions it holds.
    fn holds(&self, directions: &[[f64; 3]]) -> Vec<bool> {
        let least = self.half_angle_deg.to_radians().cos();
        directions.iter().map(|&direction| cosine(self.axis, direction) >= least).collect()
    }

    /// With its axis turned to two sides and its angle wider, all in degrees.
    fn moved(&self, [side, other_side, wider]: [f64; 3]) -> Self {
        let [x, y, z] = self.axis;
        // A direction that is not the axis', to turn towards.
        let away = if z.abs() < 0.8 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let first = unit(cross(self.axis, away));
        let second = cross(self.axis, first);
        let (a, b) = (side.to_radians().tan(), other_side.to_radians().tan());
        let axis =
            [x + a * first[0] + b * second[0], y + a * first[1] + b * second[1], z + a * first[2] + b * second[2]];
        Self { axis: unit(axis), half_angle_deg: (self.half_angle_deg + wider).clamp(STEP_DEG, WIDEST_DEG) }
    }

    /// Azimuth, elevation and half angle.
    fn degrees(&self) -> [f64; 3] {
        let [x, y, z] = self.axis;
        [y.atan2(x).to_degrees(), z.clamp(-1.0, 1.0).asin().to_degrees(), self.half_angle_deg]
    }
}

/// The best cone, if the variance is larger within it and nothing else makes it so. `last` is what was
/// found before, with another noise model.
pub(crate) fn scan(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    effect: usize,
    last: Option<&Candidate>,
) -> Option<Candidate> {
    let search = Search::new(problem, fit, last.and_then(Candidate::growth));
    let (glrt, cone) = search.coarse();
    if glrt < WORTH {
        return None;
    }
    let cone = match last {
        None => search.closer(cone),
        Some(last) => {
            let at = &last.term.at;
            let starts = [search.closer(cone), Cone { axis: axis(at[0], at[1]), half_angle_deg: at[2] }];
            starts.into_iter().map(|cone| search.step_by_step(cone)).max_by(|a, b| a.0.total_cmp(&b.0))?.1
        }
    };
    let [azimuth_deg, elevation_deg, half_angle_deg] = cone.degrees();
    let mut at = vec![azimuth_deg, elevation_deg, half_angle_deg, 1.0];
    let v =
        innovation_variance(&problem.whitening, &problem.library[effect].variance(&problem.signals, &at)?.scalar_nt);
    let squares = &search.squares;
    let (glrt, kappa, curvature) = fit_variance(squares, &v);
    let variance = VarianceFit::new(&v, kappa, curvature);
    let is_enough = glrt > 0.0 && variance.most() >= 1.0 + LEAST_GROWTH;
    if !is_enough || !search.is_lasting(cone, &variance.growth, glrt) {
        return None;
    }
    at[3] = (kappa * scale(squares, &v, kappa)).sqrt();
    let term = Term { effect, at, coordinates: Vec::new() };
    Some(Candidate { term, glrt, dof: 2.0, trials_factor: CONES, variance: Some(variance) })
}

struct Search<'a> {
    problem: &'a RegressionProblem<'a>,
    squares: Vec<f64>,
    /// Direction of each sample.
    directions: Vec<[f64; 3]>,
}

impl<'a> Search<'a> {
    fn new(problem: &'a RegressionProblem<'a>, fit: &Fit, growth: Option<&[f64]>) -> Self {
        let direction = &problem.signals.rows().direction;
        let directions = problem.whitening.rows().map(|row| direction[row]).collect();
        Self { problem, squares: squares(&fit.residual_whitened, growth), directions }
    }

    /// The best of evenly spread axes, as if whitening left noise where it was.
    fn coarse(&self) -> (f64, Cone) {
        let of_axis = |(azimuth_deg, elevation_deg)| {
            let axis = axis(azimuth_deg, elevation_deg);
            let (glrt, half_angle_deg) = self.best_angle(axis);
            (glrt, Cone { axis, half_angle_deg })
        };
        let none = (0.0, Cone { axis: [1.0, 0.0, 0.0], half_angle_deg: STEP_DEG });
        half_sphere(AXES).map(of_axis).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or(none)
    }

    fn best_angle(&self, axis: [f64; 3]) -> (f64, f64) {
        let (n, all) = (self.squares.len() as f64, self.squares.iter().sum::<f64>());
        let bins = (90.0 / STEP_DEG) as usize;
        let mut histogram = vec![(0.0, 0.0); bins + 1];
        for (square, &direction) in self.squares.iter().zip(&self.directions) {
            let bin = (cosine(axis, direction).acos().to_degrees() / STEP_DEG) as usize;
            histogram[bin.min(bins)].0 += 1.0;
            histogram[bin.min(bins)].1 += square;
        }
        let (mut count, mut sum) = (0.0, 0.0);
        let mut best = (0.0, STEP_DEG);
        for (bin, (of_bin, squares)) in histogram.iter().enumerate().take((WIDEST_DEG / STEP_DEG) as usize) {
            count += of_bin;
            sum += squares;
            if count < LEAST_SAMPLES || n - count < LEAST_SAMPLES {
                continue;
            }
            let glrt = glrt((count, sum), (n - count, all - sum));
            if glrt > best.0 {
                best = (glrt, (bin + 1) as f64 * STEP_DEG);
            }
        }
        best
    }

    /// The best cone near one, with what whitening makes of its noise: that leaks out of it into later samples. A wider
    /// cone about an axis further off does almost as well, so that steps one by one stick fast: cones are drawn, and the
    /// best of them say from where to draw next (cross-entropy method, Rubinstein 1999).
    fn closer(&self, cone: Cone) -> Cone {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut best = (self.likelihood(cone, None), cone);
        let (mut mean, mut factor) = (Vector3::zeros(), Matrix3::from_diagonal(&FIRST_SPREAD_DEG.into()));
        for _ in 0..ROUNDS {
            let mut drawn: Vec<(f64, Vector3<f64>)> = Vec::with_capacity(DRAWS);
            for _ in 0..DRAWS {
                let at = mean + factor * Vector3::from_fn(|_, _| StandardNormal.sample(&mut random));
                let other = cone.moved(at.into());
                let likelihood = self.likelihood(other, Some(best.0.1));
                drawn.push((likelihood.0, at));
                if likelihood.0 > best.0.0 {
                    best = (likelihood, other);
                }
            }
            drawn.sort_by(|a, b| b.0.total_cmp(&a.0));
            let elite = || drawn[..ELITE].iter().map(|(_, at)| at);
            mean = elite().sum::<Vector3<f64>>() / ELITE as f64;
            let square = |at: &Vector3<f64>| (at - mean) * (at - mean).transpose();
            let spread = elite().map(square).sum::<Matrix3<f64>>() / ELITE as f64;
            let least = Matrix3::identity() * LEAST_SPREAD_DEG * LEAST_SPREAD_DEG;
            factor = (spread + least).cholesky().map_or(factor, |cholesky| cholesky.l());
        }
        best.1
    }

    /// The best cone that is reached by ever smaller steps to all sides, and its likelihood.
    fn step_by_step(&self, cone: Cone) -> (f64, Cone) {
        let mut best = (self.likelihood(cone, None), cone);
        let sides = [-1.0, 0.0, 1.0];
        for step_deg in STEPS_DEG {
            for _ in 0..MOST_STEPS {
                let (around, near) = (best.1, best.0.1);
                let step = |a: f64, b: f64, c: f64| around.moved([a * step_deg, b * step_deg, c * step_deg]);
                let all = sides.iter().flat_map(|a| sides.iter().flat_map(|b| sides.map(|c| step(*a, *b, c))));
                let found =
                    all.map(|cone| (self.likelihood(cone, Some(near)), cone)).max_by(|a, b| a.0.0.total_cmp(&b.0.0));
                match found {
                    Some(found) if found.0.0 > best.0.0 => best = found,
                    _ => break,
                }
            }
        }
        (best.0.0, best.1)
    }

    /// Twice the gain in log likelihood, and the logarithm of the noise that has it; near another's, if given.
    fn likelihood(&self, cone: Cone, near: Option<f64>) -> (f64, f64) {
        let inside = cone.holds(&self.problem.signals.rows().direction);
        let row_variance: Vec<f64> = inside.into_iter().map(|inside| f64::from(u8::from(inside))).collect();
        let v = innovation_variance(&self.problem.whitening, &row_variance);
        let inside: Vec<(f64, f64)> =
            self.squares.iter().zip(&v).filter(|(_, v)| **v > 0.0).map(|(square, v)| (*square, *v)).collect();
        let (n, count) = (self.squares.len() as f64, inside.len() as f64);
        if count < LEAST_SAMPLES || n - count < LEAST_SAMPLES {
            return (0.0, near.unwrap_or(0.0));
        }
        let all: f64 = self.squares.iter().sum();
        let outside = all - inside.iter().map(|(square, _)| square).sum::<f64>();
        let deviance = |log_kappa: f64| {
            let kappa = log_kappa.exp();
            let (mut scaled, mut logs) = (outside, 0.0);
            for (square, v) in &inside {
                let growth = 1.0 + kappa * v;
                scaled += square / growth;
                logs += growth.ln();
            }
            n * (scaled / n).ln() + logs
        };
        let mean = v.iter().sum::<f64>() / count;
        let (start, reach) = near.map_or((-mean.ln(), 6.0), |near| (near, 0.7));
        let (mut low, mut high) = (start - reach, start + reach);
        while high - low > 0.1 {
            let (a, b) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
            if deviance(a) < deviance(b) { high = b } else { low = a }
        }
        let at = 0.5 * (low + high);
        (n * (all / n).ln() - deviance(at), at)
    }

    /// Whether the variance is larger within the cone in both halves of the time, and not with the slopes of the
    /// interference.
    fn is_lasting(&self, cone: Cone, growth: &[f64], gain_of_all: f64) -> bool {
        let inside = cone.holds(&self.directions);
        let n = self.squares.len();
        let part = |least: f64, of: &dyn Fn(usize) -> bool| {
            let mut sums = [(0.0, 0.0); 2];
            for k in (0..n).filter(|&k| of(k)) {
                let sum = &mut sums[usize::from(inside[k])];
                *sum = (sum.0 + 1.0, sum.1 + self.squares[k]);
            }
            let [outside, inside] = sums;
            (inside.0 >= least && outside.0 >= least).then(|| glrt(inside, outside))
        };
        let halves = match (part(0.5 * LEAST_SAMPLES, &|k| k < n / 2), part(0.5 * LEAST_SAMPLES, &|k| k >= n / 2)) {
            (Some(first), Some(second)) => [first, second],
            // Visited in one half alone: every other ten seconds.
            _ => [0, 1].map(|turn| part(LEAST_SAMPLES, &|k| (k / 100) % 2 == turn).unwrap_or(0.0)),
        };
        halves.iter().all(|glrt| *glrt >= LEAST_GAIN_OF_HALF) && !self.follows_slopes(&inside, growth, gain_of_all)
    }

    fn follows_slopes(&self, inside: &[bool], growth: &[f64], gain_of_all: f64) -> bool {
        let within = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(inside).filter(|(_, inside)| **inside).map(|(value, _)| *value).collect()
        };
        let squares: Vec<f64> = self.squares.iter().zip(growth).map(|(square, growth)| square / growth).collect();
        let squares = within(&squares);
        let most = MOST_GAIN_OF_SLOPES.max(MOST_SHARE_OF_SLOPES * gain_of_all);
        slopes(&self.problem.signals).iter().any(|slope| {
            let v = within(&innovation_variance(&self.problem.whitening, slope));
            fit_variance(&squares, &v).0 >= most
        })
    }
}

/// Cosine of the angle to an axis in the nearer of its senses.
fn cosine(axis: [f64; 3], direction: [f64; 3]) -> f64 {
    (0..3).map(|i| axis[i] * direction[i]).sum::<f64>().abs().min(1.0)
}

/// Twice the gain in log likelihood with a variance of their own for those inside, each a count and a sum of squares; 0
/// unless it is the larger one.
fn glrt(inside: (f64, f64), outside: (f64, f64)) -> f64 {
    let mean = |(count, sum): (f64, f64)| sum / count;
    if mean(inside) <= mean(outside) {
        return 0.0;
    }
    let all = (inside.0 + outside.0, inside.1 + outside.1);
    all.0 * mean(all).ln() - inside.0 * mean(inside).ln() - outside.0 * mean(outside).ln()
}

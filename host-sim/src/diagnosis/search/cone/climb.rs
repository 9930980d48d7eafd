//! The best cone near another one, by its likelihood.
//!
//! A wider cone about an axis further off does almost as well, so that the likelihood has a narrow ridge across the
//! coordinates, on which coordinate descent stalls: cones are drawn, and the best of them say from where to draw next.

use nalgebra::{Matrix3, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::geometry::Cone;

/// Rounds, cones of each, and how many of the best of them the next round goes by.
const ROUNDS: usize = 8;
const DRAWS: usize = 60;
const ELITE: usize = 12;
/// Spread of the first round, two sides and half angle, and what every later one has at least, degrees.
const FIRST_SPREAD_DEG: [f64; 3] = [9.0, 9.0, 6.0];
const LEAST_SPREAD_DEG: f64 = 0.15;
/// Lengths of the steps to all sides, degrees, and how many of a length at most.
const STEPS_DEG: [f64; 4] = [4.0, 2.0, 1.0, 0.5];
const MOST_STEPS: usize = 4;

/// What the likelihood of a cone says.
#[derive(Clone, Copy, Debug)]
pub(super) struct Likelihood {
    /// Twice the log likelihood ratio over no cone.
    pub(super) glrt: f64,
    /// Logarithm of the variance that is added within the cone, over that of the noise.
    pub(super) log_kappa: f64,
}

/// The best of cones drawn about one (cross-entropy method, Rubinstein 1999). `likelihood` takes a cone and the
/// `log_kappa` of one near by, to start from.
pub(super) fn drawn_about(cone: Cone, likelihood: impl Fn(Cone, Option<f64>) -> Likelihood) -> Cone {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut best = (likelihood(cone, None), cone);
    let mut spread = Spread { mean: Vector3::zeros(), factor: Matrix3::from_diagonal(&FIRST_SPREAD_DEG.into()) };
    for _ in 0..ROUNDS {
        let mut drawn: Vec<(f64, Vector3<f64>)> = Vec::with_capacity(DRAWS);
        for _ in 0..DRAWS {
            let at = spread.draw(&mut random);
            let other = cone.moved(at.into());
            let found = likelihood(other, Some(best.0.log_kappa));
            drawn.push((found.glrt, at));
            if found.glrt > best.0.glrt {
                best = (found, other);
            }
        }
        drawn.sort_by(|a, b| b.0.total_cmp(&a.0));
        spread.follow(&drawn[..ELITE]);
    }
    best.1
}

/// A normal distribution of two turns of the axis and of the half angle, degrees.
struct Spread {
    mean: Vector3<f64>,
    /// Cholesky factor of the covariance.
    factor: Matrix3<f64>,
}

impl Spread {
    fn draw(&self, random: &mut ChaCha8Rng) -> Vector3<f64> {
        self.mean + self.factor * Vector3::from_fn(|_, _| StandardNormal.sample(random))
    }

    /// Mean and covariance of some draws, each with its likelihood, which does not matter any more.
    fn follow(&mut self, elite: &[(f64, Vector3<f64>)]) {
        let count = elite.len() as f64;
        let draws = || elite.iter().map(|(_, at)| at);
        self.mean = draws().sum::<Vector3<f64>>() / count;
        let square = |at: &Vector3<f64>| (at - self.mean) * (at - self.mean).transpose();
        let covariance = draws().map(square).sum::<Matrix3<f64>>() / count;
        let least = Matrix3::identity() * LEAST_SPREAD_DEG * LEAST_SPREAD_DEG;
        self.factor = (covariance + least).cholesky().map_or(self.factor, |cholesky| cholesky.l());
    }
}

/// The best cone that is reached from one by ever smaller steps to all sides, and its likelihood ratio.
pub(super) fn step_by_step(cone: Cone, likelihood: impl Fn(Cone, Option<f64>) -> Likelihood) -> (f64, Cone) {
    let mut best = (likelihood(cone, None), cone);
    for step_deg in STEPS_DEG {
        for _ in 0..MOST_STEPS {
            let (near, around) = (best.0.log_kappa, best.1);
            let found = neighbours(around, step_deg)
                .map(|cone| (likelihood(cone, Some(near)), cone))
                .max_by(|a, b| a.0.glrt.total_cmp(&b.0.glrt));
            match found {
                Some(found) if found.0.glrt > best.0.glrt => best = found,
                _ => break,
            }
        }
    }
    (best.0.glrt, best.1)
}

/// A cone and its 26 neighbours, one step to either side in each of its coordinates or not.
fn neighbours(cone: Cone, step_deg: f64) -> impl Iterator<Item = Cone> {
    const SIDES: [f64; 3] = [-1.0, 0.0, 1.0];
    let sides = SIDES.into_iter().flat_map(|a| SIDES.into_iter().flat_map(move |b| SIDES.map(|c| [a, b, c])));
    sides.map(move |side| cone.moved(side.map(|part| part * step_deg)))
}

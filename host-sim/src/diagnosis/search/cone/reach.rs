//! How far a cone may be from the likeliest one: rows tell which directions it holds, and many cones hold the same ones.

use nalgebra::Vector3;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, UnitSphere};

use super::geometry::Cone;

/// Cones whose likelihood ratio is less by no more count as likely: chi squared of their three numbers, 95 % below.
const LIKELY_WITHIN: f64 = 12.0;
/// The same of those that the search walks through, and as a share of the likelihood ratio, whichever is more: rows that the edge passes
/// make it rough.
const WALKED_WITHIN: f64 = 40.0;
const WALKED_SHARE: f64 = 0.02;
/// Lines through cones that are walked through, whose ends are looked for, and then through likely ones.
const LINES: [usize; 2] = [60, 60];
/// First step along a line, of [`Cone::vector`], a tenth of a degree; how often it is doubled, and how often the last one is halved.
const FIRST_STEP: f64 = 0.002;
const DOUBLINGS: usize = 9;
const HALVINGS: usize = 4;

/// The likeliest cone, and where the likely ones end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    /// Azimuth and elevation of the axis and half angle, degrees.
    pub(crate) likeliest: [f64; 3],
    /// Lowest and highest of each, degrees; the azimuth within half a turn of the likeliest.
    pub(crate) range: [[f64; 2]; 3],
}

/// From a cone on, with a likelihood ratio.
pub(super) fn reach(cone: Cone, likelihood_ratio: impl Fn(Cone) -> f64) -> Reach {
    let mut at = Vector3::from(cone.vector());
    let start = Tried { ratio: likelihood_ratio(cone), cone, at };
    let within = WALKED_WITHIN.max(WALKED_SHARE * start.ratio);
    let mut likely = Likely { tried: vec![start], likeliest: start, within, likelihood_ratio };
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for line in 0..LINES[0] + LINES[1] {
        if line == LINES[0] {
            likely.within = LIKELY_WITHIN;
            at = likely.likeliest.at;
        }
        let along = likely.direction(line, &mut random);
        let [back, forth] = [-1.0, 1.0].map(|sign| likely.end(at, sign * along));
        let next = at + (random.random_range(0.0..=1.0) * (back + forth) - back) * along;
        if likely.holds(next) {
            at = next;
        }
    }
    likely.reach()
}

/// A cone, also as a vector, and its likelihood ratio.
#[derive(Clone, Copy)]
struct Tried {
    ratio: f64,
    cone: Cone,
    at: Vector3<f64>,
}

/// Cones that were tried.
struct Likely<F> {
    tried: Vec<Tried>,
    likeliest: Tried,
    /// How much less than the likeliest one's counts.
    within: f64,
    likelihood_ratio: F,
}

impl<F: Fn(Cone) -> f64> Likely<F> {
    /// Whether a cone is one of the likely ones, as far as the likeliest is known.
    fn holds(&mut self, at: Vector3<f64>) -> bool {
        let Some(cone) = Cone::of_vector(at.into()) else { return false };
        let tried = Tried { ratio: (self.likelihood_ratio)(cone), cone, at };
        self.tried.push(tried);
        if tried.ratio >= self.likeliest.ratio {
            self.likeliest = tried;
        }
        self.is_likely(&tried)
    }

    fn is_likely(&self, tried: &Tried) -> bool {
        tried.ratio >= self.likeliest.ratio - self.within
    }

    /// All ways in turn, and from one likely cone to another: they lie along a narrow ridge, which is straight in these vectors.
    fn direction(&self, line: usize, random: &mut ChaCha8Rng) -> Vector3<f64> {
        let members: Vec<&Tried> = self.tried.iter().filter(|tried| self.is_likely(tried)).collect();
        let apart = match (members.choose(random), members.choose(random)) {
            (Some(one), Some(other)) if !line.is_multiple_of(3) => (one.at - other.at).try_normalize(1e-9),
            _ => None,
        };
        apart.unwrap_or_else(|| Vector3::from(UnitSphere.sample(random)))
    }

    /// How far the likely ones go along a direction.
    fn end(&mut self, from: Vector3<f64>, along: Vector3<f64>) -> f64 {
        let (mut inside, mut outside) = (0.0, FIRST_STEP);
        for _ in 0..DOUBLINGS {
            if !self.holds(from + outside * along) {
                break;
            }
            (inside, outside) = (outside, 2.0 * outside);
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if self.holds(from + middle * along) { inside = middle } else { outside = middle }
        }
        inside
    }

    fn reach(&self) -> Reach {
        let likeliest = self.likeliest.cone.degrees();
        let members = self.tried.iter().filter(|tried| self.is_likely(tried)).map(|tried| tried.cone.degrees());
        let mut range = likeliest.map(|value| [value; 2]);
        for mut cone in members {
            cone[0] -= 360.0 * ((cone[0] - likeliest[0]) / 360.0).round();
            for ([low, high], value) in range.iter_mut().zip(cone) {
                (*low, *high) = (low.min(value), high.max(value));
            }
        }
        Reach { likeliest, range }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Directions of a body that rocks on two headings, and which of them a cone holds.
    fn held(cone: &Cone) -> Vec<bool> {
        let direction = |k: usize| {
            let (heading, rock) = (if k.is_multiple_of(2) { 0.2 } else { 1.6 }, 0.3 * (0.37 * k as f64).sin());
            let elevation: f64 = 0.9 + 0.1 * (0.23 * k as f64).cos();
            let azimuth: f64 = heading + rock;
            [elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin()]
        };
        cone.holds(&(0..600).map(direction).collect::<Vec<_>>())
    }

    /// Two cones that hold the same directions are as likely, however far they are from each other.
    #[test]
    fn cones_that_hold_the_same_directions_are_in_reach() {
        let cone = |azimuth_deg, elevation_deg, half_angle_deg| {
            let axis = crate::diagnosis::search::axis::axis(azimuth_deg, elevation_deg);
            Cone { axis, half_angle_deg }
        };
        let truth = held(&cone(20.0, 45.0, 12.0));
        let ratio =
            |cone: Cone| -20.0 * held(&cone).iter().zip(&truth).filter(|(own, truth)| own != truth).count() as f64;
        let Reach { likeliest: [azimuth_deg, elevation_deg, half_angle_deg], range } =
            reach(cone(20.6, 45.4, 12.3), ratio);
        assert_eq!(ratio(cone(azimuth_deg, elevation_deg, half_angle_deg)), 0.0);
        for ([low, high], truth) in range.into_iter().zip([20.0, 45.0, 12.0]) {
            assert!((low..=high).contains(&truth), "{truth} {low} {high}");
        }
        let [low, high] = range[2];
        assert!(high - low > 1.0, "{range:?}");
    }
}

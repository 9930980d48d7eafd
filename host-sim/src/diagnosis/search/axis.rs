//! `heading_error`: cubic and quartic monomials of the direction once, then every axis for almost nothing.

use nalgebra::{DMatrix, DVector};

use crate::diagnosis::policy::AXIS_TRIALS;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::products::{dot, gram_of};
use crate::diagnosis::regression::projection::explained;
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::Candidate;

/// Orders of the powers of a cosine that the 18 terms do not have.
pub(crate) const CUBIC_AND_QUARTIC: [i32; 2] = [3, 4];
/// Axes that are tried first, over half a sphere.
const AXES: usize = 400;
/// The first step about the best of them, and the last one, degrees.
const STEPS_DEG: [f64; 2] = [4.0, 0.1];

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let products = Products::of(problem, fit);
    let coarse = half_sphere(AXES).map(|at| (products.explained(at).0, at));
    let best = coarse.fold((0.0, (0.0, 0.0)), |best, tried| if tried.0 > best.0 { tried } else { best });
    let (azimuth_deg, elevation_deg) = climbed(best, |at| products.explained(at).0);
    let (glrt, coordinates, rank) = products.explained((azimuth_deg, elevation_deg));
    let azimuth_deg = (azimuth_deg + 180.0).rem_euclid(360.0) - 180.0;
    let term = Term { effect, at: vec![azimuth_deg, elevation_deg.clamp(-90.0, 90.0), 0.0, 0.0], coordinates };
    Some(Candidate { term, glrt, dof: 2.0 + rank as f64, trials_factor: AXIS_TRIALS, variance: None })
}

/// Azimuth and elevation of a maximum, degrees, from a start with its value: to the best of four neighbours as long as
/// that is better, then with half the step.
fn climbed((mut most, mut at): (f64, (f64, f64)), of: impl Fn((f64, f64)) -> f64) -> (f64, f64) {
    let [mut step_deg, last_deg] = STEPS_DEG;
    while step_deg > last_deg {
        let around = [(step_deg, 0.0), (-step_deg, 0.0), (0.0, step_deg), (0.0, -step_deg)];
        let tried = around.map(|(da, de)| (at.0 + da, at.1 + de)).map(|at| (of(at), at));
        match tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some(better) if better.0 > most => (most, at) = better,
            _ => step_deg *= 0.5,
        }
    }
    at
}

/// Products of the projected monomials of the direction among each other and with the residual.
struct Products {
    gram: DMatrix<f64>,
    q: DVector<f64>,
}

impl Products {
    fn of(problem: &RegressionProblem<'_>, fit: &Fit) -> Self {
        let monomials =
            problem.projected(&monomials(&problem.signals.rows().direction, CUBIC_AND_QUARTIC), &fit.projection);
        let gram = gram_of(&monomials.iter().map(|column| &column[..]).collect::<Vec<_>>());
        let with_residual = monomials.iter().map(|column| dot(column, &fit.residual_whitened));
        Self { gram, q: DVector::from_iterator(monomials.len(), with_residual) }
    }

    /// GLRT, coefficients and rank of `u^3` and `u^4`, `u` the cosine to an axis of this azimuth and elevation, degrees.
    fn explained(&self, (azimuth_deg, elevation_deg): (f64, f64)) -> (f64, Vec<f64>, usize) {
        let axis = axis(azimuth_deg, elevation_deg);
        let (cubic, quartic) = (self.power(axis, 3, 0), self.power(axis, 4, exponents(3).len()));
        let (g_cubic, g_quartic) = (&self.gram * &cubic, &self.gram * &quartic);
        let own = DMatrix::from_row_slice(
            2,
            2,
            &[cubic.dot(&g_cubic), cubic.dot(&g_quartic), quartic.dot(&g_cubic), quartic.dot(&g_quartic)],
        );
        let q = DVector::from_vec(vec![cubic.dot(&self.q), quartic.dot(&self.q)]);
        let (glrt, coefficients, rank) = explained(&own, &q);
        (glrt, coefficients.as_slice().to_vec(), rank)
    }

    /// Weights of the monomials in a power of the cosine to an axis; those of its order begin at `offset`.
    fn power(&self, axis: [f64; 3], order: i32, offset: usize) -> DVector<f64> {
        let mut weights = DVector::zeros(self.q.len());
        for (k, exponents) in exponents(order).into_iter().enumerate() {
            weights[offset + k] = multinomial(exponents) * (0..3).map(|i| axis[i].powi(exponents[i])).product::<f64>();
        }
        weights
    }
}

/// `x^a y^b z^c` of all exponents whose sum is one of the orders, in their turn, of every direction.
pub(crate) fn monomials(directions: &[[f64; 3]], orders: [i32; 2]) -> Vec<Vec<f64>> {
    let all = orders.into_iter().flat_map(exponents);
    all.map(|e| directions.iter().map(|c| (0..3).map(|i| c[i].powi(e[i])).product()).collect()).collect()
}

/// All exponents of three variables with this sum.
fn exponents(order: i32) -> Vec<[i32; 3]> {
    (0..=order).flat_map(|a| (0..=order - a).map(move |b| [a, b, order - a - b])).collect()
}

/// How often a monomial of these exponents comes up in a power of a sum of three.
fn multinomial(exponents: [i32; 3]) -> f64 {
    let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
    factorial(exponents.iter().sum()) / exponents.iter().map(|&e| factorial(e)).product::<f64>()
}

/// Unit vector from azimuth and elevation, degrees, as in the effects.
pub(crate) fn axis(azimuth_deg: f64, elevation_deg: f64) -> [f64; 3] {
    let (azimuth, elevation) = (azimuth_deg.to_radians(), elevation_deg.to_radians());
    [elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin()]
}

/// Evenly spread axes of half a sphere, degrees.
pub(crate) fn half_sphere(count: usize) -> impl Iterator<Item = (f64, f64)> {
    let golden_deg = 360.0 * (1.0 - 1.0 / 1.618_033_988_749_895);
    (0..count).map(move |k| {
        let elevation_deg = ((k as f64 + 0.5) / count as f64).asin().to_degrees();
        ((k as f64 * golden_deg + 180.0).rem_euclid(360.0) - 180.0, elevation_deg)
    })
}

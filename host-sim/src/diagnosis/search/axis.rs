//! `heading_error`: cubic and quartic monomials of the direction once, then every axis for almost nothing.

use nalgebra::{DMatrix, DVector};

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::{dot, explained, gram_of};
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::Candidate;

/// Axes that are tried first, over half a sphere.
const AXES: usize = 400;
/// Independent ones among them, for the chance to find something.
const TRIALS: f64 = 8.0;

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let raw = monomials(&problem.signals.rows().direction);
    let whitened = problem.projected(&raw, &fit.projection);
    let gram = gram_of(&whitened.iter().map(|column| &column[..]).collect::<Vec<_>>());
    let q = DVector::from_iterator(whitened.len(), whitened.iter().map(|column| dot(column, &fit.residual_whitened)));
    let at = |azimuth_deg: f64, elevation_deg: f64| of_axis(&gram, &q, axis(azimuth_deg, elevation_deg));
    let mut best = (0.0, 0.0, 0.0);
    for (azimuth_deg, elevation_deg) in half_sphere(AXES) {
        let glrt = at(azimuth_deg, elevation_deg).0;
        if glrt > best.0 {
            best = (glrt, azimuth_deg, elevation_deg);
        }
    }
    let mut step_deg = 4.0;
    while step_deg > 0.1 {
        let (_, azimuth_deg, elevation_deg) = best;
        let around = [(step_deg, 0.0), (-step_deg, 0.0), (0.0, step_deg), (0.0, -step_deg)];
        let better = around
            .map(|(da, de)| (azimuth_deg + da, elevation_deg + de))
            .map(|(azimuth_deg, elevation_deg)| (at(azimuth_deg, elevation_deg).0, azimuth_deg, elevation_deg))
            .into_iter()
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .filter(|found| found.0 > best.0);
        match better {
            Some(found) => best = found,
            None => step_deg *= 0.5,
        }
    }
    let (glrt, coordinates, rank) = at(best.1, best.2);
    let elevation_deg = best.2.clamp(-90.0, 90.0);
    let azimuth_deg = (best.1 + 180.0).rem_euclid(360.0) - 180.0;
    let term = Term { effect, at: vec![azimuth_deg, elevation_deg, 0.0, 0.0], coordinates };
    Some(Candidate { term, glrt, dof: 2.0 + rank as f64, trials_factor: TRIALS, variance: None })
}

/// Gain and coefficients of `u^3` and `u^4` about an axis.
fn of_axis(gram: &DMatrix<f64>, q: &DVector<f64>, axis: [f64; 3]) -> (f64, Vec<f64>, usize) {
    let powers = |order: i32, offset: usize| {
        let mut weights = DVector::zeros(q.len());
        for (k, exponents) in exponents(order).into_iter().enumerate() {
            weights[offset + k] = multinomial(exponents) * (0..3).map(|i| axis[i].powi(exponents[i])).product::<f64>();
        }
        weights
    };
    let (cubic, quartic) = (powers(3, 0), powers(4, 10));
    let (g_cubic, g_quartic) = (gram * &cubic, gram * &quartic);
    let own = DMatrix::from_row_slice(
        2,
        2,
        &[cubic.dot(&g_cubic), cubic.dot(&g_quartic), quartic.dot(&g_cubic), quartic.dot(&g_quartic)],
    );
    let (glrt, coefficients, rank) = explained(&own, &DVector::from_vec(vec![cubic.dot(q), quartic.dot(q)]));
    (glrt, coefficients.as_slice().to_vec(), rank)
}

/// `x^a y^b z^c` of all exponents with sum 3, then 4, of every direction.
pub(crate) fn monomials(directions: &[[f64; 3]]) -> Vec<Vec<f64>> {
    let all = exponents(3).into_iter().chain(exponents(4));
    all.map(|e| directions.iter().map(|c| (0..3).map(|i| c[i].powi(e[i])).product()).collect()).collect()
}

fn exponents(order: i32) -> Vec<[i32; 3]> {
    (0..=order).flat_map(|a| (0..=order - a).map(move |b| [a, b, order - a - b])).collect()
}

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

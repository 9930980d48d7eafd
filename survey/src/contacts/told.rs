//! What a pass tells of an object, as a normal distribution: where it is along, how far away, and the amplitudes that its moment makes.

use nalgebra::{SMatrix, SVector, Vector3};

use super::window::Fitted;

/// Along the way, m; logarithm of the distance; amplitudes of the three profiles, nT.
pub(super) type Numbers = SVector<f64, 5>;

/// What a pass tells.
#[derive(Clone, Debug)]
pub struct Told {
    pub(super) mean: Numbers,
    pub(super) covariance: SMatrix<f64, 5, 5>,
    /// Unit vector of the Earth's field, east, north, down.
    pub(super) field: Vector3<f64>,
    /// Depth of the sensor below the surface, m, where it is known.
    pub(super) depth_m: Option<f64>,
}

/// Mean and covariance over weighted fits; `beyond` is by how much the noise of a window is larger than its spectrum says, in power.
pub(super) fn moments(places: &[(f64, Fitted)], beyond: f64) -> Option<(Numbers, SMatrix<f64, 5, 5>)> {
    let total: f64 = places.iter().map(|(weight, _)| weight).sum();
    let each = || places.iter().map(|(weight, fitted)| (weight / total, numbers(fitted), fitted));
    let mean: Numbers = each().map(|(weight, numbers, _)| weight * numbers).sum();
    let mut covariance = SMatrix::zeros();
    for (weight, numbers, fitted) in each() {
        let off = numbers - mean;
        covariance += weight * off * off.transpose();
        let Some(of_amplitudes) = (fitted.gram / beyond).try_inverse() else { continue };
        let mut amplitudes = covariance.fixed_view_mut::<3, 3>(2, 2);
        amplitudes += weight * of_amplitudes;
    }
    (total > 0.0).then_some((mean, covariance))
}

fn numbers(fitted: &Fitted) -> Numbers {
    let [a, b, c] = fitted.dipole.amplitudes_nt;
    Numbers::new(fitted.dipole.at, fitted.dipole.distance.ln(), a, b, c)
}

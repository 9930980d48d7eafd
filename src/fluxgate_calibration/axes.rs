//! From the ellipsoid to the axes that made it: scale, offset and direction of each, and how well they are known.
//!
//! A sensor whose axes are the unit vectors `e_i` reads `v_i = (e_i' B) / s_i + c_i`. With `H = G^-1`, `s_i` is
//! `1 / sqrt(H_ii)`, and the cosine between two axes `s_i s_j H_ij`: none of them depends on how the sensor is mounted,
//! which turning alone cannot show.

use super::ellipsoid::{ENTRIES, Fit, LINEAR, UNKNOWNS};
use crate::sensors::fluxgate::FluxgateSettings;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// Steps of Newton's iteration for the nearest rotation; it doubles the digits with each, and 2 degrees take four.
const ROTATION_STEPS: usize = 12;

/// The pairs of axes in the order of their angles.
const PAIRS: [(usize, usize); 3] = [ENTRIES[3], ENTRIES[4], ENTRIES[5]];

/// The axes of a sensor.
pub(super) struct Axes {
    /// By how much the scale of each is to be multiplied.
    pub(super) scales: [f64; 3],
    /// What each reads in zero field, at the right scale, nT.
    pub(super) biases_nt: [f64; 3],
    /// Cosines between x and y, x and z, y and z.
    pub(super) cosines: [f64; 3],
    /// Standard deviations of biases (nT), scales and cosines, for independent residuals of one nT.
    pub(super) unit_std: SVector<f64, UNKNOWNS>,
}

impl Axes {
    /// The axes of an ellipsoid of readings that were made with `settings`; `None` where `fit` is no ellipsoid.
    pub(super) fn of(fit: &Fit, settings: &FluxgateSettings) -> Option<Self> {
        let inverse = fit.shape.cholesky()?.inverse();
        let scales = inverse.diagonal().map(|square| 1.0 / libm::sqrt(square));
        let readings_nt = Vector3::from(settings.bias_nt) + fit.centre_nt;
        let cosines = PAIRS.map(|(a, b)| scales[a] * scales[b] * inverse[(a, b)]);
        let axes = Self {
            scales: scales.into(),
            biases_nt: scales.component_mul(&readings_nt).into(),
            cosines,
            unit_std: SVector::zeros(),
        };
        let changes = axes.changes(fit, &inverse, &readings_nt);
        let covariance = changes * fit.covariance * changes.transpose();
        Some(Self { unit_std: covariance.diagonal().map(libm::sqrt), ..axes })
    }

    /// Derivatives of biases, scales and cosines after the unknowns of the fit: `dH = -H dG H`.
    fn changes(
        &self,
        fit: &Fit,
        inverse: &Matrix3<f64>,
        readings_nt: &Vector3<f64>,
    ) -> SMatrix<f64, UNKNOWNS, UNKNOWNS> {
        let mut changes = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
        for (column, (i, j)) in ENTRIES.into_iter().enumerate() {
            let mut entry = Matrix3::zeros();
            entry[(i, j)] = 1.0;
            entry[(j, i)] = 1.0;
            let change = -(inverse * entry * inverse);
            // Of the logarithm of each scale.
            let relative: [f64; 3] =
                core::array::from_fn(|axis| -0.5 * change[(axis, axis)] * self.scales[axis] * self.scales[axis]);
            for axis in 0..3 {
                let (a, b) = PAIRS[axis];
                let scale = self.scales[axis] * relative[axis];
                changes[(axis, column)] = scale * readings_nt[axis];
                changes[(3 + axis, column)] = scale;
                changes[(6 + axis, column)] =
                    self.cosines[axis] * (relative[a] + relative[b]) + self.scales[a] * self.scales[b] * change[(a, b)];
            }
        }
        for (axis, scale) in self.scales.into_iter().enumerate() {
            let centre = inverse.row(axis) * (scale * fit.unit_nt);
            changes.fixed_view_mut::<1, 3>(axis, LINEAR).copy_from(&centre);
        }
        changes
    }

    /// `settings` with these axes. Where they are mounted is kept: of all matrices that fit, the one nearest to
    /// `body_from_sensor`. `None` when the axes lie in one plane.
    pub(super) fn settings(&self, settings: &FluxgateSettings) -> Option<FluxgateSettings> {
        let [xy, xz, yz] = self.cosines;
        let cosines = Matrix3::new(1.0, xy, xz, xy, 1.0, yz, xz, yz, 1.0);
        let straightened = cosines.cholesky()?.l().try_inverse()?;
        let mounted = body_from_sensor(settings);
        let matrix = nearest_rotation(mounted * straightened.transpose())? * straightened;
        Some(FluxgateSettings {
            nt_per_count: Vector3::from(settings.nt_per_count).component_mul(&Vector3::from(self.scales)).into(),
            bias_nt: self.biases_nt,
            body_from_sensor: matrix.transpose().into(),
            ..*settings
        })
    }
}

/// The settings' matrix.
pub(super) fn body_from_sensor(settings: &FluxgateSettings) -> Matrix3<f64> {
    // Its rows are what an array of arrays has for columns.
    Matrix3::from(settings.body_from_sensor).transpose()
}

/// The orthonormal factor of the polar decomposition, with the sign of the determinant, by Newton's iteration (Higham,
/// "Computing the polar decomposition", SIAM J. Sci. Stat. Comput. 7, 1986).
fn nearest_rotation(mut matrix: Matrix3<f64>) -> Option<Matrix3<f64>> {
    for _ in 0..ROTATION_STEPS {
        matrix = (matrix + matrix.try_inverse()?.transpose()) * 0.5;
    }
    Some(matrix)
}

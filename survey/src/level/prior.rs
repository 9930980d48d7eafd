//! What a calibration knows of the body, as far as it holds.

use nalgebra::{SMatrix, SymmetricEigen};

use super::kalman::{Model, Start, likelihood};
use super::series::Sample;
use super::terms::{TERMS, TOLD, combine, scale_of};

/// How much less than it says a calibration may know, as factors of its variance: bodies change on the way to the water.
const DISCOUNTS: [f64; 5] = [1.0, 10.0, 100.0, 1e3, 1e4];

/// Coefficients of a body, in the units of eq. (4).
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// 3 permanent (nT), 6 induced (nT/nT), 9 eddy (s).
    pub coefficients: [f64; TERMS],
    /// Their covariance, in the same units.
    pub covariance: Box<[[f64; TERMS]; TERMS]>,
}

impl Calibration {
    /// The start that makes a recording likeliest: what the calibration says, discounted, or nothing at all.
    pub(crate) fn start(&self, samples: &[Sample], unknown: &Start, model: &Model) -> Start {
        let discounted = DISCOUNTS.iter().map(|discount| self.discounted(*discount, unknown));
        let all = discounted.chain([unknown.clone()]);
        let judged = all.map(|start| (likelihood(samples, &start, model).0, start));
        judged.max_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(|| unknown.clone(), |(_, start)| start)
    }

    /// Nothing is known worse than without a calibration.
    fn discounted(&self, discount: f64, unknown: &Start) -> Start {
        let scaled: [f64; TERMS] = std::array::from_fn(|k| self.coefficients[k] * scale_of(k));
        let rows: Vec<[f64; TOLD]> = (0..TERMS)
            .map(|i| combine(&std::array::from_fn(|k| self.covariance[i][k] * scale_of(i) * scale_of(k) * discount)))
            .collect();
        let columns: Vec<[f64; TOLD]> = (0..TOLD).map(|k| combine(&std::array::from_fn(|i| rows[i][k]))).collect();
        let mut start = unknown.clone();
        start.mean[..TOLD].copy_from_slice(&combine(&scaled));
        let covariance = SMatrix::<f64, TOLD, TOLD>::from_fn(|i, k| 0.5 * (columns[k][i] + columns[i][k]));
        let mut eigen = SymmetricEigen::new(covariance);
        let most = unknown.covariance[0][0];
        eigen.eigenvalues.iter_mut().for_each(|value| *value = value.clamp(1e-12 * most, most));
        let bounded = eigen.recompose();
        (0..TOLD).for_each(|i| (0..TOLD).for_each(|k| start.covariance[i][k] = bounded[(i, k)]));
        start
    }
}

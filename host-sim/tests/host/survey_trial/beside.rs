//! What of an anomaly no survey can tell that does not know the body: its part in the span of the 18 terms.
//!
//! A dipole that is passed once is a bump on one stretch of headings, and so, in part, is a combination of the 18 terms over the
//! whole recording. In the true spectrum of the noise `S`, with the anomaly `A` and the columns `X`, what remains of its power
//! `A' S^-1 A` is less by `A' S^-1 X (X' S^-1 X)^-1 X' S^-1 A`: the bound of a survey that fits the coefficients to the recording at
//! hand, and knows all other iron.

use host_sim::simulator::scenario::{Scenario, Simulation};
use nalgebra::{DMatrix, DVector};

use super::spectrum::whitened;
use super::zero_phase::columns;

/// Of the largest singular value: the 18 hold combinations that are nothing but a constant.
const LEAST: f64 = 1e-9;

/// Anomalies of a tow beside its body.
pub(crate) struct Beside<'a> {
    scenario: &'a Scenario,
    /// Orthonormal columns that span what the 18 terms explain, whitened.
    span: DMatrix<f64>,
}

impl<'a> Beside<'a> {
    pub(crate) fn new(simulation: &'a Simulation) -> Self {
        let scenario = simulation.scenario();
        let whitened: Vec<DVector<f64>> =
            columns(&earth(simulation)).iter().map(|column| whitened(column, scenario).normalize()).collect();
        let svd = DMatrix::from_columns(&whitened).svd(true, false);
        let (u, most) = (svd.u.unwrap(), svd.singular_values.max());
        let told: Vec<_> =
            u.column_iter().zip(&svd.singular_values).filter(|(_, s)| **s > LEAST * most).map(|(u, _)| u).collect();
        Self { scenario, span: DMatrix::from_columns(&told) }
    }

    /// Signal to noise of an anomaly over all rows, nT, alone and beside the body.
    pub(crate) fn snr(&self, anomaly_nt: &[f64]) -> [f64; 2] {
        let anomaly = whitened(anomaly_nt, self.scenario);
        let taken = self.span.tr_mul(&anomaly).norm_squared();
        [anomaly.norm(), (anomaly.norm_squared() - taken).max(0.0).sqrt()]
    }
}

/// The Earth's field as the body sees it, in units of its size: neither iron nor noise of the fluxgate turns the body.
fn earth(simulation: &Simulation) -> Vec<[f64; 3]> {
    simulation.attitude().iter().map(|attitude| attitude.to_body(simulation.track().earth)).collect()
}

#[test]
fn what_goes_as_a_term_does_is_told_by_nobody_and_a_short_pass_is() {
    let drawn = super::draw::tow(3);
    let simulation = Simulation::new(&drawn.scenario, 3).unwrap();
    let beside = Beside::new(&simulation);
    let rows = simulation.track().place_m.len();
    let bump = |width: f64| -> Vec<f64> {
        (0..rows).map(|row| 20.0 * (1.0 + ((row as f64 - rows as f64 / 2.0) / width).powi(2)).powf(-2.5)).collect()
    };
    let [alone, left] = beside.snr(&bump(10.0));
    assert!(left > 0.95 * alone && left <= alone, "{alone} {left}");
    let term: Vec<f64> = earth(&simulation).iter().map(|direction| 50.0 * direction[0]).collect();
    let [alone, left] = beside.snr(&term);
    assert!(left < 0.01 * alone, "{alone} {left}");
}

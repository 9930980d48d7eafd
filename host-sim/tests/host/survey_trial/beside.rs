//! What of an anomaly no survey can tell that does not know the body: its part in the span of the 18 terms.
//!
//! A dipole that is passed once is a bump on one stretch of headings, and so, in part, is a combination of the 18 terms over the
//! whole recording. In the true spectrum of the noise `S`, with the anomaly `A` and the columns `X`, what remains of its power
//! `A' S^-1 A` is less by `A' S^-1 X (X' S^-1 X)^-1 X' S^-1 A`: the bound of a survey that fits the coefficients to the recording at
//! hand, and knows all other iron.

use host_sim::simulator::scenario::{Scenario, Simulation};
use nalgebra::{DMatrix, DVector};
use towmag_fourier::Complex;

use super::truth::{least_hz, spectrum_nt2};
use super::zero_phase::{RATE_HZ, columns};

/// Of the largest singular value: the 18 hold combinations that are nothing but a constant.
const LEAST: f64 = 1e-9;

/// Anomalies of a tow beside its body.
pub(crate) struct Beside<'a> {
    scenario: &'a Scenario,
    /// Orthonormal columns that span what the 18 terms explain, whitened.
    span: DMatrix<f64>,
}

impl<'a> Beside<'a> {
    /// The body turns as it does without iron and noise of the fluxgate: neither moves it.
    pub(crate) fn new(simulation: &'a Simulation, seed: u64) -> Self {
        let scenario = simulation.scenario();
        let mut clean = scenario.clone();
        (clean.fluxgate.noise_rms_nt, clean.fluxgate.resolution_nt) = (0.0, 1e-6);
        clean.dipoles.clear();
        let flux_nt = Simulation::new(&clean, seed).unwrap().record(&[]).readings.flux_nt;
        let whitened: Vec<DVector<f64>> =
            columns(&flux_nt).iter().map(|column| whitened(column, scenario).normalize()).collect();
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

/// Real and imaginary parts of the transform of all rows, each of variance one for noise of the true spectrum; without what is
/// slower than the slowest rock.
fn whitened(values: &[f64], scenario: &Scenario) -> DVector<f64> {
    let rows = values.len();
    let mut transform: Vec<_> = values.iter().map(|&nt| Complex::new(nt, 0.0)).collect();
    towmag_fourier::forward(rows).process(&mut transform);
    let parts =
        (1..=rows / 2).map(|k| (k, k as f64 * RATE_HZ / rows as f64)).filter(|(_, hz)| *hz >= least_hz(scenario));
    let parts = parts.flat_map(|(k, hz)| {
        let twice = if 2 * k == rows { 1.0 } else { 2.0 };
        let scale = (twice / (rows as f64 * spectrum_nt2(scenario, hz))).sqrt();
        [scale * transform[k].re, scale * transform[k].im]
    });
    DVector::from_vec(parts.collect())
}

#[test]
fn what_goes_as_a_term_does_is_told_by_nobody_and_a_short_pass_is() {
    let drawn = super::draw::tow(3);
    let simulation = Simulation::new(&drawn.scenario, 3).unwrap();
    let beside = Beside::new(&simulation, 3);
    let rows = simulation.track().place_m.len();
    let bump = |width: f64| -> Vec<f64> {
        (0..rows).map(|row| 20.0 * (1.0 + ((row as f64 - rows as f64 / 2.0) / width).powi(2)).powf(-2.5)).collect()
    };
    let [alone, left] = beside.snr(&bump(10.0));
    assert!(left > 0.95 * alone && left <= alone, "{alone} {left}");
    let mut clean = drawn.scenario.clone();
    clean.dipoles.clear();
    clean.fluxgate.noise_rms_nt = 0.0;
    let flux_nt = Simulation::new(&clean, 3).unwrap().record(&[]).readings.flux_nt;
    let term: Vec<f64> = flux_nt.iter().map(|v| 50.0 * v[0] / v.iter().map(|x| x * x).sum::<f64>().sqrt()).collect();
    let [alone, left] = beside.snr(&term);
    assert!(left < 0.01 * alone, "{alone} {left}");
}

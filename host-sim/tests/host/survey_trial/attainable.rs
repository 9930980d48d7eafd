//! What fixed coefficients keep of the anomalies that are put into the flights: what a survey without foreknowledge can reach.
//!
//! The best 18 coefficients in hindsight leave the bound, no more. Fitted to rows that hold the anomalies, they take of these what
//! lies in the space of the 18 columns; anomalies whose place and shape are known are fitted beside them and lose nothing.
//! Which could be known is told by their signal to noise, in noise of the bound's power that is even over the band.

use nalgebra::{DMatrix, DVector};

use super::flights::{Flight, kept};
use super::program::{self, data};
use super::table::{FREE, Figure, finish};
use super::zero_phase::{BAND_HZ, RATE_HZ, band_passed, bound_nt, chosen, columns_in_band};

/// An anomaly of this signal to noise is found in ten minutes of noise hardly ever by chance.
const SURELY_FOUND: f64 = 6.0;

/// Share kept and distortion of anomalies in band, a column each, when the 18 columns are fitted to their sum beside those that are
/// known.
fn kept_by_fixed(columns: &DMatrix<f64>, anomalies: &DMatrix<f64>, is_known: &[bool]) -> [f64; 2] {
    let injected = anomalies.column_sum();
    let known: Vec<_> = anomalies.column_iter().zip(is_known).filter(|(_, known)| **known).map(|(c, _)| c).collect();
    let all: Vec<DVector<f64>> = columns.column_iter().chain(known).map(|column| column.normalize()).collect();
    let design = DMatrix::from_columns(&all);
    let svd = design.clone().svd(true, true);
    let mut best = svd.solve(&injected, 1e-10 * svd.singular_values.max()).unwrap();
    best.rows_mut(columns.ncols(), all.len() - columns.ncols()).fill(0.0);
    let added = &injected - design * best;
    kept(injected.as_slice(), added.as_slice())
}

#[test]
#[ignore = "needs the flights; see the top of survey_trial.rs"]
fn attainable() {
    let Some(data) = data("sgl_line_1002_20") else { return };
    let mut figures = Vec::new();
    for (flux, scalar) in [("b", 5), ("c", 4), ("b", 4), ("c", 5)] {
        let flight = Flight::read(&data.join(format!("flux_{flux}_mag_{scalar}_survey.csv")));
        let bound_nt = bound_nt(&flight.scalar_nt, &flight.flux_nt, &flight.is_box2);
        let columns = columns_in_band(&flight.flux_nt, &flight.is_box2);
        // Independent values an epoch of noise that fills the band alone.
        let share = 2.0 * (BAND_HZ[1] - BAND_HZ[0]) / RATE_HZ;
        for set in program::seeds(0..4) {
            let each = flight.each_anomaly_nt(set).into_iter();
            let in_band: Vec<_> = each.map(|nt| DVector::from(chosen(&band_passed(&nt), &flight.is_box2))).collect();
            let anomalies = DMatrix::from_columns(&in_band);
            let snrs: Vec<f64> = in_band.iter().map(|nt| nt.norm() * share.sqrt() / bound_nt).collect();
            let found: Vec<bool> = snrs.iter().map(|snr| *snr > SURELY_FOUND).collect();
            let name = format!("{}, {scalar}, set {set}", flux.to_uppercase());
            for (how, is_known) in [("none known", vec![false; 8]), ("those found known", found.clone())] {
                let [kept, distortion] = kept_by_fixed(&columns, &anomalies, &is_known);
                let least = snrs.iter().copied().fold(f64::INFINITY, f64::min);
                let of = format!(
                    "distortion {distortion:.3}; {} of 8 found, least SNR {least:.1}",
                    found.iter().filter(|found| **found).count()
                );
                figures.push(Figure::new(format!("{name}: kept, {how}"), [kept, FREE[0], FREE[1]], of));
            }
        }
    }
    finish("Attainable by fixed coefficients", &figures);
}

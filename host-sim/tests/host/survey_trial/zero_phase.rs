//! The zero-phase band-pass of the tables, in `f64`: a Butterworth of four poles a side, 0.1 to 0.9 Hz, forward and backward.
//! Written as its gain over the Fourier transform of the whole recording, each end continued by its point reflection.

use host_sim::simulator::signals::interference;
use nalgebra::{DMatrix, DVector};
use towmag_fourier::{Complex, Planner};

pub(crate) const RATE_HZ: f64 = 10.0;
pub(crate) const BAND_HZ: [f64; 2] = [0.1, 0.9];
const ORDER: i32 = 4;
/// How far each end is continued, rows: the filter rings for some tens of seconds.
const BEYOND: usize = 2000;

/// Forward and backward, so the square of the magnitude of the filter after the bilinear transform.
fn gain(hz: f64) -> f64 {
    let warped = |hz: f64| (std::f64::consts::PI * hz / RATE_HZ).tan();
    let ([low, high], at) = (BAND_HZ.map(warped), warped(hz));
    let low_pass = (at * at - low * high) / (at * (high - low));
    1.0 / (1.0 + low_pass.powi(2 * ORDER))
}

/// Band-passed without delay.
pub(crate) fn band_passed(values: &[f64]) -> Vec<f64> {
    let (rows, beyond) = (values.len(), BEYOND.min(values.len() - 1));
    let (first, last) = (values[0], values[rows - 1]);
    let before = (1..=beyond).rev().map(|k| first - values[k]);
    let after = (1..=beyond).map(|k| 2.0 * last - values[rows - 1 - k] - first);
    let whole = before.chain(values.iter().map(|x| x - first)).chain(after);
    let mut whole: Vec<_> = whole.map(|x| Complex::new(x, 0.0)).collect();
    let (len, mut planner) = (whole.len(), Planner::new());
    planner.forward(len).process(&mut whole);
    for (k, value) in whole.iter_mut().enumerate() {
        let hz = k.min(len - k) as f64 * RATE_HZ / len as f64;
        *value *= if hz == 0.0 { 0.0 } else { gain(hz) / len as f64 };
    }
    planner.inverse(len).process(&mut whole);
    whole[beyond..beyond + rows].iter().map(|x| x.re).collect()
}

/// What the best 18 coefficients leave of the band-passed scalar over some rows, fitted to these.
pub(crate) fn bound_nt(scalar_nt: &[f64], flux_nt: &[[f64; 3]], counts: &[bool]) -> f64 {
    let scalar = DVector::from(chosen(&band_passed(scalar_nt), counts));
    let columns = columns_in_band(flux_nt, counts);
    let svd = columns.clone().svd(true, true);
    // The 18 hold combinations that are nothing but the derivative of a constant.
    let best = svd.solve(&scalar, 1e-10 * svd.singular_values.max()).unwrap();
    let rest = scalar - columns * best;
    super::statistics::std(rest.as_slice())
}

/// The 18 columns over some rows, band-passed, each of length one.
pub(crate) fn columns_in_band(flux_nt: &[[f64; 3]], counts: &[bool]) -> DMatrix<f64> {
    let in_band = |column: Vec<f64>| DVector::from(chosen(&band_passed(&column), counts)).normalize();
    let columns: Vec<DVector<f64>> = columns(flux_nt).into_iter().map(in_band).collect();
    DMatrix::from_columns(&columns)
}

/// The 18 columns of eq. (4), from the fluxgate alone and with its difference to the row before, as the core and the
/// published figures have them.
pub(crate) fn columns(flux_nt: &[[f64; 3]]) -> Vec<Vec<f64>> {
    let size = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let direction: Vec<[f64; 3]> = flux_nt.iter().map(|&v| v.map(|x| x / size(v))).collect();
    let last = direction.len() - 1;
    let rate = |row: usize| -> [f64; 3] {
        let before = row.saturating_sub(1);
        std::array::from_fn(|i| (direction[row][i] - direction[before][i]) * RATE_HZ)
    };
    let unit = |term: usize| std::array::from_fn(|k| if k == term { 1.0 } else { 0.0 });
    let column = |term: usize| {
        let at = |row: usize| interference(&unit(term), size(flux_nt[row]), direction[row], rate(row)).total_nt();
        (0..=last).map(at).collect()
    };
    (0..18).map(column).collect()
}

pub(crate) fn chosen(values: &[f64], counts: &[bool]) -> Vec<f64> {
    values.iter().zip(counts).filter(|(_, counts)| **counts).map(|(value, _)| *value).collect()
}

#[test]
fn the_middle_of_the_band_passes_without_delay_and_the_rest_does_not() {
    let sine =
        |hz: f64| -> Vec<f64> { (0..6000).map(|k| (std::f64::consts::TAU * hz * f64::from(k) / 10.0).sin()).collect() };
    let middle = sine(0.3);
    let off =
        |a: &[f64], b: &[f64]| a.iter().zip(b).skip(1000).take(4000).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off(&band_passed(&middle), &middle) < 1e-3);
    // Half the power at each edge and pass: half the amplitude in two.
    let edge = sine(0.1);
    assert!(off(&band_passed(&edge), &edge.iter().map(|x| 0.5 * x).collect::<Vec<_>>()) < 1e-3);
    assert!(band_passed(&sine(0.01)).iter().skip(1000).take(4000).all(|x| x.abs() < 1e-4));
}

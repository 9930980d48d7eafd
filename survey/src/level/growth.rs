//! Induced and eddy terms grow with the field.
//!
//! The terms are those of one field ([`super::terms::of_stretch`]), so that no coefficients can make the field itself of them. What a
//! field that changes along the tow adds is taken off the readings, of coefficients that are known so far: 20 nT of geology are 0.3 nT
//! of an induced 800, where a quiet sensor has 0.02 nT of noise.

use super::series::Series;
use super::smoother::Smoothed;
use super::terms::TOLD;
use crate::Tow;

/// The first of the combinations that grow with the field; permanent ones do not.
const FIRST_INDUCED: usize = 3;

/// Takes off the readings what induced and eddy terms have more than in the mean field, and gives it, nT, a row each.
pub(crate) fn take_off_growth(series: &mut Series, tows: &[Tow], smoothed: &[Smoothed]) -> Vec<f64> {
    let mut growth_nt = Vec::with_capacity(series.columns.len());
    for tow in tows {
        let of_tow = growth_of(series, tow, growth_nt.len(), smoothed);
        growth_nt.extend(of_tow);
    }
    let of_samples = series.averaged(&growth_nt);
    series.samples.iter_mut().zip(of_samples).for_each(|(sample, growth_nt)| sample.scalar_nt -= growth_nt);
    growth_nt
}

/// Of one recording, whose first row is `first` among all; zeros where a row is not usable.
fn growth_of(series: &Series, tow: &Tow, first: usize, smoothed: &[Smoothed]) -> Vec<f64> {
    let state = |row: usize| &smoothed[series.sample_of[first + row]];
    let field_nt = |row: usize| tow.scalar_nt[row] - state(row).interference_nt(&series.columns[first + row]);
    let fields: Vec<(usize, f64)> =
        (0..tow.len()).filter(|&row| tow.is_usable[row]).map(|row| (row, field_nt(row))).collect();
    let mean_nt = fields.iter().map(|(_, field_nt)| field_nt).sum::<f64>() / fields.len().max(1) as f64;
    let mut growth_nt = vec![0.0; tow.len()];
    for (row, field_nt) in fields {
        let grows = FIRST_INDUCED..TOLD;
        let grown_nt: f64 = grows.map(|k| state(row).state[k] * series.columns[first + row][k]).sum();
        growth_nt[row] = (field_nt / mean_nt - 1.0) * grown_nt;
    }
    growth_nt
}

//! From the smoothed coefficients to the field, and how well it is known.

use nalgebra::SVector;

use super::background::slow_part_by;
use super::series::Series;
use super::smoother::Smoothed;
use super::terms::{COMBINATIONS, TERMS, TOLD, expand, scale_of};
use super::uncertainty::{Covariance, KNOT_SAMPLES};
use crate::Tow;
use crate::statistics::median;

/// The background is what is slower than this, rows: 100 s.
const BACKGROUND_ROWS: f64 = 1_000.0;
/// Noise is what is quicker than this, rows: 10 s, where targets begin.
const NOISE_ROWS: f64 = 100.0;
/// Over so many rows the noise is told: a minute.
const NOISE_OVER_ROWS: usize = 600;
/// The median of squares of a normal value over its variance.
const MEDIAN_OF_SQUARES: f64 = 0.4549;

/// The field of all recordings, one after another, at its level; a value a row, NaN where a row is not usable.
#[derive(Clone, Debug)]
pub struct Level {
    /// Compensated total field, nT.
    pub field_nt: Vec<f64>,
    /// Its standard deviation, nT, but for one constant of all recordings.
    pub field_std_nt: Vec<f64>,
    /// The field less the background slower than 100 s, targets untouched, nT.
    pub anomaly_nt: Vec<f64>,
    /// Its standard deviation, nT: what is left in the minute around, beside the targets.
    pub anomaly_std_nt: Vec<f64>,
    /// The 18 terms in the mean field of each recording, nT a coefficient at 50,000 nT; zeros where a row is not usable.
    pub terms: Vec<[f64; TERMS]>,
    /// Coefficients in the units of eq. (4), mean over the rows. What is a constant to a recording, the sum of the three squares,
    /// is zero.
    pub coefficients: [f64; TERMS],
    /// Their standard deviations.
    pub coefficient_std: [f64; TERMS],
    /// First rows after the sensor was moved.
    pub moves: Vec<usize>,
}

pub(super) fn read_off(
    tows: &[Tow],
    targets_nt: &[f64],
    series: &Series,
    smoothed: &[Smoothed],
    covariances: &[Covariance],
    change_nt: &[f64],
) -> Level {
    let scalar = tows.iter().flat_map(|tow| tow.scalar_nt.iter().copied());
    let field = |(row, scalar_nt): (usize, f64)| {
        let interference_nt = || smoothed[series.sample_of[row]].interference_nt(&series.columns[row]) + change_nt[row];
        if series.is_usable[row] { scalar_nt - interference_nt() } else { f64::NAN }
    };
    let field_nt: Vec<f64> = scalar.enumerate().map(field).collect();
    let beside: Vec<f64> = field_nt.iter().zip(targets_nt).map(|(field, target)| field - target).collect();
    let weights = series.row_weights();
    let slow = slow_part_by(&series.row_parts, &beside, &weights, BACKGROUND_ROWS);
    let anomaly_nt = field_nt.iter().zip(slow).map(|(field, slow)| field - slow).collect();
    let anomaly_std_nt = noise_std_nt(series, &beside, &weights);
    let level_nt2 = |row: usize| {
        let columns = SVector::<f64, COMBINATIONS>::from(series.columns[row]);
        let covariance = &covariances[(series.sample_of[row] / KNOT_SAMPLES).min(covariances.len() - 1)];
        columns.dot(&(covariance * columns)).max(0.0)
    };
    let field_std_nt =
        anomaly_std_nt.iter().enumerate().map(|(row, std_nt)| (level_nt2(row) + std_nt * std_nt).sqrt()).collect();
    let (coefficients, coefficient_std) = coefficients(smoothed, covariances);
    let moves = (0..series.sample_of.len())
        .filter(|&row| {
            series.samples[series.sample_of[row]].moved
                && (row == 0 || series.sample_of[row - 1] != series.sample_of[row])
        })
        .collect();
    let terms = series.all_terms.clone();
    Level { field_nt, field_std_nt, anomaly_nt, anomaly_std_nt, terms, coefficients, coefficient_std, moves }
}

/// Standard deviation of what is quicker than targets are wide, in the minute around each row; a median, which no target moves.
fn noise_std_nt(series: &Series, beside: &[f64], weights: &[f64]) -> Vec<f64> {
    let slow = slow_part_by(&series.row_parts, beside, weights, NOISE_ROWS);
    let mut std_nt = vec![f64::NAN; beside.len()];
    for part in &series.row_parts {
        for begin in part.clone().step_by(NOISE_OVER_ROWS) {
            let near = begin.saturating_sub(NOISE_OVER_ROWS / 2).max(part.start)
                ..(begin + 3 * NOISE_OVER_ROWS / 2).min(part.end);
            let mut squares: Vec<f64> =
                near.map(|row| (beside[row] - slow[row]).powi(2)).filter(|v| v.is_finite()).collect();
            let Some(median) = median(&mut squares) else { continue };
            let std = (median / MEDIAN_OF_SQUARES).sqrt();
            let rows = begin..(begin + NOISE_OVER_ROWS).min(part.end);
            rows.filter(|&row| series.is_usable[row]).for_each(|row| std_nt[row] = std);
        }
    }
    std_nt
}

fn coefficients(smoothed: &[Smoothed], covariances: &[Covariance]) -> ([f64; TERMS], [f64; TERMS]) {
    let (samples, knots) = (smoothed.len().max(1) as f64, covariances.len().max(1) as f64);
    let mean = std::array::from_fn(|k| smoothed.iter().map(|smoothed| smoothed.state[k]).sum::<f64>() / samples);
    let covariance = covariances.iter().sum::<Covariance>() / knots;
    let mean = expand(&mean);
    let unit = |k: usize| expand(&std::array::from_fn(|other| f64::from(u8::from(other == k))));
    let units: Vec<[f64; TERMS]> = (0..TOLD).map(unit).collect();
    let variance = |term: usize| {
        let pairs = (0..TOLD).flat_map(|i| (0..TOLD).map(move |k| (i, k)));
        pairs.map(|(i, k)| units[i][term] * covariance[(i, k)] * units[k][term]).sum::<f64>()
    };
    let scaled = |term: usize| mean[term] / scale_of(term);
    (std::array::from_fn(scaled), std::array::from_fn(|term| variance(term).max(0.0).sqrt() / scale_of(term)))
}

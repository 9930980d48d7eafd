//! The band of targets: there the terms may need other coefficients than below it, as a fluxgate reads the field at its own
//! place. Only as far as the recording says so: the change is held near nothing.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::background::slow_part_by;
use super::kalman::{Model, Start, likelihood};
use super::model_search::Search;
use super::outliers::raise_variances;
use super::series::{SAMPLE_S, Sample, Series};
use super::smoother::{Smoothed, smooth};
use super::terms::{COMBINATIONS, MAGNITUDE, TOLD};

/// The change acts on what is quicker than this, s: half of it there, a fifth of it at 20 s. From 0.1 Hz on, where targets
/// begin, it has four fifths and more.
const PERIOD_S: f64 = 14.0;
const ROW_S: f64 = 0.1;
/// How far coefficients may be changed, nT; the recording tells which.
const STDS: [f64; 6] = [0.1, 1.0, 10.0, 100.0, 1_000.0, 10_000.0];
/// The share of a target that nobody has found which may go into the interference because coefficients move.
const MOST_EATEN: f64 = 0.015;

/// Targets are in the fluxgate when their share is so many standard deviations above none: errors of a fluxgate last for some
/// seconds, so that a few of them are chance.
const SHARE_STDS: f64 = 6.0;

/// What is to be taken off the field as well, nT, a row each. As long as no targets are known, the fluxgate's magnitude is left
/// alone: it has them, too.
pub(crate) fn correction(series: &Series, smoothed: &[Smoothed], targets_nt: Option<&[f64]>) -> Vec<f64> {
    let mut band = series.clone();
    for (sample, smoothed) in band.samples.iter_mut().zip(smoothed) {
        sample.scalar_nt -= smoothed.interference_nt(&sample.columns);
    }
    match targets_nt {
        Some(targets_nt) => without_targets_of_fluxgate(&mut band, targets_nt),
        None => without_magnitude(&mut band),
    }
    band.samples = high_passed(&band);
    let in_band = fitted(&mut band);
    let weights = series.row_weights();
    let mut taken = vec![0.0; band.columns.len()];
    for k in 0..COMBINATIONS {
        let values: Vec<f64> = band.columns.iter().map(|columns| columns[k]).collect();
        let slow = slow_part_by(&series.row_parts, &values, &weights, PERIOD_S / ROW_S);
        for (row, taken) in taken.iter_mut().enumerate() {
            *taken += (values[row] - slow[row]) * in_band[series.sample_of[row]].state[k];
        }
    }
    taken
}

/// The change of the coefficients, with readings far off counted less.
fn fitted(band: &mut Series) -> Vec<Smoothed> {
    let tried = |std: &f64| {
        let start = Start::near_zero(*std);
        let model = search(&band.samples, &start).likeliest(None);
        (likelihood(&band.samples, &start, &model).0, start, model)
    };
    let tried: Vec<(f64, Start, Model)> = STDS.par_iter().map(tried).collect();
    let Some((_, start, model)) = tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)) else { return Vec::new() };
    let smoothed = smooth(&band.samples, &start, &model, None);
    raise_variances(&mut band.samples, &smoothed);
    let model = search(&band.samples, &start).likeliest(Some(model));
    smooth(&band.samples, &start, &model, None)
}

fn search<'a>(samples: &'a [Sample], start: &'a Start) -> Search<'a> {
    let moves = [false, false, true];
    Search { samples, start, moves, most_eaten: Some(MOST_EATEN), most_moving_nt2_per_s: f64::INFINITY }
}

/// The samples without what is slower than the band.
pub(crate) fn high_passed(series: &Series) -> Vec<Sample> {
    let mut samples = series.samples.clone();
    let parts = series.sample_parts();
    let weights: Vec<f64> = samples.iter().map(|sample| 1.0 / sample.variance_ratio).collect();
    let quick = |values: Vec<f64>| {
        let slow = slow_part_by(&parts, &values, &weights, PERIOD_S / SAMPLE_S);
        values.into_iter().zip(slow).map(|(value, slow)| value - slow).collect::<Vec<f64>>()
    };
    for k in 0..COMBINATIONS {
        let column = quick(samples.iter().map(|sample| sample.columns[k]).collect());
        samples.iter_mut().zip(column).for_each(|(sample, value)| sample.columns[k] = value);
    }
    let first_nt = samples.first().map_or(0.0, |sample| sample.scalar_nt);
    let scalar_nt = quick(samples.iter().map(|sample| sample.scalar_nt - first_nt).collect());
    samples.iter_mut().zip(scalar_nt).for_each(|(sample, nt)| sample.scalar_nt = nt);
    samples
}

/// Take the fitted targets off the fluxgate's magnitude, as far as it has them: else the column of the magnitude would take
/// its share of every target off the field.
fn without_targets_of_fluxgate(series: &mut Series, targets_nt: &[f64]) {
    let share = share_in_fluxgate(series, targets_nt);
    let taken: Vec<f64> = targets_nt.iter().map(|nt| share * nt / 1_000.0).collect();
    let of_samples = series.averaged(&taken);
    for ((columns, taken), _) in
        series.columns.iter_mut().zip(taken).zip(&series.is_usable).filter(|(_, usable)| **usable)
    {
        columns[MAGNITUDE] -= taken;
    }
    for (sample, taken) in series.samples.iter_mut().zip(of_samples) {
        sample.columns[MAGNITUDE] -= taken;
    }
}

fn without_magnitude(series: &mut Series) {
    series.samples.iter_mut().for_each(|sample| sample.columns[MAGNITUDE] = 0.0);
    series.columns.iter_mut().for_each(|columns| columns[MAGNITUDE] = 0.0);
}

/// How much of the targets the fluxgate's magnitude has, from none to all: least squares in the band beside the terms.
fn share_in_fluxgate(series: &Series, targets_nt: &[f64]) -> f64 {
    let mut with_targets = series.clone();
    let targets: Vec<f64> = targets_nt.iter().map(|nt| nt / 1_000.0).collect();
    for (sample, target) in with_targets.samples.iter_mut().zip(series.averaged(&targets)) {
        sample.scalar_nt = target;
    }
    let samples = high_passed(&with_targets);
    let design = DMatrix::from_fn(samples.len(), TOLD + 1, |row, k| {
        if k < TOLD { samples[row].columns[k] } else { samples[row].scalar_nt }
    });
    let excess = DVector::from_fn(samples.len(), |row, _| samples[row].columns[MAGNITUDE]);
    let normal = design.transpose() * &design;
    let ridge = DMatrix::identity(TOLD + 1, TOLD + 1) * (1e-12 * normal.trace());
    let Some(inverse) = (normal + ridge).cholesky().map(|factor| factor.inverse()) else { return 0.0 };
    let solution = &inverse * (design.transpose() * &excess);
    let left = (excess - design * &solution).norm_squared() / samples.len() as f64;
    let is_told = solution[TOLD] > SHARE_STDS * (left * inverse[(TOLD, TOLD)]).sqrt();
    if is_told { solution[TOLD].min(1.0) } else { 0.0 }
}

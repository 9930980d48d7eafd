//! What share of a target that nobody has found a model would take along.

use super::kalman::{Model, Start};
use super::series::Sample;
use super::smoother::smooth;

/// Half the width of the targets that are tried, s: in the middle of what is towed past.
const HALF_WIDTH_S: f64 = 1.5;
/// Time between two of them, s: they do not feel each other.
const APART_S: f64 = 45.0;

/// Mean share of the amplitude of targets, one every 45 s, that goes into the interference.
pub(crate) fn eaten(samples: &[Sample], start: &Start, model: &Model) -> f64 {
    let mut time_s = 0.0;
    let pulses: Vec<f64> = samples
        .iter()
        .map(|sample| {
            time_s += sample.step_s;
            let count = (time_s / APART_S).round();
            let sign = if count.rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
            let along = (time_s - count * APART_S) / HALF_WIDTH_S;
            sign * (1.0 + along * along).powf(-2.5)
        })
        .collect();
    let pulse = |(sample, pulse_nt): (&Sample, &f64)| Sample { scalar_nt: *pulse_nt, ..*sample };
    let tried: Vec<Sample> = samples.iter().zip(&pulses).map(pulse).collect();
    let begun = Start { mean: [0.0; super::terms::COMBINATIONS], ..start.clone() };
    let smoothed = smooth(&tried, &begun, model, None);
    let taken: f64 =
        smoothed.iter().zip(&tried).map(|(at, sample)| at.interference_nt(&sample.columns) * sample.scalar_nt).sum();
    taken / pulses.iter().map(|nt| nt * nt).sum::<f64>().max(f64::MIN_POSITIVE)
}

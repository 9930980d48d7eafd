//! Readings that count less: those far off all others, as spikes are and what nobody has found yet, and those beside strong targets,
//! which no dipole describes that well.

use super::kalman::Model;
use super::series::{BLOCK_ROWS, Sample, Series};
use super::smoother::Smoothed;
use crate::Tow;

/// A reading that is so many standard deviations off all others has its variance raised.
const FAR_OFF: f64 = 4.0;

/// Count readings less that are far off all others. Returns how many.
pub(crate) fn raise_variances(samples: &mut [Sample], smoothed: &[Smoothed]) -> usize {
    let mut raised = 0;
    for (sample, smoothed) in samples.iter_mut().zip(smoothed) {
        if smoothed.off.abs() > FAR_OFF {
            sample.variance_ratio *= (smoothed.off / (0.5 * FAR_OFF)).powi(2);
            raised += 1;
        }
    }
    raised
}

/// A straight pass at an even speed is a model: it describes a target to this share of its anomaly.
pub(crate) const MODEL_ERROR: f64 = 0.03;

/// What each sample may be off by beside the usual noise, as a variance, nT^2: the fitted anomaly of targets, and readings that are
/// known to be noisier.
pub(crate) fn doubts_nt2(series: &Series, targets_nt: &[f64], tows: &[Tow]) -> Vec<f64> {
    let sizes: Vec<f64> = targets_nt.iter().map(|nt| MODEL_ERROR * nt.abs()).collect();
    let variance_nt2 = |tow: &Tow| tow.scalar_variance_nt2.clone().unwrap_or_else(|| vec![0.0; tow.len()]);
    let louder_nt2: Vec<f64> = tows.iter().flat_map(variance_nt2).collect();
    let of_mean = series.averaged(&louder_nt2).into_iter().map(|nt2| nt2 / BLOCK_ROWS as f64);
    series.averaged(&sizes).into_iter().zip(of_mean).map(|(nt, nt2)| nt * nt + nt2).collect()
}

/// Count readings less by those variances, over that of the reading's noise. Returns how many.
pub(crate) fn add_doubts(samples: &mut [Sample], doubts_nt2: &[f64], model: &Model) -> usize {
    let mut doubted = 0;
    for (sample, doubt_nt2) in samples.iter_mut().zip(doubts_nt2) {
        let ratio = doubt_nt2 / model.noise_nt2;
        if ratio > sample.variance_ratio {
            sample.variance_ratio = ratio;
            doubted += 1;
        }
    }
    doubted
}

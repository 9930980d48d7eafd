//! What comes at single moments and is none of a sensor's noise: a load that is switched, a part that jumps.

use super::blocks::Block;
use super::whitening::Predictor;
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::policy::{EVENT_LEAST_SHARE, EVENT_MOST_VARIANCE, EVENT_SIGMAS};

/// What of a series over the samples of some blocks, nT, follows from prediction errors that are larger than noise has, by as much as they
/// are; none where that is little of all of them. This is the cleaner of robust spectra (Kleiner, Martin and Thomson 1979), but for what
/// it takes the prediction from: after a step the series goes on as it is.
pub(super) fn events_nt(predictor: &Predictor, blocks: &[Block], values_nt: &[f64]) -> Option<Vec<f64>> {
    let errors = errors(predictor, blocks, values_nt);
    let most = EVENT_SIGMAS * robust_mean_square(&errors).sqrt();
    let beyond = |error: &f64| error - error.clamp(-most, most);
    let power = |errors: &[f64]| errors.iter().map(|error| error * error).sum::<f64>();
    let left: Vec<f64> = errors.iter().map(|error| error.clamp(-most, most)).collect();
    if power(&left) > (1.0 - EVENT_LEAST_SHARE) * power(&errors) {
        return None;
    }
    let mut events_nt = Vec::with_capacity(errors.len());
    for block in blocks {
        let samples = events_nt.len()..events_nt.len() + block.len();
        let beyond: Vec<f64> = errors[samples].iter().map(beyond).collect();
        events_nt.extend(predictor.inverse(&beyond));
    }
    Some(events_nt)
}

/// Whether what a predictor says of the noise is no less than what a series, nT, has most of the time.
pub(super) fn is_loud_enough(predictor: &Predictor, blocks: &[Block], values_nt: &[f64]) -> bool {
    robust_mean_square(&errors(predictor, blocks, values_nt)) < EVENT_MOST_VARIANCE
}

/// Prediction errors of a series over the samples of some blocks.
fn errors(predictor: &Predictor, blocks: &[Block], values_nt: &[f64]) -> Vec<f64> {
    let mut errors = vec![0.0; values_nt.len()];
    let mut start = 0;
    for block in blocks {
        let samples = start..start + block.len();
        predictor.apply(&values_nt[samples.clone()], &mut errors[samples]);
        start += block.len();
    }
    errors
}

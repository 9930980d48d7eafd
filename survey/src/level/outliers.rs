//! Readings that are far off all others: spikes, and what nobody has found yet.

use super::series::Sample;
use super::smoother::Smoothed;

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

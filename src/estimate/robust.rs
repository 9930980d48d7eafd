//! What an epoch counts that does not look like the others: weights and variances that no target decides.

use crate::policy::{CLIPPED_MEAN_SQUARE, INNOVATION_CLIP, LEAST_NOISE_VARIANCE, LEAST_STD_NT, MEDIAN_OF_NORMAL};

/// Weight of an epoch, 0 to 1, by its normalised innovation. It falls with the fourth power, so that what an epoch does
/// to the coefficients falls with the third: a target ten times as high as the gate does less than the noise does.
pub(crate) fn gate_weight(normalised_innovation: f32, gate: f32) -> f32 {
    let ratio = gate / normalised_innovation;
    if ratio < 1.0 { ratio * ratio * ratio * ratio } else { 1.0 }
}

/// A variance, nT^2, after one more epoch of that normalised innovation. `rate` is a share per epoch, 0 to 1; one epoch
/// multiplies the variance by 1 - `rate` to 1 + 5.4 `rate`.
pub(crate) fn tracked(variance: f32, normalised_innovation: f32, rate: f32) -> f32 {
    let clipped = normalised_innovation.min(INNOVATION_CLIP);
    let grown = variance + rate * variance * (clipped * clipped / CLIPPED_MEAN_SQUARE - 1.0);
    grown.max(LEAST_NOISE_VARIANCE)
}

/// A standard deviation, nT, after one more value. It follows the median of the sizes, which a target now and then hardly
/// moves. `rate` is a share per epoch, 0 to 1.
pub(crate) fn tracked_std(std_nt: f32, value_nt: f32, rate: f32) -> f32 {
    let more = libm::fabsf(value_nt) > MEDIAN_OF_NORMAL * std_nt;
    let grown = if more { std_nt + rate * std_nt } else { std_nt - rate * std_nt };
    grown.max(LEAST_STD_NT)
}

//! Configuration of the adaptive method: times in seconds turned into rates per epoch, once.

use crate::filter::BandPassDesign;
use crate::policy::{
    AGE_S, CORRELATION_S, DEGREES_OF_FREEDOM, EVIDENCE_S, FAILURE_WINDOW_S, FORGETTING_MULTIPLIERS, GATE, MEMBERS,
    NOISE_S, PLAIN, PLAIN_GATE, REINITIALISATION_S, TRIAL_S,
};
use core::f64::consts::TAU;

/// Largest share of its information that a member forgets per epoch, however large its multiplier.
const MOST_FORGOTTEN: f64 = 0.1;

/// How a member learns and forgets. Immutable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MemberConfig {
    /// Share of its information that it keeps from one epoch to the next, 0.9 to 1.
    pub(super) forgetting: f32,
    pub(super) sqrt_forgetting: f32,
    /// Normalised innovation beyond which an epoch weighs less.
    pub(super) gate: f32,
    /// Variance of the noise in the rows that it learns from over that of the band-passed rows, for statistically
    /// independent rows.
    pub(super) noise_gain: f32,
}

/// The adaptive method. Immutable; what it remembers is in [`Bank`](super::Bank). Rates are shares per epoch, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    pub(super) members: [MemberConfig; MEMBERS],
    /// Of the residual from epoch to epoch, 0 to 1: what differencing takes out.
    pub(super) correlation: f32,
    pub(super) noise_rate: f32,
    pub(super) evidence_rate: f32,
    /// Nats of log evidence to a unit of the Student loss: half of (degrees of freedom + 1), less as epochs are
    /// correlated.
    pub(super) evidence_per_epoch: f32,
    pub(super) age_epochs: u32,
    pub(super) failure_rate: f32,
    pub(super) reinitialisation_epochs: u32,
    pub(super) trial_epochs: u32,
    /// Stands for the calibration's information where that was not kept: `lambda2` of eq. (7).
    pub(super) unknown_weight: f32,
}

impl Adaptive {
    /// `forgetting` per epoch, above 0.9, at most 1; `lambda2` in the units of eq. (7) is what stands for the
    /// calibration's information where it was not kept; `band_pass` as the front end has it.
    pub fn new(forgetting: f64, lambda2: f64, band_pass: BandPassDesign) -> Self {
        let rate_hz = band_pass.sample_rate_hz;
        let epochs = |time_s: f64| libm::round(time_s * rate_hz).max(1.0);
        let rate = |time_s: f64| (1.0 / epochs(time_s)) as f32;
        let correlation = libm::exp(-1.0 / (CORRELATION_S * rate_hz));
        let independent = band_pass.samples_per_independent().max(1.0);
        let gains = [differencing_gain(correlation, band_pass), independent];
        Self {
            members: core::array::from_fn(|i| member(i, forgetting, gains)),
            correlation: correlation as f32,
            noise_rate: rate(NOISE_S),
            evidence_rate: rate(EVIDENCE_S),
            evidence_per_epoch: ((f64::from(DEGREES_OF_FREEDOM) + 1.0) / 2.0 / independent) as f32,
            age_epochs: epochs(AGE_S) as u32,
            failure_rate: rate(FAILURE_WINDOW_S),
            reinitialisation_epochs: epochs(REINITIALISATION_S) as u32,
            trial_epochs: epochs(TRIAL_S) as u32,
            unknown_weight: lambda2 as f32,
        }
    }
}

/// Member `i`, with the noise gains of rows that are differenced and of rows that are not.
fn member(i: usize, forgetting: f64, [differenced, plain]: [f64; 2]) -> MemberConfig {
    let forgetting = 1.0 - (FORGETTING_MULTIPLIERS[i] * (1.0 - forgetting)).min(MOST_FORGOTTEN);
    let (gate, noise_gain) = if i == PLAIN { (PLAIN_GATE, plain) } else { (GATE, differenced) };
    MemberConfig {
        forgetting: forgetting as f32,
        sqrt_forgetting: libm::sqrt(forgetting) as f32,
        gate,
        noise_gain: noise_gain as f32,
    }
}

/// Variance of the differences `x(t) - rho x(t - 1)` over that of the band-passed rows, for a spectrum that fills the
/// band: the mean of `|1 - rho exp(-i w)|^2` over it. Rows that were not differenced count as this much information.
fn differencing_gain(correlation: f64, band_pass: BandPassDesign) -> f64 {
    let [low, high] = [band_pass.low_hz, band_pass.high_hz].map(|hz| TAU * hz / band_pass.sample_rate_hz);
    let mean_cosine = (libm::sin(high) - libm::sin(low)) / (high - low);
    1.0 + correlation * correlation - 2.0 * correlation * mean_cosine
}

//! Configuration of the adaptive method: times in seconds turned into rates per epoch, once.

use super::member::Manner;
use super::{HASTES, MEMBERS, PLAIN};
use crate::filter::BandPassDesign;
use core::f64::consts::TAU;

/// Multiple of the predicted standard deviation beyond which an epoch weighs less.
pub(super) const GATE: f32 = 1.45;

/// The same for the plain member: what a misfit of the model leaves at the crests of waves is to be learnt, not kept out.
const WIDE_GATE: f32 = 2.5;

/// Beyond this multiple an epoch says no more about the noise, and counts as a surprise.
pub(super) const CLIP: f32 = 2.5;

/// Mean of `min(r, CLIP)^2` for a standard normal `r`.
pub(super) const CLIPPED_MEAN_SQUARE: f32 = 0.978;

/// Degrees of freedom of the Student distribution that judges predictions.
pub(super) const DEGREES_OF_FREEDOM: f32 = 4.0;

/// Evidence that a member starts anew with, nats below the best.
pub(super) const HANDICAP: f32 = 10.0;

/// No member falls further behind the best, nats: it can come back within two windows.
pub(super) const LEAST_EVIDENCE: f32 = -30.0;

/// Information of a member that knows nothing, per term of one nT: its coefficients are of the order of 10,000 nT.
pub(super) const NO_INFORMATION: f32 = 1e-10;

/// Least variance of the noise, nT^2.
pub(super) const LEAST_VARIANCE: f32 = 1e-8;

/// Correlation time of what the model leaves within the band, s.
const CORRELATION_S: f64 = 0.45;
/// Time over which the noise is tracked, s: longer than a target, shorter than a manoeuvre.
const NOISE_S: f64 = 30.0;
/// Window of the evidence, s.
const EVIDENCE_S: f64 = 60.0;
/// Least age of the coefficients whose predictions are judged, s: as long as a target's peak.
const AGE_S: f64 = 1.5;
/// Time over which surprises are counted, s: a target fills less than half of it.
const SURPRISE_S: f64 = 10.0;
/// Least time between two new starts, s.
const LEAST_TRIAL_S: f64 = 30.0;
/// The free member with the long memory starts anew when it has not taken the lead by then, s.
const TRIAL_S: f64 = 600.0;

/// The adaptive method. Immutable; what it remembers is in [`Bank`](super::Bank).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    pub(super) manners: [Manner; MEMBERS],
    pub(super) correlation: f32,
    pub(super) noise_rate: f32,
    pub(super) evidence_rate: f32,
    pub(super) evidence_per_epoch: f32,
    pub(super) age_epochs: u32,
    pub(super) surprise_rate: f32,
    pub(super) least_trial_epochs: u32,
    pub(super) trial_epochs: u32,
    pub(super) unknown_weight: f32,
}

impl Adaptive {
    /// `forgetting` per epoch, above 0.9, at most 1; `lambda2` in the units of eq. (7) is what stands for the
    /// calibration's information where it was not kept; `band_pass` as the front end has it.
    pub fn new(forgetting: f64, lambda2: f64, band_pass: BandPassDesign) -> Self {
        let rate_hz = band_pass.sample_rate_hz;
        let epochs = |time_s: f64| libm::round(time_s * rate_hz).max(1.0);
        let correlation = libm::exp(-1.0 / (CORRELATION_S * rate_hz));
        let gain = noise_gain(correlation, band_pass);
        let independent = band_pass.samples_per_independent().max(1.0);
        let manner = |i: usize| {
            let forgetting = 1.0 - (HASTES[i] * (1.0 - forgetting)).min(0.1);
            let (gate, noise_gain) = if i == PLAIN { (WIDE_GATE, independent) } else { (GATE, gain) };
            Manner {
                forgetting: forgetting as f32,
                sqrt_forgetting: libm::sqrt(forgetting) as f32,
                gate,
                noise_gain: noise_gain as f32,
            }
        };
        Self {
            manners: core::array::from_fn(manner),
            correlation: correlation as f32,
            noise_rate: (1.0 / epochs(NOISE_S)) as f32,
            evidence_rate: (1.0 / epochs(EVIDENCE_S)) as f32,
            evidence_per_epoch: ((f64::from(DEGREES_OF_FREEDOM) + 1.0) / 2.0 / independent) as f32,
            age_epochs: epochs(AGE_S) as u32,
            surprise_rate: (1.0 / epochs(SURPRISE_S)) as f32,
            least_trial_epochs: epochs(LEAST_TRIAL_S) as u32,
            trial_epochs: epochs(TRIAL_S) as u32,
            unknown_weight: lambda2 as f32,
        }
    }
}

/// Variance of the differences `x(t) - rho x(t - 1)` over that of the band-passed rows, for a spectrum that fills the band:
/// the mean of `|1 - rho exp(-i w)|^2` over it. Rows that were not differenced count as this much information.
fn noise_gain(correlation: f64, band_pass: BandPassDesign) -> f64 {
    let [low, high] = [band_pass.low_hz, band_pass.high_hz].map(|hz| TAU * hz / band_pass.sample_rate_hz);
    let mean_cosine = (libm::sin(high) - libm::sin(low)) / (high - low);
    1.0 + correlation * correlation - 2.0 * correlation * mean_cosine
}

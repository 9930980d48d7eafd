//! Configuration of the level: times in seconds turned into rates per epoch, once.

use super::super::square_root_information::SquareRootInformation;
use super::columns::LEFT_OUT;
use super::whitening::Whitening;
use crate::filter::{BandPass, BandPassDesign, BandPassError};
use crate::model::{Coefficients, TermVector};
use crate::policy::{
    LEVEL_ANCHOR_S, LEVEL_CORNER_HZ, LEVEL_FAILURE_S, LEVEL_HOLD_S, LEVEL_JUDGE_S, LEVEL_LOW_PASS_HZ, LEVEL_MEMORY_S,
    LEVEL_STD_NT, LEVEL_SWITCH_S, NOISE_S, REINITIALISATION_S,
};

/// How the level is learnt and written. Immutable. Rates are shares per epoch, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    pub(super) rate_hz: f32,
    pub(super) whitening: Whitening,
    pub(super) sqrt_forgetting: f32,
    pub(super) noise_rate: f32,
    /// Share of a surprise that is left an epoch later.
    pub(super) held: f32,
    pub(super) failure_rate: f32,
    pub(super) restart_epochs: u32,
    pub(super) band_pass: BandPass,
    pub(super) anchor_rate: f32,
    pub(super) low_pass_rate: f64,
    pub(super) judge_rate: f32,
    pub(super) switch_rate: f32,
}

impl Level {
    /// For epochs as the front end has them.
    pub fn new(design: BandPassDesign) -> Result<Self, BandPassError> {
        let rate_hz = design.sample_rate_hz;
        let rate = |time_s: f64| 1.0 - libm::exp(-1.0 / (time_s * rate_hz));
        Ok(Self {
            rate_hz: rate_hz as f32,
            whitening: Whitening::new(LEVEL_CORNER_HZ, rate_hz),
            sqrt_forgetting: libm::exp(-0.5 / (LEVEL_MEMORY_S * rate_hz)) as f32,
            noise_rate: rate(NOISE_S) as f32,
            held: libm::exp(-1.0 / (LEVEL_HOLD_S * rate_hz)) as f32,
            failure_rate: rate(LEVEL_FAILURE_S) as f32,
            restart_epochs: libm::round(REINITIALISATION_S * rate_hz) as u32,
            band_pass: design.build()?,
            anchor_rate: rate(LEVEL_ANCHOR_S) as f32,
            low_pass_rate: rate(1.0 / (core::f64::consts::TAU * LEVEL_LOW_PASS_HZ)),
            judge_rate: rate(LEVEL_JUDGE_S) as f32,
            switch_rate: rate(LEVEL_SWITCH_S) as f32,
        })
    }
}

/// A factor that knows no more than how large the coefficients of a body can be.
pub(super) fn uninformed() -> SquareRootInformation {
    let weight = |std_nt: f32| 1.0 / (std_nt * std_nt);
    let [permanent, induced, eddy] = LEVEL_STD_NT.map(weight);
    let weights = TermVector::from_fn(|i, _| match i {
        // One nT to a column that stays zero: without a diagonal nothing would be forgotten.
        _ if LEFT_OUT.contains(&i) => 1.0,
        0..3 => permanent,
        3..9 => induced,
        _ => eddy,
    });
    SquareRootInformation::independent(&weights, &Coefficients::ZERO)
}

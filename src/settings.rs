//! What an operator can set: in SI and field units, validated once, before anything runs.

use crate::estimate::ElasticNet;
use crate::filter::{BandPassDesign, BandPassError};

/// How the coefficients follow the data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// No compensation: all coefficients zero.
    None,
    /// The calibrated coefficients throughout.
    Fixed,
    /// Recursive least squares with forgetting.
    Rls,
    /// The published saddle-point elastic net, eqs. (8) to (18).
    SaddlePoint,
    /// A bank of estimators that keep more or less of the calibration, averaged by how well they predict.
    Adaptive,
}

/// Settings of a [`Pipeline`](crate::Pipeline) and of a [`Calibration`](crate::estimate::Calibration).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Band-pass of eq. (6), and the sample rate.
    pub band_pass: BandPassDesign,
    /// How the coefficients follow the data.
    pub method: Method,
    /// Penalties of eqs. (7) and (8).
    pub penalty: ElasticNet,
    /// Forgetting per epoch, `gamma` of eq. (8): above 0.9, at most 1. 0.9999 remembers about 1,000 s at 10 Hz.
    pub forgetting: f64,
    /// Step of the dual variable, `nu` of eq. (14): above 0, at most 10.
    pub dual_step: f64,
}

impl Default for Settings {
    /// The published parameters, section 3.1, with this project's method.
    fn default() -> Self {
        Self {
            band_pass: BandPassDesign::default(),
            method: Method::Adaptive,
            penalty: ElasticNet::default(),
            forgetting: 0.9999,
            dual_step: 0.9,
        }
    }
}

/// Which setting is wrong, and what it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SettingsError {
    /// The band-pass cannot be built.
    BandPass(BandPassError),
    /// A number is out of its range.
    OutOfRange {
        /// Name of the setting.
        name: &'static str,
        /// What it was set to.
        value: f64,
        /// What it may be.
        allowed: &'static str,
    },
}

impl core::fmt::Display for SettingsError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::BandPass(error) => error.fmt(f),
            Self::OutOfRange { name, value, allowed } => write!(f, "{name} is {value}: choose {allowed}"),
        }
    }
}

impl core::error::Error for SettingsError {}

impl From<BandPassError> for SettingsError {
    fn from(error: BandPassError) -> Self {
        Self::BandPass(error)
    }
}

impl Settings {
    /// Check every number against its range; the band-pass is checked where it is built.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let ElasticNet { lambda1, lambda2 } = self.penalty;
        let check = |name, value: f64, fits: bool, allowed| {
            if fits { Ok(()) } else { Err(SettingsError::OutOfRange { name, value, allowed }) }
        };
        check("lambda1", lambda1, (0.0..=1e6).contains(&lambda1), "0 to 1000000")?;
        check("lambda2", lambda2, (1e-9..=1e6).contains(&lambda2), "0.000000001 to 1000000")?;
        let forgetting = self.forgetting;
        check("forgetting", forgetting, forgetting > 0.9 && forgetting <= 1.0, "above 0.9, at most 1")?;
        check("dual_step", self.dual_step, self.dual_step > 0.0 && self.dual_step <= 10.0, "above 0, at most 10")
    }
}

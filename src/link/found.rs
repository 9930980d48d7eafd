//! What a calibration on the body found, for a person to judge.

use crate::estimate::CalibrationResult;
use crate::fluxgate_calibration::FluxgateResult;
use crate::model::{Coefficients, NT_PER_UNIT, TERMS};

/// What a calibration found, of either kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// The 18 coefficients.
    Terms(CalibrationSummary),
    /// The axes of the fluxgate.
    Fluxgate(FluxgateResult),
}

/// What a calibration of the 18 terms found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationSummary {
    /// The coefficients that minimise eq. (7).
    pub coefficients: Coefficients,
    /// Standard deviation of each coefficient, in the units of eq. (4) as [`Coefficients::to_paper_units`]: nT, nT per
    /// nT, seconds.
    pub std: [f64; TERMS],
    /// Standard deviation of the band-passed scalar before over after compensation, on the calibration's own data.
    pub improvement_ratio: f64,
    /// Largest over smallest singular value of the scaled terms. Some thousands after turns on all axes and headings.
    pub condition_number: f32,
    /// Epochs behind the result.
    pub used_epochs: u32,
    /// Standard deviation of the band-passed scalar, nT.
    pub std_before_nt: f64,
    /// Root mean square of what the coefficients leave of it, nT.
    pub rms_after_nt: f64,
}

impl From<&CalibrationResult> for CalibrationSummary {
    fn from(result: &CalibrationResult) -> Self {
        let CalibrationResult {
            coefficients, std_nt, condition_number, used_epochs, std_before_nt, rms_after_nt, ..
        } = *result;
        Self {
            coefficients,
            std: core::array::from_fn(|i| f64::from(std_nt[i]) / NT_PER_UNIT[i]),
            improvement_ratio: std_before_nt / rms_after_nt,
            condition_number,
            used_epochs,
            std_before_nt,
            rms_after_nt,
        }
    }
}

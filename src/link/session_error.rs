//! Why a calibration does not do what the operator tells it.

use crate::SettingsError;
use crate::estimate::CalibrationError;
use crate::fluxgate_calibration::FluxgateCalibrationError;

/// Why the session does not do what it is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SessionError {
    /// One is being recorded already.
    Running,
    /// A result waits to be accepted or discarded.
    Waiting,
    /// None is being recorded.
    NotRunning,
    /// There is no result to accept.
    NoResult,
    /// The settings do not allow a calibration.
    Settings(SettingsError),
    /// There is no result; the session goes on recording when it was only too short.
    Calibration(CalibrationError),
    /// There is none of the fluxgate; the session goes on recording when more of it can help.
    Fluxgate(FluxgateCalibrationError),
}

impl SessionError {
    /// Whether the session goes on recording, so that the operator can bring what is missing.
    pub(super) fn goes_on(&self) -> bool {
        match self {
            Self::Calibration(CalibrationError::TooShort { .. }) => true,
            Self::Fluxgate(error) => error.goes_on(),
            _ => false,
        }
    }
}

impl core::fmt::Display for SessionError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Running => f.write_str("a calibration is running: calibrate stop or calibrate discard yes"),
            Self::Waiting => f.write_str("a result is waiting: calibrate accept yes or calibrate discard yes"),
            Self::NotRunning => f.write_str("no calibration is running: calibrate start or calibrate fluxgate"),
            Self::NoResult => f.write_str("no result to accept: calibrate start, turn the body, calibrate stop"),
            Self::Settings(error) => error.fmt(f),
            Self::Calibration(error) => error.fmt(f),
            Self::Fluxgate(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SessionError {}

//! Where the methods of a command start from.

use std::path::Path;

use towmag::model::{Coefficients, TERMS};

use crate::coefficients_file::CoefficientsFile;
use crate::error::HostError;
use crate::recording::{is_device_log, prior_from_log};
use crate::run::Start;

/// Where methods start from: a coefficients file, or nothing at all.
pub fn start_from(coefficients: Option<&Path>) -> Result<Start, HostError> {
    let Some(path) = coefficients else {
        return Ok(Start { prior: Coefficients::ZERO.into(), std: [0.0; TERMS] });
    };
    let file = CoefficientsFile::read(path)?;
    Ok(start_at(&file))
}

/// Where methods start from on this recording: a coefficients file, or else what a device log says that the body has
/// started from, or nothing at all.
pub(super) fn start_on(recording: &Path, coefficients: Option<&Path>) -> Result<Start, HostError> {
    let start = start_from(coefficients)?;
    if coefficients.is_some() || !is_device_log(recording) {
        return Ok(start);
    }
    Ok(match prior_from_log(recording)? {
        Some(prior) => Start { prior, ..start },
        None => start,
    })
}

/// Where methods start from: a calibration.
pub fn start_at(file: &CoefficientsFile) -> Start {
    let prior = file.prior().expect("checked when it was read or made");
    Start { prior, std: file.std() }
}

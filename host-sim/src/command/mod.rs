//! What the commands do. Each takes typed arguments, writes its results as a whole or not at all, and returns what
//! the command line prints.

mod calibrate;
mod compare;
mod diagnose;
mod diagnose_report;
#[cfg(unix)]
mod emulate;
mod recover;
mod replay;
mod report_data;
mod sample;
mod simulate;
mod table;
mod trial;

pub use calibrate::{CalibrateResult, calibrate};
pub use compare::{CompareOptions, CompareResult, compare};
pub use diagnose::{DiagnoseOptions, diagnose};
#[cfg(unix)]
pub use emulate::{EmulateResult, emulate};
pub use recover::{RecoverResult, recover};
pub use replay::replay;
pub use sample::{recording, sample};
pub use simulate::{SimulateResult, Through, simulate};
pub use table::{Entry, LATE_S, Table, Tow, table};
pub use trial::trial;

use std::path::Path;

use towmag::estimate::Prior;
use towmag::model::{Coefficients, TERMS};

use crate::coefficients_file::CoefficientsFile;
use crate::error::HostError;
use crate::recording::{RecordingError, prior_told, starts_as_log};
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
fn start_on(recording: &Path, coefficients: Option<&Path>) -> Result<Start, HostError> {
    let start = start_from(coefficients)?;
    Ok(match told(recording)?.filter(|_| coefficients.is_none()) {
        Some(prior) => Start { prior, ..start },
        None => start,
    })
}

/// What a device log says that the body has started from; `None` for other recordings.
fn told(recording: &Path) -> Result<Option<Prior>, HostError> {
    if !starts_as_log(recording) {
        return Ok(None);
    }
    let io = |source| RecordingError::Io { path: recording.display().to_string(), source };
    Ok(prior_told(recording).map_err(io)?)
}

/// Where methods start from: a calibration.
pub fn start_at(file: &CoefficientsFile) -> Start {
    let prior = file.prior().expect("checked when it was read or made");
    Start { prior, std: file.std() }
}

/// Refuse to write a result over what it is made from.
fn keep_inputs(inputs: &[&Path], out: &Path, results: &[&str]) -> Result<(), HostError> {
    for input in inputs {
        let Ok(input_found) = input.canonicalize() else { continue };
        if results.iter().any(|result| out.join(result).canonicalize().is_ok_and(|found| found == input_found)) {
            let (input, out) = (input.display(), out.display());
            return Err(HostError::Usage(format!(
                "{input} would be replaced by a result: choose another --out than {out}"
            )));
        }
    }
    Ok(())
}

/// The file name without its folders, for what is shown.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

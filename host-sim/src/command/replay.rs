//! `host-sim replay`: a recording through the firmware's core, row by row.

use std::path::Path;

use towmag::{Method, Settings};

use super::inputs::keep_inputs;
use super::report_data::report_data;
use super::start::start_on;
use crate::compensated_csv::CompensatedCsv;
use crate::error::HostError;
use crate::output::OutputDir;
use crate::recording::{self, RecordingReader};
use crate::report::{Kind, render};
use crate::run::{Passed, Start, pass};
use crate::summary::{Summary, to_json};

const RESULTS: [&str; 3] = ["compensated.csv", "report.html", "summary.json"];

/// Replay a recording with the method of `settings` and write what came out, the summary and the report.
pub fn replay(
    recording: &Path,
    coefficients: Option<&Path>,
    out: &Path,
    settings: &Settings,
) -> Result<Summary, HostError> {
    if coefficients.is_none() && settings.method == Method::Fixed {
        return Err(HostError::Usage("--method fixed needs --coefficients: run `host-sim calibrate` first".into()));
    }
    let inputs: Vec<&Path> = [Some(recording), coefficients].into_iter().flatten().collect();
    keep_inputs(&inputs, out, &RESULTS)?;
    let start = start_on(recording, coefficients)?;
    let output = OutputDir::create(out)?;
    write_replay(&mut *recording::open(recording)?, output, settings, &start)
}

/// The same of a recording that is open already, whatever its format.
pub fn replay_opened(
    recording: &mut dyn RecordingReader,
    start: &Start,
    out: &Path,
    settings: &Settings,
) -> Result<Summary, HostError> {
    write_replay(recording, OutputDir::create(out)?, settings, start)
}

fn write_replay(
    recording: &mut dyn RecordingReader,
    output: OutputDir,
    settings: &Settings,
    start: &Start,
) -> Result<Summary, HostError> {
    let passed = compensate(recording, &output, settings, start)?;
    let summary = Summary::new(&passed.methods[0], &passed.counts);
    let report = report_data(Kind::Replay, recording.file().as_ref(), passed, settings, None);
    output.write("report.html", render(&report)?)?;
    output.write("summary.json", to_json(&summary))?;
    output.commit("summary.json")?;
    Ok(summary)
}

fn compensate(
    recording: &mut dyn RecordingReader,
    output: &OutputDir,
    settings: &Settings,
    start: &Start,
) -> Result<Passed, HostError> {
    let mut csv = CompensatedCsv::new(output.create_file("compensated.csv")?, recording.schema())?;
    let passed = pass(recording, &[settings.method], settings, start, |passed| Ok(csv.write(&passed)?))?;
    csv.finish()?.finish()?;
    if passed.counts.used_rows == 0 {
        return Err(HostError::NotEnough(format!(
            "{}: has no two rows in succession with a valid scalar and fluxgate reading",
            recording.file()
        )));
    }
    Ok(passed)
}

//! `host-sim replay`: a recording through the firmware's core, row by row.

use std::path::Path;

use serde_json::json;
use towmag::{Method, Settings};

use super::hidden::mark_hidden;
use super::inputs::keep_inputs;
use super::report_data::report_data;
use super::start::start_on;
use super::survey::mark_contacts;
use crate::compensated_csv::CompensatedCsv;
use crate::error::HostError;
use crate::message::file_name;
use crate::output::OutputDir;
use crate::provenance::{InputBytes, Provenance, estimator_options};
use crate::recording::{Input, RecordingError, RecordingReader};
use crate::report::{Kind, render};
use crate::run::{CoefficientCheck, Passed, Start, method_name, pass};
use crate::summary::{Summary, to_json};
use crate::text::mismatch;

const RESULTS: [&str; 3] = ["compensated.csv", "report.html", "summary.json"];

/// Replay a recording with the method of `settings` and write what came out, the summary and the report.
pub fn replay(
    recording: impl Into<Input>,
    coefficients: Option<&Path>,
    out: &Path,
    settings: &Settings,
) -> Result<Summary, HostError> {
    if coefficients.is_none() && settings.method == Method::Fixed {
        return Err(HostError::Usage("--method fixed needs --coefficients: run `host-sim calibrate` first".into()));
    }
    let recording = recording.into();
    let inputs: Vec<&Path> = [recording.named(), coefficients].into_iter().flatten().collect();
    keep_inputs(&inputs, out, &RESULTS)?;
    let recording = recording.ready()?;
    let start = start_on(recording.path(), coefficients)?;
    let output = OutputDir::create(out)?;
    let check = coefficients.map(|_| CoefficientCheck::new(settings.band_pass)).transpose()?;
    let again = Again { provenance: provenance(&recording, coefficients, settings)?, input: &recording };
    write_replay(&mut *recording.open()?, output, settings, &start, check, Some(again))
}

/// The same of a recording that is open already, whatever its format.
pub fn replay_opened(
    recording: &mut dyn RecordingReader,
    start: &Start,
    out: &Path,
    settings: &Settings,
) -> Result<Summary, HostError> {
    write_replay(recording, OutputDir::create(out)?, settings, start, None, None)
}

/// A recording that can be read again.
struct Again<'a> {
    input: &'a Input,
    provenance: Provenance,
}

fn provenance(
    recording: &Input,
    coefficients: Option<&Path>,
    settings: &Settings,
) -> Result<Provenance, RecordingError> {
    let mut inputs = vec![InputBytes::of_recording("recording", recording)?];
    inputs.extend(InputBytes::of_files(&[("coefficients", coefficients)])?);
    let mut options = estimator_options(settings);
    options["method"] = json!(method_name(settings.method));
    Ok(Provenance::new("replay", options, inputs))
}

fn write_replay(
    recording: &mut dyn RecordingReader,
    output: OutputDir,
    settings: &Settings,
    start: &Start,
    mut check: Option<CoefficientCheck>,
    again: Option<Again<'_>>,
) -> Result<Summary, HostError> {
    let passed = compensate(recording, &output, settings, start, check.as_mut())?;
    let found = check.and_then(|check| check.verdict(&start.prior.coefficients));
    let warnings: Vec<String> = found.iter().map(mismatch::sentence).collect();
    let provenance = again.as_ref().map(|again| again.provenance.clone());
    let summary =
        Summary { warnings: warnings.clone(), provenance, ..Summary::new(&passed.methods[0], &passed.counts) };
    let rows = passed.counts.rows;
    let mut report = report_data(Kind::Replay, &file_name(recording.file().as_ref()), passed, settings, None);
    report.warnings.extend(warnings);
    mark_hidden(&mut report, recording.file().as_ref());
    if let Some(again) = &again {
        mark_contacts(&mut report, again.input, rows);
    }
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
    mut check: Option<&mut CoefficientCheck>,
) -> Result<Passed, HostError> {
    let mut csv = CompensatedCsv::new(output.create_file("compensated.csv")?, recording.schema())?;
    let passed = pass(recording, &[settings.method], settings, start, |passed| {
        if let Some(check) = check.as_mut().filter(|_| passed.row.is_on_grid) {
            check.step(&passed.row.epoch);
        }
        Ok(csv.write(&passed)?)
    })?;
    csv.finish()?.finish()?;
    if passed.counts.used_rows == 0 {
        return Err(HostError::NotEnough(format!(
            "{}: has no two rows in succession with a valid scalar and fluxgate reading",
            recording.file()
        )));
    }
    Ok(passed)
}

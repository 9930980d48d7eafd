//! `host-sim emulate`: the real firmware image, fed with a recording.

use std::path::{Path, PathBuf};

use towmag::log::EventKind;
use towmag::{Method, Settings};

use super::inputs::keep_inputs;
use super::report_data::report_data;
use super::start::start_from;
use crate::compensated_csv::CompensatedCsv;
use crate::emulator::{Emulated, EmulationSettings, Onlooker, emulate as run, in_instructions};
use crate::error::HostError;
use crate::output::OutputDir;
use crate::recording::Input;
use crate::report::{Kind, render};
use crate::run::{Passed, Start, pass_given};
use crate::summary::{Summary, to_json};

const RESULTS: [&str; 6] =
    ["compensated.csv", "report.html", "summary.json", "log.bin", "telemetry.bin", "figures.json"];

/// What an emulation showed.
pub struct EmulateResult {
    /// As of a replay.
    pub summary: Summary,
    /// What was compared, and the body's own figures.
    pub emulated: Emulated,
    /// Where the files are.
    pub out: PathBuf,
}

impl EmulateResult {
    /// What was compared and what it cost, for a person.
    pub fn heading(&self) -> String {
        let Emulated { epochs, starts, log_epochs, events, texts, .. } = &self.emulated;
        let mut lines = vec![format!(
            "{epochs} epochs of the emulated body equal the replay of the same bytes bit for bit ({log_epochs} of them in the log, {starts} start(s))"
        )];
        lines.extend(events.iter().filter_map(|event| match &event.kind {
            EventKind::Panic(message) => Some(format!("The log holds a panic: {message}")),
            _ => None,
        }));
        lines.extend(texts.iter().map(|text| format!("> {text}")));
        lines.extend(
            in_instructions(&self.emulated.figures).iter().map(|(name, value)| format!("{name:<32}{value:>9}")),
        );
        lines.join("\n")
    }
}

/// Run the firmware over a recording, hold it against the replay of the same bytes, and write what came out.
pub fn emulate(
    recording: impl Into<Input>,
    coefficients: Option<&Path>,
    out: &Path,
    settings: &Settings,
    emulation: &EmulationSettings,
) -> Result<EmulateResult, HostError> {
    emulate_watched(recording, coefficients, out, settings, emulation, None)
}

/// The same while somebody looks on.
pub fn emulate_watched(
    recording: impl Into<Input>,
    coefficients: Option<&Path>,
    out: &Path,
    settings: &Settings,
    emulation: &EmulationSettings,
    onlooker: Option<Onlooker>,
) -> Result<EmulateResult, HostError> {
    if coefficients.is_none() && settings.method == Method::Fixed {
        return Err(HostError::Usage("--method fixed needs --coefficients: run `host-sim calibrate` first".into()));
    }
    let recording = recording.into();
    let inputs: Vec<&Path> =
        [recording.named(), coefficients, Some(emulation.image.as_path())].into_iter().flatten().collect();
    keep_inputs(&inputs, out, &RESULTS)?;
    let start = start_from(coefficients)?;
    let output = OutputDir::create(out)?;
    let recording = recording.ready()?;
    let emulated = run(recording.clone(), settings, start.prior, emulation, onlooker)?;
    output.write("log.bin", &emulated.log)?;
    output.write("telemetry.bin", &emulated.telemetry)?;
    output.write("figures.json", to_json(&in_instructions(&emulated.figures)))?;
    let passed = compensate(&recording, &output, settings, &start, &emulated)?;
    let summary = Summary::new(&passed.methods[0], &passed.counts);
    let report = report_data(Kind::Replay, &recording.file_name(), passed, settings, None);
    output.write("report.html", render(&report)?)?;
    output.write("summary.json", to_json(&summary))?;
    output.commit("summary.json")?;
    Ok(EmulateResult { summary, emulated, out: out.into() })
}

fn compensate(
    recording: &Input,
    output: &OutputDir,
    settings: &Settings,
    start: &Start,
    emulated: &Emulated,
) -> Result<Passed, HostError> {
    let mut recording = recording.open()?;
    let mut csv = CompensatedCsv::new(output.create_file("compensated.csv")?, recording.schema())?;
    let (pipeline, outputs) = (emulated.pipeline.clone(), emulated.outputs.clone());
    let passed = pass_given(&mut *recording, settings, start, pipeline, outputs, |passed| Ok(csv.write(&passed)?))?;
    csv.finish()?.finish()?;
    Ok(passed)
}

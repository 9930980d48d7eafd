//! `host-sim compare`: every method on one recording in one run.

use std::path::{Path, PathBuf};

use serde::Serialize;
use towmag::{Method, Settings};

use super::calibrate::fit;
use super::hidden::mark_hidden;
use super::inputs::keep_inputs;
use super::report_data::{CalibrationFacts, report_data};
use super::start::start_at;
use super::survey::mark_contacts;
use crate::detection::{Combination, InjectionSettings, combination, standard_targets};
use crate::error::HostError;
use crate::output::OutputDir;
use crate::recording::{BadRows, Input};
use crate::report::{Kind, headline, render};
use crate::run::pass;
use crate::summary::{Summary, to_json};

/// Every method, in the order of the paper's tables.
const METHODS: [Method; 5] = [Method::None, Method::Fixed, Method::Rls, Method::SaddlePoint, Method::Adaptive];

const RESULTS: [&str; 3] = ["coefficients.toml", "report.html", "summary.json"];

/// What `summary.json` holds after a comparison.
#[derive(Serialize)]
pub struct CompareResult {
    /// Format of the file.
    pub schema: u32,
    /// Condition number of the calibration.
    pub condition_number: f64,
    /// The calibration's improvement ratio.
    pub calibration_improvement_ratio: f64,
    /// One summary a method.
    pub methods: Vec<Summary>,
    /// Rows of the calibration that were no good and were not used; there when there are any.
    #[serde(skip_serializing_if = "BadRows::is_empty")]
    pub calibration_bad_rows: BadRows,
    /// What each method keeps of targets, of the first pair of recordings; none in one too short for any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub targets: Option<Combination>,
    /// What each method does to injected anomalies, one entry for each pair of recordings; empty without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub detection: Vec<Combination>,
}

/// What else is compared.
#[derive(Clone, Debug, Default)]
pub struct CompareOptions {
    /// Further pairs of calibration and recording, for the table of anomalies.
    pub further: Vec<[PathBuf; 2]>,
    /// Whether the first bad row of these ends the work.
    pub is_strict: bool,
    /// The anomalies that are injected, none by default.
    pub injection: InjectionSettings,
}

/// Calibrate on one recording, run every method on the other, write coefficients, summary and report.
pub fn compare(
    calibration: impl Into<Input>,
    recording: impl Into<Input>,
    out: &Path,
    settings: &Settings,
    options: &CompareOptions,
) -> Result<CompareResult, HostError> {
    let [calibration, recording] = [calibration.into(), recording.into()];
    let named: Vec<&Path> = [&calibration, &recording].into_iter().filter_map(|input| input.named()).collect();
    keep_inputs(&named, out, &RESULTS)?;
    let output = OutputDir::create(out)?;
    let [calibration, recording] = [calibration.ready()?, recording.ready()?];
    let fitted = fit(&calibration, settings)?;
    let start = start_at(&fitted.file);
    let passed = pass(&mut *recording.open()?, &METHODS, settings, &start, |_| Ok(()))?;
    let origin = &fitted.file.calibration;
    let detection = detection([&calibration, &recording], settings, options)?;
    let targets = match detection.first() {
        Some(first) => Some(first.clone()),
        None => standard_targets((&calibration, &recording), &METHODS[1..], settings, &start, &passed.counts)?,
    };
    let result = CompareResult {
        schema: 1,
        condition_number: origin.condition_number,
        calibration_improvement_ratio: origin.improvement_ratio,
        methods: passed.methods.iter().map(|method| Summary::new(method, &passed.counts)).collect(),
        calibration_bad_rows: fitted.counts.bad_rows.clone(),
        targets,
        detection,
    };
    let rows = passed.counts.rows;
    let mut report =
        report_data(Kind::Compare, &recording.file_name(), passed, settings, Some(&CalibrationFacts::from(origin)));
    let of_calibration = result.calibration_bad_rows.sentences();
    report.warnings.extend(of_calibration.iter().map(|said| format!("{}: {said}", calibration.file_name())));
    report.detection.clone_from(&result.detection);
    report.targets.clone_from(&result.targets);
    report.headline = headline(&report.methods, report.targets.as_ref());
    mark_hidden(&mut report, recording.path());
    mark_contacts(&mut report, &recording, rows);
    output.write("coefficients.toml", fitted.file.to_toml())?;
    output.write("report.html", render(&report)?)?;
    output.write("summary.json", to_json(&result))?;
    output.commit("summary.json")?;
    Ok(result)
}

/// Anomalies injected into every recording.
fn detection(first: [&Input; 2], settings: &Settings, options: &CompareOptions) -> Result<Vec<Combination>, HostError> {
    if options.injection.anomalies == 0 {
        return Ok(Vec::new());
    }
    let mut further = Vec::new();
    for pair in &options.further {
        let [calibration, recording] = pair.each_ref().map(|path| Input::new(path, options.is_strict).ready());
        further.push([calibration?, recording?]);
    }
    std::iter::once(first)
        .chain(further.iter().map(|[calibration, recording]| [calibration, recording]))
        .map(|[calibration, recording]| {
            let start = start_at(&fit(calibration, settings)?.file);
            combination((calibration.clone(), recording.clone()), &METHODS[1..], settings, &start, &options.injection)
        })
        .collect()
}

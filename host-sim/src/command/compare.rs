//! `host-sim compare`: every method on one recording in one run.

use std::path::{Path, PathBuf};

use serde::Serialize;
use towmag::{Method, Settings};

use super::calibrate::fit;
use super::inputs::keep_inputs;
use super::report_data::{CalibrationFacts, report_data};
use super::start::start_at;
use crate::detection::{Combination, InjectionSettings, combination};
use crate::error::HostError;
use crate::output::OutputDir;
use crate::recording;
use crate::report::{Kind, render};
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
    /// What each method does to injected anomalies, one entry for each pair of recordings; empty without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub detection: Vec<Combination>,
}

/// What else is compared.
#[derive(Clone, Debug, Default)]
pub struct CompareOptions {
    /// Further pairs of calibration and recording, for the table of anomalies.
    pub further: Vec<[PathBuf; 2]>,
    /// The anomalies that are injected, none by default.
    pub injection: InjectionSettings,
}

/// Calibrate on one recording, run every method on the other, write coefficients, summary and report.
pub fn compare(
    calibration: &Path,
    recording: &Path,
    out: &Path,
    settings: &Settings,
    options: &CompareOptions,
) -> Result<CompareResult, HostError> {
    keep_inputs(&[calibration, recording], out, &RESULTS)?;
    let output = OutputDir::create(out)?;
    let fitted = fit(calibration, settings)?;
    let start = start_at(&fitted.file);
    let passed = pass(&mut *recording::open(recording)?, &METHODS, settings, &start, |_| Ok(()))?;
    let origin = &fitted.file.calibration;
    let detection = detection([calibration, recording], settings, options)?;
    let result = CompareResult {
        schema: 1,
        condition_number: origin.condition_number,
        calibration_improvement_ratio: origin.improvement_ratio,
        methods: passed.methods.iter().map(|method| Summary::new(method, &passed.counts)).collect(),
        detection,
    };
    let mut report = report_data(Kind::Compare, recording, passed, settings, Some(&CalibrationFacts::from(origin)));
    report.detection.clone_from(&result.detection);
    output.write("coefficients.toml", fitted.file.to_toml())?;
    output.write("report.html", render(&report)?)?;
    output.write("summary.json", to_json(&result))?;
    output.commit("summary.json")?;
    Ok(result)
}

/// Anomalies injected into every recording.
fn detection(first: [&Path; 2], settings: &Settings, options: &CompareOptions) -> Result<Vec<Combination>, HostError> {
    if options.injection.anomalies == 0 {
        return Ok(Vec::new());
    }
    let further = options.further.iter().map(|[calibration, recording]| [calibration.as_path(), recording.as_path()]);
    std::iter::once(first)
        .chain(further)
        .map(|[calibration, recording]| {
            let start = start_at(&fit(calibration, settings)?.file);
            combination((calibration, recording), &METHODS[1..], settings, &start, &options.injection)
        })
        .collect()
}

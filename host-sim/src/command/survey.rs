//! `host-sim survey`: the field of a tow at its level, the contacts in it, and where they are.

mod base;
mod contacts;
mod diagnosed;
mod digits;
mod effects;
mod geojson;
mod levelled;
mod map;
mod marks;
mod page;
mod place;
mod summary;
mod tows;
mod track;
mod warnings;

use std::path::{Path, PathBuf};

use serde_json::json;
use towmag_survey::navigation::{Layback, PositionOf, navigate};
use towmag_survey::{Calibration, Survey, SurveyOptions};

use super::inputs::keep_inputs;
use crate::coefficients_file::CoefficientsFile;
use crate::error::HostError;
use crate::output::OutputDir;
use crate::progress::Stages;
use crate::provenance::{InputBytes, Provenance};
use crate::recording::{EPOCH_S, Input};
use crate::summary::to_json;
pub(super) use marks::mark_contacts;
pub use summary::{GridSummary, RecordingSummary, SurveySummary};
use tows::{Read, read};
use warnings::warnings;

/// What `host-sim survey` is told.
#[derive(Clone, Debug, Default)]
pub struct SurveyRequest {
    /// Recordings of one body.
    pub recordings: Vec<Input>,
    /// What `calibrate` wrote.
    pub coefficients: Option<PathBuf>,
    /// A base station's file.
    pub base: Option<PathBuf>,
    /// Side of a cell of the map, m; chosen from the distance between lines without.
    pub cell_m: Option<f64>,
    /// Whether what a diagnosis names in a recording is taken off it first.
    pub is_diagnosed: bool,
    /// Navigation and the rate of false alarms. The calibration is read from `coefficients`.
    pub options: SurveyOptions,
}

const RESULTS: [&str; 7] =
    ["contacts.csv", "contacts.geojson", "grid.tif", "levelled.csv", "report.html", "summary.json", "track.geojson"];
/// Valid rows that a survey needs at least, as seconds, in all recordings together.
const LEAST_VALID_S: f64 = 60.0;

/// Survey recordings of one body, and write what came out.
///
/// # Errors
///
/// When a recording cannot be read, lacks what was asked for, or a result cannot be written.
pub fn survey(request: SurveyRequest, out: &Path) -> Result<SurveySummary, HostError> {
    let SurveyRequest { recordings, coefficients, base, cell_m, is_diagnosed, mut options } = request;
    check(&options, cell_m)?;
    let named = recordings.iter().filter_map(Input::named);
    let inputs: Vec<&Path> = named.chain(coefficients.as_deref()).chain(base.as_deref()).collect();
    keep_inputs(&inputs, out, &RESULTS)?;
    if let Some(path) = &coefficients {
        let file = CoefficientsFile::read(path)?;
        options.calibration =
            Some(Calibration { coefficients: file.values(), covariance: Box::new(file.covariance()) });
    }
    let mut output = OutputDir::create(out)?;
    let stages = Stages::new();
    stages.begin("reading");
    let mut read = read(recordings)?;
    enough(&read)?;
    if let Some(path) = &base {
        read.notes.extend(base::join(path, &mut read.tows)?);
    }
    // Before what takes minutes: a column that is missing, cells that are too many.
    let navigation = navigate(&read.tows, &options.navigation)?;
    map::check(&read.tows, &navigation, cell_m)?;
    let files = [("coefficients", coefficients.as_deref()), ("base", base.as_deref())];
    let provenance = provenance(&read, &files, &options, (cell_m, is_diagnosed))?;
    if is_diagnosed {
        stages.begin("diagnosing");
        effects::take_off(&mut read);
    }
    stages.begin("surveying");
    let survey = towmag_survey::survey(&read.tows, &navigation, &options);
    stages.begin("writing the results");
    let summary = write(&output, &read, &survey, cell_m, provenance)?;
    if summary.grid.is_none() {
        output.leave_out("grid.tif");
    }
    output.commit("summary.json")?;
    Ok(summary)
}

fn write(
    output: &OutputDir,
    read: &Read,
    survey: &Survey,
    cell_m: Option<f64>,
    provenance: Provenance,
) -> Result<SurveySummary, HostError> {
    levelled::write(output, &read.inputs, survey)?;
    contacts::write(output, survey)?;
    track::write(output, survey)?;
    let grid = map::write(output, survey, cell_m)?;
    let warnings = warnings(read, survey, grid.as_ref().filter(|_| cell_m.is_none()));
    page::write(output, read, survey, &warnings)?;
    let summary = SurveySummary::new(read, survey, grid, warnings, provenance);
    output.write("summary.json", to_json(&summary))?;
    Ok(summary)
}

fn provenance(
    read: &Read,
    files: &[(&'static str, Option<&Path>)],
    options: &SurveyOptions,
    (cell_m, is_diagnosed): (Option<f64>, bool),
) -> Result<Provenance, HostError> {
    let recordings = read.inputs.iter().map(|input| InputBytes::of_recording("recording", input));
    let mut inputs: Vec<InputBytes> = recordings.collect::<Result<_, _>>()?;
    inputs.extend(InputBytes::of_files(files)?);
    let mut told = json!({
        "strict": read.inputs.iter().any(Input::is_strict),
        "false_alarms_per_hour": options.false_alarms_per_hour,
        "navigation_lag_s": options.navigation.lag_s,
        "grid_m": cell_m,
        "diagnose": is_diagnosed,
        "ship_position": false,
    });
    if let PositionOf::Ship { layback, tow_point_m } = options.navigation.position {
        told["ship_position"] = json!(true);
        told["tow_point_m"] = json!(tow_point_m);
        match layback {
            Layback::Fixed(layback_m) => told["layback_m"] = json!(layback_m),
            Layback::Cable(catenary) => told["catenary"] = json!(catenary),
        }
    }
    Ok(Provenance::new("survey", told, inputs))
}

fn check(options: &SurveyOptions, cell_m: Option<f64>) -> Result<(), HostError> {
    let is_positive = |value: f64| value.is_finite() && value > 0.0;
    let refuse = |text: String| Err(HostError::Usage(text));
    match (options.false_alarms_per_hour, cell_m) {
        (rate, _) if !is_positive(rate) => refuse(format!("--false-alarms-per-hour {rate}: must be above 0")),
        (_, Some(cell_m)) if !is_positive(cell_m) => refuse(format!("--grid-m {cell_m}: must be above 0 m")),
        _ => Ok(()),
    }
}

fn enough(read: &Read) -> Result<(), HostError> {
    let valid = read.tows.iter().flat_map(|tow| &tow.is_usable).filter(|is_usable| **is_usable).count();
    let valid_s = valid as f64 * EPOCH_S;
    if valid_s >= LEAST_VALID_S {
        return Ok(());
    }
    let names: Vec<&str> = read.tows.iter().map(|tow| tow.name.as_str()).collect();
    Err(HostError::NotEnough(format!(
        "{}: {valid_s:.1} s of valid rows, a survey needs at least {LEAST_VALID_S:.0} s",
        names.join(", ")
    )))
}

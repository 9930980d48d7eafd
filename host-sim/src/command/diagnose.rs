//! `host-sim diagnose`: the sim-to-real gap of a recording.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::diagnose_options::DiagnoseOptions;
use super::diagnose_report::diagnosis_report;
use super::effect_files::{library_with, with_regressors};
use super::inputs::keep_inputs;
use crate::coefficients_file::CoefficientsFile;
use crate::diagnosis::{
    DiagnoseSettings, Diagnosis, OwnSimulation, Prepared, SessionReplay, SimulatedTrack, diagnose_telling, is_mismatch,
    mismatch, replay_log,
};
use crate::effects::Library;
use crate::error::HostError;
use crate::output::{OutputDir, OutputError};
use crate::progress::Stages;
use crate::provenance::{InputBytes, Provenance};
use crate::recording::{Input, Table, is_device_log, prior_from_log};
use crate::report::render_diagnosis;
use crate::text::diagnosis_json::PROPOSED_EFFECT;
use crate::text::{diagnosis as words, diagnosis_json};

const RESULTS: [&str; 4] = ["diagnosis.json", "gap.csv", "report.html", PROPOSED_EFFECT];

/// Diagnose a recording and write `diagnosis.json`, `gap.csv` and `report.html`.
pub fn diagnose(
    recording: impl Into<Input>,
    out: &Path,
    options: &DiagnoseOptions<'_>,
) -> Result<Diagnosis, HostError> {
    let recording = recording.into();
    let named = [recording.named(), options.coefficients, options.confirm, options.simulation].into_iter().flatten();
    let inputs: Vec<&Path> = named.chain(options.effect_files.iter().map(PathBuf::as_path)).collect();
    keep_inputs(&inputs, out, &RESULTS)?;
    let library = with_regressors(library_with(&options.effect_files)?, &options.regressors)?;
    check_names(&options.withheld, &library)?;
    let file = options.coefficients.map(CoefficientsFile::read).transpose()?;
    let output = OutputDir::create(out)?;
    let recording = recording.ready()?;
    let provenance = Some(provenance(&recording, options)?);
    let stages = Stages::new();
    let sessions = match is_device_log(recording.path()) {
        true => {
            stages.begin("replaying the log");
            let prior = match file.as_ref().and_then(CoefficientsFile::prior) {
                Some(prior) => Some(prior),
                None => prior_from_log(recording.path())?,
            };
            replay_log(recording.path(), prior.as_ref())?
        }
        false => Vec::new(),
    };
    let (table, diagnosis) = match is_mismatch(&sessions) {
        true => (Prepared::of(&Table::read(&mut *recording.open()?)?), mismatch(sessions).expect("a session differs")),
        false => of_sensors(&recording, file.as_ref(), options, library, sessions, &stages)?,
    };
    let diagnosis = Diagnosis { provenance, ..diagnosis };
    stages.begin("writing the results");
    write_gap(&output, &diagnosis, &table)?;
    if let Some(file) = diagnosis.description.as_ref().and_then(|found| found.effect_file.as_ref()) {
        output.write(PROPOSED_EFFECT, file.clone())?;
    }
    output.write(
        "report.html",
        render_diagnosis(&diagnosis_report(&recording.file_name(), &table, options, &diagnosis))?,
    )?;
    output.write("diagnosis.json", diagnosis_json::json(&diagnosis))?;
    output.commit("diagnosis.json")?;
    if diagnosis.description.as_ref().is_none_or(|found| found.effect_file.is_none()) {
        remove_stale(&out.join(PROPOSED_EFFECT))?;
    }
    Ok(diagnosis)
}

fn provenance(recording: &Input, options: &DiagnoseOptions<'_>) -> Result<Provenance, HostError> {
    let mut inputs = vec![InputBytes::of_recording("recording", recording)?];
    inputs.extend(InputBytes::of_files(&[
        ("coefficients", options.coefficients),
        ("confirm", options.confirm),
        ("simulation", options.simulation),
    ])?);
    for file in &options.effect_files {
        inputs.extend(InputBytes::of_files(&[("effect_file", Some(file))])?);
    }
    let told = json!({
        "strict": recording.is_strict(),
        "withhold": options.withheld.join(", "),
        "regressor": options.regressors.join(", "),
        "hold_terms": options.holds_terms,
        "seed": options.seed,
    });
    Ok(Provenance::new("diagnose", told, inputs))
}

/// What an earlier diagnosis proposed is not what this one does.
fn remove_stale(path: &Path) -> Result<(), HostError> {
    match std::fs::remove_file(path) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(OutputError::Io { path: path.into(), source }.into())
        }
        _ => Ok(()),
    }
}

/// The diagnosis of what the sensors say.
fn of_sensors(
    recording: &Input,
    file: Option<&CoefficientsFile>,
    options: &DiagnoseOptions<'_>,
    library: Library,
    exact_replay: Vec<SessionReplay>,
    stages: &Stages,
) -> Result<(Prepared, Diagnosis), HostError> {
    stages.begin("reading");
    let columns = library.columns();
    let table = Prepared::read_with(recording, &columns)?;
    let coefficients = file.map(coefficients_of);
    let settings = DiagnoseSettings {
        withheld: options.withheld.clone(),
        seed: options.seed,
        coefficients,
        library,
        is_lenient: false,
        simulation: own_simulation(options)?,
    };
    let second = options.confirm.map(|path| Input::new(path, recording.is_strict()).ready()).transpose()?;
    let second = second.as_ref().map(|input| Prepared::read_with(input, &columns)).transpose()?;
    let diagnosis = diagnose_telling(&table, second.as_ref(), &settings, &|stage| stages.begin(words::stage(stage)))?;
    let bad_rows = table.bad_rows.clone();
    Ok((table, Diagnosis { exact_replay, bad_rows, ..diagnosis }))
}

fn own_simulation(options: &DiagnoseOptions<'_>) -> Result<Option<OwnSimulation>, HostError> {
    let track = options.simulation.map(SimulatedTrack::read).transpose()?;
    Ok(track.map(|track| OwnSimulation { track, holds_terms: options.holds_terms }))
}

fn coefficients_of(file: &CoefficientsFile) -> [f64; towmag::model::TERMS] {
    std::array::from_fn(|k| file.terms.get(k).map_or(0.0, |term| term.value))
}

fn check_names(withheld: &[String], library: &Library) -> Result<(), HostError> {
    let known: Vec<&str> = library.specs().map(|spec| spec.name).collect();
    match withheld.iter().find(|name| !known.contains(&name.as_str())) {
        Some(name) => {
            Err(HostError::Usage(format!("--withhold {name}: no such effect; there are {}", known.join(", "))))
        }
        None => Ok(()),
    }
}

/// One row per row of the recording: residuals before and after, empty where the row was not used.
fn write_gap(output: &OutputDir, diagnosis: &Diagnosis, table: &Prepared) -> Result<(), HostError> {
    let mut file = output.create_file("gap.csv")?;
    let mut columns: Vec<Vec<Option<f64>>> = Vec::new();
    let mut header = "time_s".to_string();
    for channel in &diagnosis.residuals {
        for (when, values) in [("before", &channel.before_nt), ("after", &channel.after_nt)] {
            let mut column = vec![None; table.len()];
            channel.rows.iter().zip(values).for_each(|(row, value)| column[*row] = Some(*value));
            columns.push(column);
            header.push_str(&format!(",{}_{when}_nT", channel.channel));
        }
    }
    let course = diagnosis.description.as_ref().map(|found| found.course.clone()).unwrap_or_default();
    columns.push(if course.is_empty() { vec![None; table.len()] } else { course });
    writeln!(file, "{header},driver")?;
    for (row, time_s) in table.time_s.iter().enumerate() {
        write!(file, "{time_s}")?;
        for column in &columns {
            match column[row] {
                Some(value) => write!(file, ",{value:.4}")?,
                None => write!(file, ",")?,
            }
        }
        writeln!(file)?;
    }
    Ok(file.finish()?)
}

//! `host-sim trial`: a blind trial of the diagnosis. The trial is a crate of its own; here it is given what it may not
//! know: how a recording is diagnosed, and which effects can be put into one.

use std::io::Write;
use std::path::{Path, PathBuf};

use towmag_effect_file::EffectFile;
use towmag_trial::{BlindTrial, RealRecording, Request, Trial, TrialOptions};

use super::recover;
use crate::diagnosis::{DiagnoseSettings, OwnSimulation, Prepared, SimulatedTrack, diagnose};
use crate::effects::Library;
use crate::error::HostError;
use crate::output::{AsideFolder, OutputDir, OutputError, OutputFile, claim};
use crate::progress::Counter;
use crate::recording::{Column, Input, RecordingError, RecordingRow, is_device_log};
use crate::report::render_trial;
use crate::summary::to_json;
use crate::text::diagnosis_json;

pub(super) const RESULTS: [&str; 3] = ["answers.json", "report.html", "trial.json"];

/// Draw and seal, diagnose, open and score. `sealed` is told the hash before the first diagnosis begins.
pub fn trial(out: &Path, options: &TrialOptions, sealed: impl FnOnce(&str)) -> Result<Trial, HostError> {
    let library = library(options)?;
    check(options, &library)?;
    OutputDir::check(out, &RESULTS)?;
    let real = options.on.as_deref().map(|on| real_recording(on, options.strict)).transpose()?;
    let drawing = Counter::new(options.recordings_tried(), "drawing");
    let blind = BlindTrial::draw(options.clone(), real, || drawing.add_one())?;
    drop(drawing);
    make_folder(out)?;
    claim(out, &RESULTS)?;
    write(&out.join("answers.json"), blind.answers())?;
    write(&out.join("trial.json"), &to_json(&blind.unopened()))?;
    sealed(blind.sha256());
    if options.keep {
        let folder = kept(out)?;
        blind.recordings(|index, csv| write(&folder.join(format!("{index:03}.csv")), csv))?;
        // What is proposed for an effect without a name is tried on the body's next tow.
        if options.withhold.is_some() {
            blind.next_recordings(|index, csv| write(&folder.join(format!("{index:03}_next.csv")), csv))?;
        }
    }
    let diagnosing = Counter::new(blind.recording_count(), "diagnosing");
    let trial = blind.run(|request| diagnosis_json(request, &library), || diagnosing.add_one())?;
    drop(diagnosing);
    finish(out, &trial)?;
    Ok(trial)
}

/// Write what is known at the end. `trial.json` comes last: it says that all is there.
pub(super) fn finish(out: &Path, trial: &Trial) -> Result<(), HostError> {
    write(&out.join("report.html"), &render_trial(trial)?)?;
    write(&out.join("trial.json"), &to_json(trial))
}

/// The folder of the recordings that are kept.
pub(super) fn kept(out: &Path) -> Result<PathBuf, HostError> {
    let folder = out.join("recordings");
    make_folder(&folder).map(|()| folder)
}

/// What is looked for: the library, and what a user wrote.
fn library(options: &TrialOptions) -> Result<Library, HostError> {
    let usage = |error: String| HostError::Usage(error);
    options.own.iter().try_fold(Library::default(), |library, own| {
        let file = EffectFile::parse(&own.text, &own.file).map_err(|error| usage(error.to_string()))?;
        library.with_file(file).map_err(|error| usage(error.to_string()))
    })
}

fn check(options: &TrialOptions, library: &Library) -> Result<(), HostError> {
    options.check().map_err(|error| HostError::Usage(format!("--{error}")))?;
    match &options.withhold {
        Some(name) if library.spec(name).is_none() => {
            Err(HostError::Usage(format!("--withhold {name}: no such effect; docs/scenarios.md lists them")))
        }
        _ => Ok(()),
    }
}

/// The text of `diagnosis.json`, as `diagnose` would write it.
fn diagnosis_json(request: &Request<'_>, library: &Library) -> Result<String, HostError> {
    let columns = library.columns();
    let first = Prepared::of_csv(request.name, request.recording.as_bytes(), &columns)?;
    let second = request.confirm.map(|csv| Prepared::of_csv(request.name, csv.as_bytes(), &columns)).transpose()?;
    // Not every recording of a trial has every column.
    let settings = DiagnoseSettings {
        withheld: request.withheld.to_vec(),
        seed: request.seed,
        library: library.clone(),
        simulation: request.simulation.map(|csv| own_simulation(request.name, csv)).transpose()?,
        is_lenient: true,
        ..DiagnoseSettings::default()
    };
    Ok(diagnosis_json::json(&diagnose(&first, second.as_ref(), &settings)?))
}

fn own_simulation(name: &str, csv: &str) -> Result<OwnSimulation, HostError> {
    let track = SimulatedTrack::from_reader(&format!("simulation of {name}"), csv.as_bytes())?;
    Ok(OwnSimulation { track, holds_terms: false })
}

/// The recording that effects are put into; of a device log, what `recover` makes of it.
fn real_recording(path: &Path, is_strict: bool) -> Result<RealRecording, HostError> {
    let input = Input::new(path, is_strict).ready()?;
    let name = input.shown();
    let csv = match is_device_log(input.path()) {
        true => recovered(input.path())?,
        false => mended(&input)?.map_or_else(|| read(input.path()), Ok)?,
    };
    // What is wrong with a recording is said as by every other command.
    Prepared::of_csv(&name, csv.as_bytes(), &[])?;
    let library = Library::default();
    let injectable: Vec<String> = library.specs().filter(|spec| spec.injectable).map(|spec| spec.name.into()).collect();
    Ok(RealRecording::read(&name, csv, &injectable)?)
}

/// What is left of a recording with bad rows when they are not used: no readings in them, no row whose time is wrong, and
/// days counted on. `None` of one without.
fn mended(input: &Input) -> Result<Option<String>, HostError> {
    let mut reader = input.open()?;
    let columns: Vec<usize> = (0..reader.schema().len()).collect();
    let [time, sensors @ ..] = reader.schema().required();
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(reader.schema().names())?;
    let mut row = RecordingRow::default();
    while reader.read_row(&mut row)? {
        if !row.is_on_grid {
            continue;
        }
        let mut position = 0..;
        let time_s = row.number(Column::Time).map(|time_s| time_s.to_string()).unwrap_or_default();
        let is_usable = row.is_usable();
        reader.write_fields(&row, &columns, &mut |field| match position.next() {
            Some(at) if at == time => csv.write_field(&time_s),
            Some(at) if !is_usable && sensors.contains(&at) => csv.write_field(""),
            _ => csv.write_field(field),
        })?;
        csv.write_record(None::<&[u8]>)?;
    }
    if reader.bad_rows().is_none_or(|bad_rows| bad_rows.is_empty()) {
        return Ok(None);
    }
    let bytes = csv.into_inner().map_err(|error| csv::Error::from(std::io::Error::other(error.to_string())))?;
    Ok(Some(String::from_utf8_lossy(&bytes).into_owned()))
}

fn recovered(log: &Path) -> Result<String, HostError> {
    let folder = AsideFolder::new().map_err(|source| OutputError::Io { path: std::env::temp_dir(), source })?;
    recover(log, folder.path())?;
    read(&folder.path().join("recording.csv"))
}

fn read(path: &Path) -> Result<String, HostError> {
    let read = std::fs::read(path).map_err(|source| RecordingError::Io { path: path.display().to_string(), source });
    // Required columns and values are ASCII: what else is in a file need not be text.
    Ok(String::from_utf8_lossy(&read?).into_owned())
}

pub(super) fn make_folder(path: &Path) -> Result<(), HostError> {
    std::fs::create_dir_all(path).map_err(|source| OutputError::Io { path: path.into(), source }.into())
}

pub(super) fn write(path: &Path, text: &str) -> Result<(), HostError> {
    let mut file = OutputFile::create(path)?;
    file.write_all(text.as_bytes()).map_err(|source| OutputError::Io { path: path.into(), source })?;
    Ok(file.commit()?)
}

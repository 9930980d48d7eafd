//! `host-sim import`: any recording into this project's format.

use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::json;
use towmag_import::profile::Profile;
use towmag_import::source::{Source, SourceColumn, SourceTable, Values};
use towmag_import::{File, Input, Options, Recording, Report, import as import_files};

use crate::error::HostError;
use crate::message::file_name;
use crate::output::OutputFile;
use crate::provenance::{InputBytes, Provenance};
use crate::recording::{ColumnValues, RecordingError, Table, TableColumn, is_device_log, open};
use crate::summary::to_json;

/// A file of this name is standard input, or output.
const STREAM: &str = "-";

/// What is told of an import.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImportResult {
    /// What was found.
    #[serde(flatten)]
    pub report: Report,
    /// What it was made by, and of.
    pub provenance: Provenance,
}

impl ImportResult {
    /// As it is written beside the recording.
    pub fn to_json(&self) -> String {
        to_json(self)
    }
}

/// Import files into one recording. Beside it go its profile and what was found, unless it goes to a stream.
///
/// # Errors
///
/// When a file is none that is known, or cannot be read, or the result would replace one of them.
pub fn import(files: &[PathBuf], out: &Path, options: &Options) -> Result<ImportResult, HostError> {
    let beside = Beside::of(out);
    for file in files {
        keep(file, &beside)?;
    }
    let read = files.iter().map(|file| input(file)).collect::<Result<Vec<_>, _>>()?;
    let (inputs, hashed) = read.into_iter().unzip();
    let mut recording = import_files(inputs, options)?;
    let report = std::mem::take(&mut recording.report);
    let result = ImportResult { report, provenance: Provenance::new("import", told(options), hashed) };
    match beside {
        None => recording.write_csv(&mut io::stdout().lock()).or_else(whoever_reads_may_go)?,
        Some(beside) => beside.write(&recording, &result)?,
    }
    Ok(result)
}

/// The files of a result.
struct Beside {
    recording: PathBuf,
    profile: PathBuf,
    report: PathBuf,
}

impl Beside {
    fn of(out: &Path) -> Option<Self> {
        let with = |ending: &str| out.with_extension(ending);
        (out != Path::new(STREAM)).then(|| Self {
            recording: out.into(),
            profile: with("profile.toml"),
            report: with("import.json"),
        })
    }

    /// The recording last: where it is, the others are.
    fn write(&self, recording: &Recording, result: &ImportResult) -> Result<(), HostError> {
        let mut out = OutputFile::create(&self.recording)?;
        recording.write_csv(&mut out)?;
        for (path, text) in [(&self.profile, recording.profile.to_toml()), (&self.report, result.to_json())] {
            let mut file = OutputFile::create(path)?;
            file.write_all(text.as_bytes())?;
            file.commit()?;
        }
        Ok(out.commit()?)
    }
}

/// What a person has asked for; a profile as it was given.
fn told(options: &Options) -> serde_json::Value {
    let profile = (options.profile != Profile::default()).then(|| options.profile.to_toml());
    let map: Vec<String> = options.map.iter().map(|(column, name)| format!("{column}={name}")).collect();
    json!({
        "profile": profile,
        "scalar": options.scalar,
        "flux": options.flux,
        "units": options.units,
        "flux_factor": options.flux_factor,
        "map": map.join(", "),
    })
}

/// What is read is never what is written.
fn keep(file: &Path, beside: &Option<Beside>) -> Result<(), HostError> {
    let (Some(beside), Ok(found)) = (beside, file.canonicalize()) else { return Ok(()) };
    let replaced = [&beside.recording, &beside.profile, &beside.report];
    if replaced.into_iter().any(|result| result.canonicalize().is_ok_and(|result| result == found)) {
        let file = file.display();
        return Err(HostError::Usage(format!("{file} would be replaced by the recording: choose another --out")));
    }
    Ok(())
}

/// A file, and what it is known by.
fn input(file: &Path) -> Result<(Input, InputBytes), HostError> {
    let name = file.display().to_string();
    let io_error = |source| RecordingError::Io { path: name.clone(), source };
    if file == Path::new(STREAM) {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map_err(io_error)?;
        let hashed = InputBytes::of_bytes("file", "standard input".into(), &bytes);
        return Ok((Input::File(File { name: "standard input".into(), bytes }), hashed));
    }
    if is_device_log(file) {
        return Ok((Input::Source(device_log(file, name)?), InputBytes::of_file("file", file)?));
    }
    let bytes = std::fs::read(file).map_err(io_error)?;
    let hashed = InputBytes::of_bytes("file", file_name(file), &bytes);
    Ok((Input::File(File { name, bytes }), hashed))
}

/// The body's own log has a reader already.
fn device_log(file: &Path, name: String) -> Result<Source, HostError> {
    let table = Table::read(&mut *open(file)?)?;
    let columns = table.columns().iter().map(column).collect();
    let table = SourceTable { rows: table.len(), columns, ..SourceTable::default() };
    Ok(Source { file: name, format: "device log", tables: vec![table] })
}

fn column(column: &TableColumn) -> SourceColumn {
    let values = match &column.values {
        ColumnValues::Numbers(numbers) => Values::Numbers(numbers.clone()),
        ColumnValues::Flags(flags) => {
            let number = |flag: &Option<bool>| flag.map_or(f64::NAN, |flag| f64::from(u8::from(flag)));
            Values::Numbers(flags.iter().map(number).collect())
        }
        ColumnValues::Labels(labels) => Values::Text(labels.clone()),
    };
    SourceColumn { name: column.name.clone(), unit: None, values, dummy: None }
}

/// `| head` is no failure.
fn whoever_reads_may_go(error: io::Error) -> Result<(), HostError> {
    if error.kind() == io::ErrorKind::BrokenPipe { Ok(()) } else { Err(error.into()) }
}

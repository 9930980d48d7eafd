//! `host-sim import`: any recording into this project's format.

use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use towmag_import::source::{Source, SourceColumn, SourceTable, Values};
use towmag_import::{File, Input, Options, Recording, Report, import as import_files};

use crate::error::HostError;
use crate::output::OutputFile;
use crate::recording::{ColumnValues, RecordingError, Table, TableColumn, is_device_log, open};

/// A file of this name is standard input, or output.
const STREAM: &str = "-";

/// Import files into one recording. Beside it go its profile and what was found, unless it goes to a stream.
///
/// # Errors
///
/// When a file is none that is known, or cannot be read, or the result would replace one of them.
pub fn import(files: &[PathBuf], out: &Path, options: &Options) -> Result<Report, HostError> {
    let beside = Beside::of(out);
    for file in files {
        keep(file, &beside)?;
    }
    let inputs = files.iter().map(|file| input(file)).collect::<Result<Vec<_>, _>>()?;
    let recording = import_files(inputs, options)?;
    match beside {
        None => recording.write_csv(&mut io::stdout().lock()).or_else(whoever_reads_may_go)?,
        Some(beside) => beside.write(&recording)?,
    }
    Ok(recording.report)
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
    fn write(&self, recording: &Recording) -> Result<(), HostError> {
        let mut out = OutputFile::create(&self.recording)?;
        recording.write_csv(&mut out)?;
        for (path, text) in [(&self.profile, recording.profile.to_toml()), (&self.report, recording.report.to_json())] {
            let mut file = OutputFile::create(path)?;
            file.write_all(text.as_bytes())?;
            file.commit()?;
        }
        Ok(out.commit()?)
    }
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

fn input(file: &Path) -> Result<Input, HostError> {
    let name = file.display().to_string();
    let io_error = |source| RecordingError::Io { path: name.clone(), source };
    if file == Path::new(STREAM) {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map_err(io_error)?;
        return Ok(Input::File(File { name: "standard input".into(), bytes }));
    }
    if is_device_log(file) {
        return Ok(Input::Source(device_log(file, name)?));
    }
    let bytes = std::fs::read(file).map_err(io_error)?;
    Ok(Input::File(File { name, bytes }))
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

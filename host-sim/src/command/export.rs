//! `host-sim export`: a recording or a result as a file for other tools.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use towmag_export::{Format, Options, encode, find, read};

use crate::error::HostError;
use crate::output::{OutputError, OutputFile};

/// What is written to the terminal or to a pipe.
const STDOUT: &str = "-";

/// What `export` wrote.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportResult {
    /// The table that was exported: of a result folder, the one of it.
    pub source: PathBuf,
    /// Its rows.
    pub rows: usize,
    /// Its columns.
    pub columns: usize,
    /// Whether the file went to stdout, where nothing else may go then.
    pub is_on_stdout: bool,
}

/// Write the table, or that of the result folder, in this format.
pub fn export(input: &Path, format: Format, out: &Path, options: &Options) -> Result<ExportResult, HostError> {
    check(format, out, options)?;
    let source = find(input)?;
    if let (Ok(read), Ok(written)) = (source.canonicalize(), out.canonicalize())
        && read == written
    {
        return Err(HostError::Usage(format!("{}: would be replaced by its export", out.display())));
    }
    let table = read(&source)?;
    let bytes = encode(&table, format, options)?;
    let is_on_stdout = is_stdout(out);
    let written = if is_on_stdout { io::stdout().write_all(&bytes).map_err(on(out)) } else { write(out, &bytes) };
    written?;
    Ok(ExportResult { source, rows: table.len(), columns: table.columns.len(), is_on_stdout })
}

fn check(format: Format, out: &Path, options: &Options) -> Result<(), HostError> {
    if is_stdout(out) && !format.is_text() {
        return Err(HostError::Usage(format!("--out {STDOUT}: {format} is no text: name a file")));
    }
    if *options != Options::default() && format != Format::Geojson {
        return Err(HostError::Usage(format!("--every and --points are for --format {}", Format::Geojson)));
    }
    match options.every_s {
        Some(every_s) if !(every_s.is_finite() && every_s > 0.0) => {
            Err(HostError::Usage(format!("--every {every_s}: must be above 0 s")))
        }
        _ => Ok(()),
    }
}

fn write(out: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let mut file = OutputFile::create(out)?;
    file.write_all(bytes).map_err(on(out))?;
    file.commit()
}

fn is_stdout(out: &Path) -> bool {
    out == Path::new(STDOUT)
}

/// What already says which file is as it is.
fn on(out: &Path) -> impl Fn(io::Error) -> OutputError {
    |source| source.downcast().unwrap_or_else(|source| OutputError::Io { path: out.into(), source })
}

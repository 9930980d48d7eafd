//! The formats of recordings. A new one is a file beside this one, and its two lines here.

pub(super) mod csv;
pub(super) mod device_log;
mod foreign;

use std::path::Path;

use super::error::RecordingError;
use super::reader::{Format, RecordingReader, start_of};

/// Every format. The first that recognises a file reads it; CSV takes whatever is left.
pub const FORMATS: [Format; 3] = [device_log::FORMAT, foreign::FORMAT, csv::FORMAT];

/// Open a recording of any format.
///
/// # Errors
///
/// When the file cannot be read, or is no recording.
pub fn open(path: &Path) -> Result<Box<dyn RecordingReader>, RecordingError> {
    open_as_one_of(&FORMATS, path)
}

/// The same of a file that messages call `name`.
pub(super) fn open_named(path: &Path, name: &str) -> Result<Box<dyn RecordingReader>, RecordingError> {
    open_named_as_one_of(&FORMATS, path, name)
}

/// Open a recording of one of these formats.
///
/// # Errors
///
/// When none of them recognises the file, or the one that does cannot read it.
pub fn open_as_one_of(formats: &[Format], path: &Path) -> Result<Box<dyn RecordingReader>, RecordingError> {
    open_named_as_one_of(formats, path, &path.display().to_string())
}

fn open_named_as_one_of(
    formats: &[Format],
    path: &Path,
    name: &str,
) -> Result<Box<dyn RecordingReader>, RecordingError> {
    let start = start_of(path);
    let Some(format) = formats.iter().find(|format| (format.is_start)(&start)) else {
        let what = "is in no known format of recordings".to_string();
        return Err(RecordingError::Bad { file: name.into(), line: 1, column: None, what });
    };
    (format.open)(path, name)
}

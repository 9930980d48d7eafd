//! What can be wrong with a recording, told in one line that names file, line and column.

use super::bad_rows::RowFault;
use crate::message::{LONGEST_VALUE, on_one_line, shortened};
use std::io;

/// Why a recording cannot be read on.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The operating system does not give the file's bytes.
    #[error("{}: cannot be read: {source}", on_one_line(path))]
    Io {
        /// The file as the user named it.
        path: String,
        /// The system's own words.
        source: io::Error,
    },
    /// The bytes are there, but are no recording.
    #[error("{}:{line}: {}{what}", on_one_line(file), in_front(column))]
    Bad {
        /// The file as the user named it.
        file: String,
        /// Physical line in the file, from 1.
        line: u64,
        /// Column, or columns, at fault; `None` when the line as a whole is.
        column: Option<String>,
        /// What is wrong and what is expected.
        what: String,
    },
}

impl RecordingError {
    /// Whether what the user gave is at fault (exit code 2) and not the machine (exit code 1).
    /// A file that is not there, is a directory, may not be read or is damaged is the user's too.
    pub fn is_bad_input(&self) -> bool {
        use io::ErrorKind::{InvalidData, IsADirectory, NotADirectory, NotFound, PermissionDenied};
        match self {
            Self::Io { source, .. } => {
                matches!(source.kind(), InvalidData | NotFound | IsADirectory | NotADirectory | PermissionDenied)
            }
            Self::Bad { .. } => true,
        }
    }
}

/// What is wrong with a header or a row, before it is said in which file and line.
#[derive(Debug)]
pub struct BadInput {
    /// What is wrong with this row alone; `None` where nothing that follows could be trusted.
    pub fault: Option<RowFault>,
    /// Column, or columns, at fault; `None` when the line as a whole is.
    pub column: Option<String>,
    /// What is wrong and what is expected.
    pub what: String,
}

impl BadInput {
    /// Something is wrong with a column.
    pub fn of(column: &[u8], what: String) -> Self {
        Self { column: Some(shortened(column, LONGEST_VALUE)), ..Self::of_line(what) }
    }

    /// Something is wrong with a line as a whole.
    pub fn of_line(what: impl Into<String>) -> Self {
        Self { fault: None, column: None, what: what.into() }
    }

    /// Only this row is at fault: what follows can be trusted.
    pub fn in_row(self, fault: RowFault) -> Self {
        Self { fault: Some(fault), ..self }
    }

    /// The same, with the place.
    pub fn at(self, file: &str, line: u64) -> RecordingError {
        let Self { column, what, .. } = self;
        RecordingError::Bad { file: file.into(), line, column, what }
    }
}

fn in_front(column: &Option<String>) -> String {
    column.as_ref().map(|column| format!("{column}: ")).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_name_with_a_line_break_stays_on_one_line() {
        let what = "has no rows".to_string();
        let error = RecordingError::Bad { file: "a\nb.csv".into(), line: 1, column: None, what };
        assert_eq!(error.to_string(), "a\\nb.csv:1: has no rows");
    }
}

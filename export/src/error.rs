//! Why a file could not be exported.

use std::io;

/// Why a file could not be exported. Its display is one line: where, what, what to do.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// A place in the file is at fault.
    #[error("{}:{line}: {}{what}", on_one_line(file), in_front(column))]
    At {
        /// As the user named it.
        file: String,
        /// From 1.
        line: u64,
        /// `None` where the line as a whole is at fault.
        column: Option<String>,
        /// What is wrong, and what is expected.
        what: String,
    },
    /// The file as a whole is at fault, or lacks what the format needs.
    #[error("{}: {what}", on_one_line(file))]
    File {
        /// As the user named it.
        file: String,
        /// What is wrong, and what would do.
        what: String,
    },
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", on_one_line(file))]
    Io {
        /// As the user named it.
        file: String,
        /// The system's own words.
        source: io::Error,
    },
    /// The library that encodes a format refuses.
    #[error("cannot be written as {format}: {what}")]
    Encoding {
        /// Name of the format.
        format: &'static str,
        /// The library's own words.
        what: String,
    },
}

impl ExportError {
    /// Whether what the user gave is at fault and not the machine or this program.
    pub fn is_bad_input(&self) -> bool {
        use io::ErrorKind::{IsADirectory, NotADirectory, NotFound, PermissionDenied};
        match self {
            Self::At { .. } | Self::File { .. } => true,
            Self::Io { source, .. } => {
                matches!(source.kind(), NotFound | IsADirectory | NotADirectory | PermissionDenied)
            }
            Self::Encoding { .. } => false,
        }
    }

    /// For `map_err` on what a library says.
    pub(crate) fn encoding<E: std::fmt::Display>(format: &'static str) -> impl Fn(E) -> Self {
        move |error| Self::Encoding { format, what: on_one_line(&error.to_string()) }
    }
}

/// A field for a message: in quotation marks, and never longer than a reader wants to read.
pub(crate) fn quoted(field: &str) -> String {
    const LONGEST: usize = 32;
    match field.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{:?}...", &field[..end]),
        None => format!("{field:?}"),
    }
}

/// File names may hold line breaks; the message may not.
fn on_one_line(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { c.escape_default().to_string() } else { c.to_string() }).collect()
}

fn in_front(column: &Option<String>) -> String {
    column.as_ref().map(|column| format!("{}: ", on_one_line(column))).unwrap_or_default()
}

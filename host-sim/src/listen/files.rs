//! The files that are written while listening.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::Path;

use crate::error::HostError;

/// An error of writing, with the file's name.
pub(super) fn at(path: Option<&Path>, source: io::Error) -> HostError {
    HostError::Port { port: path.unwrap_or(Path::new("output")).display().to_string(), source }
}

/// A new file, written through as the bytes come: what was heard cannot be heard again, and Ctrl-C is how this ends.
pub(super) fn create(path: &Path) -> Result<File, HostError> {
    OpenOptions::new().write(true).create_new(true).open(path).map_err(|source| match source.kind() {
        ErrorKind::AlreadyExists => HostError::Usage(format!(
            "{}: exists: a recording is never written over, name another file",
            path.display()
        )),
        ErrorKind::NotFound => HostError::Usage(format!("{}: its folder does not exist", path.display())),
        _ => HostError::Port { port: path.display().to_string(), source },
    })
}

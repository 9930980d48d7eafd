//! Why a result could not be written.

use crate::message::on_one_line;
use std::io;
use std::path::{Path, PathBuf};

/// Why a result could not be written. Nothing of it is left behind.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The operating system refuses.
    #[error("{}: cannot be written: {source}", shown(path))]
    Io {
        /// What should have been written.
        path: PathBuf,
        /// The system's own words.
        source: io::Error,
    },
    /// The output directory is something else already.
    #[error("{}: exists and is not a directory: name another output directory", shown(path))]
    NotADirectory {
        /// The path as the user gave it.
        path: PathBuf,
    },
    /// The output file is something else already: a directory or a device, which a rename would do away with.
    #[error("{}: exists and is not a regular file: name another output file", shown(path))]
    NotAFile {
        /// The path as the user gave it.
        path: PathBuf,
    },
    /// The path ends in nothing that could be made, as `..` and the empty path do.
    #[error("\"{}\": is no name for an output: name a file or directory to be made", shown(path))]
    NoName {
        /// The path as the user gave it.
        path: PathBuf,
    },
    /// A file of that name is there, and this program has not written it.
    #[error(
        "{}: is there already and is no result of host-sim: name another folder than {}, or move the file away",
        shown(path),
        shown(folder)
    )]
    Foreign {
        /// The file.
        path: PathBuf,
        /// The folder as the user gave it.
        folder: PathBuf,
    },
    /// A mistake in this program: a file of the result was begun and not finished, or never written at all.
    #[error("{}: was never finished: this is a fault of the program, please report it", shown(path))]
    Unfinished {
        /// The file in the output directory.
        path: PathBuf,
    },
}

impl OutputError {
    /// Whether the user should have named another output (exit code 2); else the work failed (exit code 1).
    pub fn is_bad_usage(&self) -> bool {
        match self {
            Self::NotADirectory { .. } | Self::NotAFile { .. } | Self::Foreign { .. } | Self::NoName { .. } => true,
            Self::Io { source, .. } => source.kind() == io::ErrorKind::NotADirectory,
            Self::Unfinished { .. } => false,
        }
    }

    /// For `map_err`: the same, with the path that the system leaves out. What has one already keeps it.
    pub(super) fn io(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        |source| source.downcast().unwrap_or_else(|source| Self::Io { path, source })
    }
}

fn shown(path: &Path) -> String {
    on_one_line(&path.display().to_string())
}

//! Temporary files and folders of this program, gone when nobody needs them.

use std::fs::File;
use std::io;
use std::path::Path;

use tempfile::{TempDir, TempPath};

use super::cleanup::{PREFIX, Unfinished};

/// A file in the system's folder for temporary ones, removed with this.
#[derive(Debug)]
pub struct Aside {
    // In this order: what is off the list must be gone.
    path: TempPath,
    _unfinished: Unfinished,
}

impl Aside {
    /// A new one, open for writing.
    ///
    /// # Errors
    ///
    /// When the system has no room for it.
    pub fn file() -> io::Result<(Self, File)> {
        let make = || tempfile::Builder::new().prefix(PREFIX).tempfile();
        let (made, unfinished) = Unfinished::make(make, |made| made.path().into())?;
        let (file, path) = made.into_parts();
        Ok((Self { path, _unfinished: unfinished }, file))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// A folder among the system's temporary ones, removed with this.
#[derive(Debug)]
pub struct AsideFolder {
    // In this order, as above.
    folder: TempDir,
    _unfinished: Unfinished,
}

impl AsideFolder {
    /// A new one, empty.
    ///
    /// # Errors
    ///
    /// When the system has no room for it.
    pub fn new() -> io::Result<Self> {
        let make = || tempfile::Builder::new().prefix(PREFIX).tempdir();
        let (folder, unfinished) = Unfinished::make(make, |made| made.path().into())?;
        Ok(Self { folder, _unfinished: unfinished })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }
}

//! A result that is one file.

use super::cleanup::{PREFIX, Unfinished, unfinished};
use super::error::OutputError;
use super::parents::{Existing, MadeParents, look_at, sync_parent};
use super::stream::Stream;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// A single output file. It is in its place after [`commit`](Self::commit); dropped before, it never was.
#[derive(Debug)]
pub struct OutputFile {
    // In this order: the file must be gone before the directories made for it can go.
    stream: Stream,
    aside: TempPath,
    unfinished: Unfinished,
    parents: MadeParents,
    target: PathBuf,
}

impl OutputFile {
    /// Begin the file that will be at `path`, beside it; missing directories are made.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let path = path.as_ref();
        let (parents, target) = match look_at(path)? {
            Existing::Something { target, metadata } if metadata.is_file() => (MadeParents::default(), target),
            Existing::Something { .. } => return Err(OutputError::NotAFile { path: path.into() }),
            Existing::Nothing { parent, target } => (MadeParents::make(&parent)?, target),
        };
        let (made, unfinished) = begin(&target).map_err(OutputError::io(path))?;
        let (file, aside) = made.into_parts();
        Ok(Self { stream: Stream::new(file, path.into()), aside, unfinished, parents, target })
    }

    /// Put the file into its place, over one that may be there, in one step.
    pub fn commit(self) -> Result<(), OutputError> {
        let Self { stream, aside, unfinished: listed, parents, target } = self;
        stream.finish()?;
        let held = unfinished();
        aside.persist(&target).map_err(|error| OutputError::io(&target)(error.error))?;
        drop(held);
        drop(listed);
        parents.keep();
        sync_parent(&target);
        Ok(())
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.write(bytes)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.stream.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

fn begin(target: &Path) -> io::Result<(tempfile::NamedTempFile, Unfinished)> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(".partial");
    // Temporary files are for their owner alone; a result is as readable as any other file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let folder = target.parent().unwrap_or(Path::new("."));
    Unfinished::make(|| builder.tempfile_in(folder), |made| made.path().into())
}

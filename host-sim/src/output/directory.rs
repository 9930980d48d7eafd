//! A result that is several files in one directory.

use super::cleanup::{PREFIX, Unfinished, unfinished};
use super::error::OutputError;
use super::marker;
use super::parents::{Existing, MadeParents, look_at, sync_directory, sync_parent};
use super::stream::Stream;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What the name of a file ends in until it is finished.
const UNFINISHED: &str = ".unfinished";

/// An output directory. Its files are in place after [`commit`](Self::commit); dropped before, they never were.
#[derive(Debug)]
pub struct OutputDir {
    // In this order: the files must be gone before the directories made for them can go.
    staging: TempDir,
    unfinished: Unfinished,
    parents: MadeParents,
    target: PathBuf,
    /// The path as the user gave it.
    path: PathBuf,
    /// Files of earlier results that this one does not have.
    absent: Vec<String>,
}

impl OutputDir {
    /// Begin the directory that will be at `path`, beside it; missing directories are made.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let path = path.as_ref();
        let (staging, parents, target) = match look_at(path)? {
            Existing::Something { target, metadata } if metadata.is_dir() => {
                (stage_for(&target), MadeParents::default(), target)
            }
            Existing::Something { .. } => return Err(OutputError::NotADirectory { path: path.into() }),
            Existing::Nothing { parent, target } => {
                let parents = MadeParents::make(&parent)?;
                (stage_in(&parent), parents, target)
            }
        };
        let (staging, unfinished) = staging.map_err(OutputError::io(path))?;
        Ok(Self { staging, unfinished, parents, target, path: path.into(), absent: Vec::new() })
    }

    /// Refuse, before the work is done, a folder in which one of these files is there and no result of this program.
    pub fn check(path: impl AsRef<Path>, names: &[&str]) -> Result<(), OutputError> {
        names.iter().try_for_each(|name| marker::check(path.as_ref(), name, path.as_ref()))
    }

    /// This result has no such file: one of an earlier result goes when this one is put into its place.
    pub fn leave_out(&mut self, name: &str) {
        self.absent.push(name.into());
    }

    /// Begin a file of the result.
    pub fn create_file(&self, name: &str) -> Result<StagedFile, OutputError> {
        marker::check(&self.target, name, &self.path)?;
        let shown = self.path.join(name);
        let unfinished = self.staging.path().join(format!("{name}{UNFINISHED}"));
        let file = fs::File::create(&unfinished).map_err(OutputError::io(&shown))?;
        let finished = self.staging.path().join(name);
        Ok(StagedFile { stream: Stream::new(file, shown), unfinished, finished })
    }

    /// Write a whole file of the result.
    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> Result<(), OutputError> {
        let mut file = self.create_file(name)?;
        file.stream.write_all(contents.as_ref()).map_err(OutputError::io(&self.path.join(name)))?;
        file.finish()
    }

    /// Put the result into its place: a new directory in one step, an existing one file by file with the file named
    /// `last` at the end, so that whoever finds that file new finds all of them new. Other files there stay.
    pub fn commit(self, last: &str) -> Result<(), OutputError> {
        let names = self.finished_files(last)?;
        let staged = names.iter().map(|name| name.to_string_lossy().into_owned());
        marker::write(&self.target, staged, self.staging.path()).map_err(OutputError::io(&self.path))?;
        self.put_into_place(&names)?;
        let Self { staging, unfinished, parents, .. } = self;
        parents.keep();
        // After the one rename there is nothing left to remove, and after the others an empty directory.
        drop(staging);
        drop(unfinished);
        Ok(())
    }

    /// All of it, or by a signal nothing of it.
    fn put_into_place(&self, names: &[OsString]) -> Result<(), OutputError> {
        let _held = unfinished();
        if self.target.is_dir() {
            self.move_over(names)
        } else {
            fs::rename(self.staging.path(), &self.target).map_err(OutputError::io(&self.path))?;
            sync_parent(&self.target);
            Ok(())
        }
    }

    /// The files to be moved, `last` at the end.
    fn finished_files(&self, last: &str) -> Result<Vec<OsString>, OutputError> {
        let entries = fs::read_dir(self.staging.path()).and_then(|entries| entries.collect::<io::Result<Vec<_>>>());
        let mut names: Vec<_> =
            entries.map_err(OutputError::io(&self.path))?.into_iter().map(|entry| entry.file_name()).collect();
        let unfinished = names.iter().find(|name| name.to_string_lossy().ends_with(UNFINISHED));
        let missing = Some(OsString::from(last)).filter(|last| !names.contains(last));
        if let Some(name) = unfinished.cloned().or(missing) {
            let name = name.to_string_lossy();
            return Err(OutputError::Unfinished { path: self.path.join(name.trim_end_matches(UNFINISHED)) });
        }
        names.sort_by_key(|name| (name == last, name.clone()));
        Ok(names)
    }

    /// Somebody else's stay.
    fn remove_absent(&self) -> Result<(), OutputError> {
        for name in &self.absent {
            let path = self.target.join(name);
            if path.is_file() && marker::check(&self.target, name, &self.path).is_ok() {
                fs::remove_file(path).map_err(OutputError::io(&self.path.join(name)))?;
            }
        }
        Ok(())
    }

    fn move_over(&self, names: &[OsString]) -> Result<(), OutputError> {
        // Before the first one is moved, so that none is when one cannot be.
        if let Some(name) = names.iter().find(|name| self.target.join(name).is_dir()) {
            return Err(OutputError::NotAFile { path: self.path.join(name) });
        }
        for name in names {
            marker::check(&self.target, &name.to_string_lossy(), &self.path)?;
        }
        self.remove_absent()?;
        // The list first: a file that is listed and not there does no harm.
        for name in std::iter::once(OsStr::new(marker::MARKER)).chain(names.iter().map(OsString::as_os_str)) {
            let shown = self.path.join(name);
            fs::rename(self.staging.path().join(name), self.target.join(name)).map_err(OutputError::io(&shown))?;
        }
        sync_directory(&self.target);
        Ok(())
    }
}

/// A file of an [`OutputDir`]. It belongs to the result only after [`finish`](Self::finish), which tells whether all
/// of it could be written; with a file begun and not finished, the directory cannot be committed.
#[derive(Debug)]
pub struct StagedFile {
    stream: Stream,
    unfinished: PathBuf,
    finished: PathBuf,
}

impl StagedFile {
    /// Write out what is still in memory, and close the file.
    pub fn finish(self) -> Result<(), OutputError> {
        self.stream.finish()?;
        fs::rename(&self.unfinished, &self.finished).map_err(OutputError::io(&self.finished))
    }
}

impl Write for StagedFile {
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

/// Beside an existing directory, or inside it where only there a rename can work: when it is the root of a file
/// system (a mounted disk, a container's volume), or its parent is not ours to write to.
fn stage_for(target: &Path) -> io::Result<(TempDir, Unfinished)> {
    use io::ErrorKind::{PermissionDenied, ReadOnlyFilesystem};
    match target.parent() {
        Some(parent) if same_file_system(parent, target) => match stage_in(parent) {
            Err(error) if matches!(error.kind(), PermissionDenied | ReadOnlyFilesystem) => stage_in(target),
            staging => staging,
        },
        _ => stage_in(target),
    }
}

#[cfg(unix)]
fn same_file_system(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let device = |path: &Path| fs::metadata(path).map(|metadata| metadata.dev()).ok();
    device(a) == device(b)
}

#[cfg(not(unix))]
fn same_file_system(_: &Path, _: &Path) -> bool {
    true
}

fn stage_in(parent: &Path) -> io::Result<(TempDir, Unfinished)> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(".partial");
    // Temporary directories are for their owner alone; a result is as readable as any other directory.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    Unfinished::make(|| builder.tempdir_in(parent), |made| made.path().into())
}

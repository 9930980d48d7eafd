//! Where a result goes, and the directories that had to be made for it.

use super::cleanup::Unfinished;
use super::error::OutputError;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// What is at a path already.
pub(super) enum Existing {
    /// Nothing. The parent and the name of what is to be made.
    Nothing { parent: PathBuf, target: PathBuf },
    /// A file, directory or device, with all symbolic links resolved: the links shall survive.
    Something { target: PathBuf, metadata: fs::Metadata },
}

/// Look at the path before hours of work go into what cannot be put there.
pub(super) fn look_at(path: &Path) -> Result<Existing, OutputError> {
    match fs::metadata(path) {
        Ok(metadata) => {
            let target = path.canonicalize().map_err(OutputError::io(path))?;
            Ok(Existing::Something { target, metadata })
        }
        // A symbolic link to nowhere also is something that must not be renamed over; making what it points to is
        // more than was asked for.
        Err(error) if error.kind() == io::ErrorKind::NotFound && path.symlink_metadata().is_err() => {
            let name = path.file_name().ok_or_else(|| OutputError::NoName { path: path.into() })?;
            let parent = match path.parent() {
                Some(parent) if !parent.as_os_str().is_empty() => parent,
                _ => Path::new("."),
            };
            Ok(Existing::Nothing { parent: parent.into(), target: parent.join(name) })
        }
        Err(error) => Err(OutputError::io(path)(error)),
    }
}

/// Directories made on the way to a result; gone again unless the result is kept.
#[derive(Debug, Default)]
pub(super) struct MadeParents {
    /// The outermost first.
    made: Vec<(PathBuf, Unfinished)>,
}

impl MadeParents {
    /// Make `directory` and whatever is missing above it.
    pub(super) fn make(directory: &Path) -> Result<Self, OutputError> {
        let missing: Vec<_> = directory.ancestors().take_while(|path| !exists(path)).collect();
        let mut parents = Self::default();
        for path in missing.into_iter().rev() {
            match Unfinished::make(|| fs::create_dir(path), |()| path.into()) {
                Ok(((), unfinished)) => parents.made.push((path.into(), unfinished)),
                // Somebody else was faster, or it is the `..` of one just made: not ours to remove.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(OutputError::io(path)(error)),
            }
        }
        Ok(parents)
    }

    /// The result is there: so the directories stay.
    pub(super) fn keep(mut self) {
        self.made.clear();
    }
}

impl Drop for MadeParents {
    fn drop(&mut self) {
        for (path, _) in self.made.iter().rev() {
            // Fails when somebody has put something into it, and then rightly so.
            let _ = fs::remove_dir(path);
        }
    }
}

fn exists(path: &Path) -> bool {
    path.as_os_str().is_empty() || path.symlink_metadata().is_ok()
}

/// Make renames to `directory` survive a power cut. Where directories cannot be synchronised nothing can be done.
pub(super) fn sync_directory(directory: &Path) {
    let _ = fs::File::open(directory).and_then(|directory| directory.sync_all());
}

/// [`sync_directory`] of the one that `target` lies in.
pub(super) fn sync_parent(target: &Path) {
    if let Some(parent) = target.parent() {
        sync_directory(parent);
    }
}

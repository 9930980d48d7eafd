//! What must not stay behind when the program is told to end in the middle of its work.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What a shell says of a program that Ctrl-C has ended.
const EXIT_CODE: i32 = 130;

/// How often to try to remove a folder: the work goes on beside, and may put something into it meanwhile.
const TRIES: usize = 20;

/// Everything that is not finished, in the order in which it was made.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// From now on remove what is not finished when the user (Ctrl-C) or the system (SIGTERM) ends the program, with exit code
/// 130. Once for the whole program.
///
/// # Errors
///
/// When the system does not let the program know.
pub fn clean_up_on_signals() -> Result<(), ctrlc::Error> {
    ctrlc::try_set_handler(|| {
        // Kept until the end: nothing is made, and no result put into its place, from here on.
        let mut unfinished = unfinished();
        unfinished.drain(..).rev().for_each(|path| remove(&path));
        std::process::exit(EXIT_CODE);
    })
}

/// Whoever calls this does not come back when the program is already being ended: what fails because of that is not told.
pub fn wait_if_ending() {
    drop(unfinished());
}

/// The list, locked: as long as it is, no signal ends the program.
pub(super) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

fn remove(path: &Path) {
    for _ in 0..TRIES {
        // An empty folder only, save our own: what others have put into a folder that was made on the way stays.
        let removed = match path.is_dir() {
            true if is_ours(path) => fs::remove_dir_all(path),
            true => return fs::remove_dir(path).unwrap_or_default(),
            false => fs::remove_file(path),
        };
        if removed.is_ok() || !path.exists() {
            return;
        }
    }
}

/// Prefix of everything that is written aside.
pub(super) const PREFIX: &str = ".host-sim-";

fn is_ours(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PREFIX))
}

/// Something that is not finished, as long as this lives.
#[derive(Debug)]
pub(super) struct Unfinished(PathBuf);

impl Unfinished {
    /// Make something at a path that only its maker knows, without a moment in which it is not on the list.
    pub(super) fn make<T>(
        make: impl FnOnce() -> io::Result<T>,
        path: impl FnOnce(&T) -> PathBuf,
    ) -> io::Result<(T, Self)> {
        let mut unfinished = unfinished();
        let made = make()?;
        let path = path(&made);
        unfinished.push(path.clone());
        Ok((made, Self(path)))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.0);
    }
}

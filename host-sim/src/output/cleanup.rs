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
/// 130. A signal that the program was told to ignore when it was started, it goes on to ignore. Once for the whole program.
///
/// # Errors
///
/// When the system does not let the program know.
#[cfg(unix)]
pub fn clean_up_on_signals() -> io::Result<()> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    let heeded = [SIGINT, SIGTERM].into_iter().filter(|&signal| !is_ignored(signal));
    let mut signals = signal_hook::iterator::Signals::new(heeded)?;
    std::thread::Builder::new().name("signals".into()).spawn(move || {
        if signals.forever().next().is_some() {
            end();
        }
    })?;
    Ok(())
}

/// The same where Ctrl-C is all there is.
#[cfg(not(unix))]
pub fn clean_up_on_signals() -> io::Result<()> {
    ctrlc::set_handler(|| end()).map_err(io::Error::other)
}

/// As Linux tells it: what a script starts in the background must not end when the script is told to.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

fn end() -> ! {
    // Kept until the end: nothing is made, and no result put into its place, from here on.
    let mut unfinished = unfinished();
    unfinished.drain(..).rev().for_each(|path| remove(&path));
    std::process::exit(EXIT_CODE);
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

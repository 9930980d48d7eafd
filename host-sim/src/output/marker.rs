//! Which files of a folder are results of this program, so that nobody else's is replaced.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::Path;

use super::error::OutputError;

/// The file that lists them.
pub(super) const MARKER: &str = ".host-sim";

const FIRST_LINE: &str =
    "# Files of this folder that host-sim has written, and will replace when it is told to write here.";

/// Refuse to write a file of this name into a folder that holds somebody else's; `shown` is the folder as the user gave it.
pub(super) fn check(folder: &Path, name: &str, shown: &Path) -> Result<(), OutputError> {
    if !folder.join(name).exists() || written(folder).contains(name) {
        return Ok(());
    }
    Err(OutputError::Foreign { path: shown.join(name), folder: shown.into() })
}

/// Before files of these names are written one by one into a folder that is there: refuse if one is somebody else's, and
/// list them.
///
/// # Errors
///
/// When one is there and not listed, or the list cannot be written.
pub fn claim(folder: &Path, names: &[&str]) -> Result<(), OutputError> {
    names.iter().try_for_each(|name| check(folder, name, folder))?;
    let names = names.iter().map(ToString::to_string);
    write(folder, names, folder).map_err(OutputError::io(&folder.join(MARKER)))
}

/// The files that this program has written into a folder; none where nothing says so.
fn written(folder: &Path) -> BTreeSet<String> {
    let text = fs::read_to_string(folder.join(MARKER)).unwrap_or_default();
    text.lines().filter(|line| !line.starts_with('#')).map(String::from).collect()
}

/// The list of `folder` with these names, put into `staging`.
pub(super) fn write(folder: &Path, names: impl Iterator<Item = String>, staging: &Path) -> io::Result<()> {
    let mut all = written(folder);
    all.extend(names);
    let lines: Vec<String> = std::iter::once(FIRST_LINE.to_string()).chain(all).collect();
    fs::write(staging.join(MARKER), lines.join("\n") + "\n")
}

//! `host-sim trial merge`: the parts of a trial as the one that they are.

use std::path::{Path, PathBuf};

use towmag_trial::{Merged, Part, Trial, merge};

use super::trial::{RESULTS, finish, kept, make_folder, write};
use crate::error::HostError;
use crate::output::{OutputDir, OutputError, claim};
use crate::recording::RecordingError;

/// Put together what `trial --shard` has written into these folders, in whatever order they are.
pub fn merge_trial(parts: &[PathBuf], out: &Path) -> Result<Trial, HostError> {
    check_apart(parts, out)?;
    OutputDir::check(out, &RESULTS)?;
    let read_parts: Vec<Part> = parts.iter().map(|folder| part(folder)).collect::<Result<_, _>>()?;
    let Merged { answers, trial } = merge(read_parts)?;
    make_folder(out)?;
    claim(out, &RESULTS)?;
    write(&out.join("answers.json"), &answers)?;
    if trial.options.keep {
        parts.iter().try_for_each(|folder| keep(folder, out))?;
    }
    finish(out, &trial)?;
    Ok(trial)
}

/// A part that is replaced by the whole could not be merged again.
fn check_apart(parts: &[PathBuf], out: &Path) -> Result<(), HostError> {
    let Ok(out_itself) = out.canonicalize() else { return Ok(()) };
    match parts.iter().find(|part| part.canonicalize().is_ok_and(|part| part == out_itself)) {
        Some(part) => {
            Err(HostError::Usage(format!("--out {}: is a part of the trial: name another folder", part.display())))
        }
        None => Ok(()),
    }
}

fn part(folder: &Path) -> Result<Part, HostError> {
    let [answers, trial] = ["answers.json", "trial.json"].map(|name| text(&folder.join(name)));
    Ok(Part::read(&folder.display().to_string(), &answers?, &trial?)?)
}

fn text(path: &Path) -> Result<String, RecordingError> {
    std::fs::read_to_string(path).map_err(|source| RecordingError::Io { path: path.display().to_string(), source })
}

fn keep(part: &Path, out: &Path) -> Result<(), HostError> {
    let (from, to) = (part.join("recordings"), kept(out)?);
    let unread = |source| RecordingError::Io { path: from.display().to_string(), source };
    for entry in std::fs::read_dir(&from).map_err(unread)? {
        let name = entry.map_err(unread)?.file_name();
        let copied = std::fs::copy(from.join(&name), to.join(&name));
        copied.map_err(|source| OutputError::Io { path: to.join(&name), source })?;
    }
    Ok(())
}

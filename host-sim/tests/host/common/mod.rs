//! `host-sim` as a user runs it.

pub(crate) mod python;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A file of this repository.
pub(crate) fn of_repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// A preset of this repository, of so many seconds.
pub(crate) fn preset_of(name: &str, duration_s: f64) -> String {
    let preset = std::fs::read_to_string(of_repository("scenarios").join(name)).unwrap();
    let own = preset.lines().find(|line| line.starts_with("duration_s")).unwrap();
    preset.replace(own, &format!("duration_s = {duration_s:?}"))
}

/// The first rows of a recording, as one of its name in this folder.
pub(crate) fn first_rows(folder: &Path, recording: &Path, rows: usize) -> PathBuf {
    let whole = std::fs::read_to_string(recording).unwrap();
    let path = folder.join(recording.file_name().unwrap());
    std::fs::write(&path, whole.split_inclusive('\n').take(rows + 1).collect::<String>()).unwrap();
    path
}

/// The beginning of the sample's survey, with one row less than contacts are looked for in: what has no use for their marks on its page
/// gets it replayed at once.
pub(crate) fn without_marks(folder: &Path) -> PathBuf {
    first_rows(folder, &of_repository("sample/survey.csv"), 599)
}

pub(crate) fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A command that must succeed; what it printed.
pub(crate) fn done(arguments: &[&str]) -> String {
    let output = host_sim(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// A command that must fail with exit code 2; its one line.
pub(crate) fn refused(arguments: &[&str]) -> String {
    let output = host_sim(arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert_eq!((output.stdout.len(), stderr.lines().count()), (0, 1), "{stderr}");
    stderr.trim_end().to_string()
}

pub(crate) fn host_sim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_host-sim")).args(arguments).output().unwrap()
}

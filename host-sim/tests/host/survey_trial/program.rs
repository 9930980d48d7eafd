//! The program that is judged, the seeds, and where files go.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// `HOST_SIM`, or what was built with this test.
pub(crate) fn program() -> PathBuf {
    std::env::var_os("HOST_SIM").map_or_else(|| env!("CARGO_BIN_EXE_host-sim").into(), PathBuf::from)
}

/// Run it; what it says where it fails.
pub(crate) fn run(arguments: &[&str]) -> Result<(), String> {
    let output = Command::new(program()).arg("--quiet").args(arguments).output().map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(());
    }
    Err(format!("host-sim {}: {}", arguments.join(" "), String::from_utf8_lossy(&output.stderr).trim_end()))
}

/// A survey of one recording into a folder.
pub(crate) fn survey(recording: &Path, coefficients: Option<&Path>, out: &Path) -> Result<(), String> {
    let coefficients: Vec<&str> = coefficients.iter().flat_map(|file| ["--coefficients", text(file)]).collect();
    survey_with(recording, &coefficients, out)
}

/// A survey with these options, and those of `SURVEY_TRIAL_OPTIONS` that are not among them.
pub(crate) fn survey_with(recording: &Path, options: &[&str], out: &Path) -> Result<(), String> {
    let more = std::env::var("SURVEY_TRIAL_OPTIONS").unwrap_or_default();
    let more: Vec<&str> = more.split_whitespace().filter(|option| !options.contains(option)).collect();
    run(&[&["survey", text(recording), "--out", text(out)][..], options, &more].concat())
}

/// Coefficients of a calibration.
pub(crate) fn calibrated(recording: &Path, out: &Path) -> Result<PathBuf, String> {
    run(&["calibrate", text(recording), "--out", text(out)])?;
    Ok(out.join("coefficients.toml"))
}

/// `summary.json` of a result.
pub(crate) fn summary(folder: &Path) -> Value {
    json(&folder.join("summary.json"))
}

/// A file of a result.
pub(crate) fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// `SURVEY_TRIAL_SEEDS`, or these.
pub(crate) fn seeds(otherwise: Range<u64>) -> Range<u64> {
    let Ok(text) = std::env::var("SURVEY_TRIAL_SEEDS") else { return otherwise };
    let (first, end) = text.split_once("..").expect("SURVEY_TRIAL_SEEDS is FIRST..END");
    first.parse().unwrap()..end.parse().unwrap()
}

/// A folder for the files of a part: kept if asked for, else gone with the value.
pub(crate) struct Folder {
    path: PathBuf,
    _temporary: Option<tempfile::TempDir>,
}

impl Folder {
    pub(crate) fn new(part: &str) -> Self {
        if let Some(kept) = std::env::var_os("SURVEY_TRIAL_KEEP") {
            let path = PathBuf::from(kept).join(part);
            std::fs::create_dir_all(&path).unwrap();
            return Self { path, _temporary: None };
        }
        let temporary = tempfile::tempdir().unwrap();
        Self { path: temporary.path().into(), _temporary: Some(temporary) }
    }

    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}

/// The flights and the peer's test; says that it skips where they are not.
pub(crate) fn data(part: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let path = std::env::var_os("TOWMAG_DATA").map_or(beside, PathBuf::from).join(part);
    if !path.exists() {
        println!("skipped: no {part} beside the project, and TOWMAG_DATA is not set");
    }
    path.exists().then_some(path)
}

pub(crate) fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

//! Tracks, contacts and map, read by GDAL through Python: what QGIS reads with. See `readers.py`.

use std::path::Path;
use std::process::Command;

use super::tow::Tow;
use crate::common::{done, text};

/// It takes a hundred megabytes, so it is asked for: by the path of a Python in `TOWMAG_PYTHON` that has the packages of
/// `export/tests/requirements.txt`.
#[test]
fn other_programs_open_the_map() {
    let Some(python) = std::env::var_os("TOWMAG_PYTHON") else {
        println!("skipped: TOWMAG_PYTHON names no Python");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let rec = Tow::sample().with_positions().written(folder.path(), "rec.csv");
    let out = folder.path().join("out");
    done(&["survey", text(&rec), "--out", text(&out)]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/host/survey/readers.py");
    let output = Command::new(python).arg(script).arg(&out).output().expect("there is a Python");
    let [stdout, stderr] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    println!("{stdout}");
    assert!(output.status.success(), "{stdout}\n{stderr}");
}

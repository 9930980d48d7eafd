//! Tracks, contacts and map, read by GDAL through Python: what QGIS reads with. See `readers.py`.

use std::path::Path;
use std::process::Command;

/// It takes a hundred megabytes, so it is asked for: by the path of a Python in `TOWMAG_PYTHON` that has the packages of
/// `export/tests/requirements.txt`.
pub(crate) fn opened_by_others(survey: &Path) {
    let Some(python) = std::env::var_os("TOWMAG_PYTHON") else {
        println!("skipped: TOWMAG_PYTHON names no Python");
        return;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/host/survey/readers.py");
    let output = Command::new(python).arg(script).arg(survey).output().expect("there is a Python");
    let [stdout, stderr] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    println!("{stdout}");
    assert!(output.status.success(), "{stdout}\n{stderr}");
}

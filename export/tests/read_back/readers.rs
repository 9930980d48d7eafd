//! Every format, read by the programs that people use: Python's, in `readers.py`.

use std::path::Path;
use std::process::Command;

use towmag_export::{Format, Options, encode};

use super::{SAMPLE, sample};

/// They take a hundred megabytes, so they are asked for: by the path of a Python in `TOWMAG_PYTHON` that has the packages of
/// `requirements.txt`.
#[test]
fn other_programs_read_the_same_values() {
    let Some(python) = std::env::var_os("TOWMAG_PYTHON") else {
        println!("skipped: TOWMAG_PYTHON names no Python");
        return;
    };
    let folder = std::env::temp_dir().join(format!("towmag-readers-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("sample.csv"), SAMPLE).unwrap();
    for format in Format::ALL {
        let options = Options { points: format == Format::Geojson, ..Options::default() };
        let bytes = encode(&sample(), format, &options).unwrap();
        std::fs::write(folder.join(format!("sample.{format}")), bytes).unwrap();
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/readers.py");
    let output = Command::new(python).arg(script).arg(&folder).output().expect("there is a Python");
    let [stdout, stderr] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    std::fs::remove_dir_all(&folder).unwrap();
    println!("{stdout}");
    assert!(output.status.success(), "{stdout}\n{stderr}");
}

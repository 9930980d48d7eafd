//! The notebooks of `examples/python` from recordings to what they print and draw.
//!
//! Installs nothing: without a python3 that has pandas and matplotlib it says so and passes. With the path of a Python in
//! `TOWMAG_PYTHON`, as in CI, that one must have them.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::python::{has_python, python};
use crate::common::{first_rows, of_repository};
use tempfile::TempDir;

/// Whether there is a Python that can run the notebooks.
fn has_notebooks() -> bool {
    has_python("pandas, matplotlib", "examples/python/requirements.txt")
}

/// Two and a half minutes of a sample, enough for each step.
fn cut(folder: &TempDir, sample: &str) -> PathBuf {
    first_rows(folder.path(), &of_repository("sample").join(sample), 1500)
}

fn drawn(calibration: &Path, recording: &Path, out: &Path) -> std::process::Output {
    Command::new(python())
        .arg(of_repository("examples/python/towmag_notebook.py"))
        .args([calibration, recording])
        .arg("--out")
        .arg(out)
        .args(["--host-sim", env!("CARGO_BIN_EXE_host-sim")])
        .env("MPLBACKEND", "Agg")
        .output()
        .unwrap()
}

#[test]
fn the_notebook_draws_what_the_results_hold() {
    if !has_notebooks() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let [calibration, survey] = ["calibration.csv", "survey.csv"].map(|sample| cut(&folder, sample));
    let out = folder.path().join("out");
    let done = drawn(&calibration, &survey, &out);
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let json = |name: &str| -> serde_json::Value {
        serde_json::from_str(&std::fs::read_to_string(out.join(name)).unwrap()).unwrap()
    };
    let (summary, diagnosis) = (json("compensated/summary.json"), json("gap/diagnosis.json"));
    let after = format!("{:.2} nT after", summary["std_after_nT"].as_f64().unwrap());
    assert!(said.contains(&after) && said.contains(diagnosis["summary"].as_str().unwrap()), "{said}");
    let picture = std::fs::read(out.join("picture.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG") && picture.len() > 30_000, "{} bytes", picture.len());
}

#[test]
fn a_recording_is_held_against_a_simulation_that_a_notebook_makes() {
    if !has_notebooks() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let done = Command::new(python())
        .arg(of_repository("examples/python/own_simulation.py"))
        .arg(cut(&folder, "survey.csv"))
        .arg("--out")
        .arg(folder.path().join("out"))
        .args(["--host-sim", env!("CARGO_BIN_EXE_host-sim")])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    // The clock of its simulation is 3.21 s ahead.
    let (_, offset) = said.split_once("clock is ").unwrap();
    let offset_s: f64 = offset.split(' ').next().unwrap().parse().unwrap();
    assert!((offset_s - 3.21).abs() < 0.005, "{said}");
}

#[test]
fn what_the_program_says_is_what_the_notebook_says() {
    if !has_notebooks() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let survey = cut(&folder, "survey.csv");
    let damaged = folder.path().join("damaged.csv");
    std::fs::write(&damaged, "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT\n").unwrap();
    for calibration in [&damaged, &folder.path().join("nowhere.csv")] {
        let done = drawn(calibration, &survey, &folder.path().join("out"));
        let (said, name) = (String::from_utf8_lossy(&done.stderr), calibration.file_name().unwrap().to_str().unwrap());
        assert!(!done.status.success() && said.contains(name) && !said.contains("Traceback"), "{said}");
    }
}

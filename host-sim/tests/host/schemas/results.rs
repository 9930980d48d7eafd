//! Each kind of result, from recordings of a few minutes.

use std::path::{Path, PathBuf};

use host_sim::command::{self, CompareOptions, DiagnoseOptions, SurveyRequest};
use host_sim::detection::InjectionSettings;
use host_sim::effects::{Library, Request};
use host_sim::listen::{ListenOptions, Screen, listen};
use host_sim::recording::Input;
use tempfile::TempDir;
use towmag::link::text_frame;
use towmag::{Method, Settings};
use towmag_trial::TrialOptions;

use crate::common::{first_rows, of_repository};
use crate::device::{card, card_of};

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

pub(crate) fn header(csv: &Path) -> Vec<String> {
    csv::Reader::from_path(csv).unwrap().headers().unwrap().iter().map(String::from).collect()
}

/// The first rows of a sample.
fn cut(folder: &TempDir, sample: &str, rows: usize) -> PathBuf {
    first_rows(folder.path(), &of_repository("sample").join(sample), rows)
}

pub(crate) fn compensation() -> TempDir {
    let (folder, settings) = (folder(), Settings::default());
    let out = |name: &str| folder.path().join(name);
    let calibration = cut(&folder, "calibration.csv", 1500);
    let survey = cut(&folder, "survey.csv", 1500);
    command::calibrate(&calibration, &out("calibrated"), &settings).unwrap();
    let coefficients = out("calibrated/coefficients.toml");
    command::replay(&survey, Some(&coefficients), &out("replayed"), &settings).unwrap();
    let injection = InjectionSettings { anomalies: 3, ..InjectionSettings::default() };
    let options = CompareOptions { injection, ..CompareOptions::default() };
    command::compare(&calibration, &survey, &out("compared"), &settings, &options).unwrap();
    folder
}

/// The sample on a straight way with positions, and a row that is no good.
pub(crate) fn surveyed() -> TempDir {
    let folder = folder();
    let path = cut(&folder, "survey.csv", 1500);
    let text = std::fs::read_to_string(&path).unwrap();
    let mut placed = String::new();
    for (row, line) in text.lines().enumerate() {
        let position = match row {
            0 => "latitude_deg,longitude_deg".to_string(),
            500 => "north,east".into(),
            row => format!("{:.8},10.5", 54.3 + row as f64 * 1.5e-6),
        };
        placed.push_str(&format!("{line},{position}\n"));
    }
    std::fs::write(&path, placed).unwrap();
    let request = SurveyRequest { recordings: vec![Input::new(path, false)], ..SurveyRequest::default() };
    command::survey(request, &folder.path().join("out")).unwrap();
    folder
}

/// A preset, made shorter.
fn scenario(folder: &TempDir, preset: &str, duration_s: &str) -> PathBuf {
    let text = std::fs::read_to_string(of_repository("scenarios").join(preset)).unwrap();
    let line = text.lines().find(|line| line.starts_with("duration_s")).unwrap();
    let path = folder.path().join(preset);
    std::fs::write(&path, text.replace(line, &format!("duration_s = {duration_s}"))).unwrap();
    path
}

pub(crate) fn diagnosis() -> TempDir {
    let folder = folder();
    let recording = folder.path().join("tow.csv");
    let land = scenario(&folder, "land_calibration.toml", "120.0");
    let effect: Request = "mains_alias:frequency_hz=1.3,amplitude_nT=0.2,phase_rad=0".parse().unwrap();
    command::simulate(&land, &recording, None, &[effect], None).unwrap();
    let options = DiagnoseOptions { confirm: Some(&recording), ..DiagnoseOptions::default() };
    command::diagnose(&recording, &folder.path().join("gap"), &options).unwrap();
    folder
}

/// The same recording held against a simulation, and what could be told of a planned one.
pub(crate) fn held_against() -> TempDir {
    let folder = folder();
    let [recording, simulation] = ["tow.csv", "own.csv"].map(|name| folder.path().join(name));
    let land = scenario(&folder, "land_calibration.toml", "120.0");
    command::simulate(&land, &recording, None, &[], None).unwrap();
    std::fs::copy(&recording, &simulation).unwrap();
    let options = DiagnoseOptions { simulation: Some(&simulation), ..DiagnoseOptions::default() };
    command::diagnose(&recording, &folder.path().join("gap"), &options).unwrap();
    command::plan(&land, &folder.path().join("plan"), 1, Library::default()).unwrap();
    folder
}

pub(crate) fn trial() -> TempDir {
    let folder = folder();
    let options = TrialOptions { recordings: 2, seed: 5, minutes: Some(2.0), ..TrialOptions::default() };
    command::trial(folder.path(), &options, |_| ()).unwrap();
    folder
}

pub(crate) fn recovered() -> TempDir {
    let folder = folder();
    let log = folder.path().join("TOWMAG01.BIN");
    std::fs::write(&log, card().0.concat()).unwrap();
    command::recover(&log, &folder.path().join("found")).unwrap();
    folder
}

/// The diagnosis of a log whose body has answered otherwise than the core does.
pub(crate) fn mismatch() -> TempDir {
    let folder = folder();
    let log = folder.path().join("TOWMAG01.BIN");
    let wrong = card_of(Method::SaddlePoint, &towmag::model::Coefficients::ZERO.into(), |mut output| {
        output.compensated.iter_mut().for_each(|compensated| compensated.residual_nt += 0.5);
        output
    });
    std::fs::write(&log, wrong.0.concat()).unwrap();
    command::diagnose(&log, &folder.path().join("gap"), &DiagnoseOptions::default()).unwrap();
    folder
}

pub(crate) fn table() -> TempDir {
    let folder = folder();
    let land = scenario(&folder, "land_calibration.toml", "200.0");
    let tow = scenario(&folder, "lake_tow.toml", "200.0");
    command::table(&land, &[tow], folder.path(), &Settings::default()).unwrap();
    folder
}

/// A cable on which a line of text came: the table has its header.
pub(crate) fn heard() -> TempDir {
    let folder = folder();
    let cable = folder.path().join("cable.bin");
    std::fs::write(&cable, text_frame("ready")).unwrap();
    let csv = Some(folder.path().join("telemetry.csv"));
    let options = ListenOptions { port: cable.to_str().unwrap().into(), baud: None, record: None, csv };
    listen(&options, std::io::empty(), &mut Screen::new(&mut Vec::new(), false)).unwrap();
    folder
}

/// A workbook with a bad row, and dates and times of day in a text with comments: what each import has written.
pub(crate) fn imported() -> TempDir {
    let folder = folder();
    for name in ["units_row.xlsx", "comments.csv", "date_and_time.csv"] {
        let file = of_repository("import/tests/corpus").join(name);
        let out = folder.path().join(name).with_extension("csv");
        command::import(&[file], &out, &towmag_import::Options::default()).unwrap();
    }
    folder
}

//! The real flight recordings, against figures computed in f64 by another program. They may not be distributed with
//! the project: the tests look for them in `../shared/data` beside the project, or where `TOWMAG_DATA` points, and say
//! that they skip when they are not there.

use std::path::{Path, PathBuf};

use host_sim::command;
use towmag::{Method, Settings};

/// The allowed distance from the figures.
///
/// What differs: here the recursions start in the survey file, 34 s after its first row, when the filter's transient
/// has decayed, and learn from the turn before box 2 as well; the figures' start on the first row of box 2 with a filter
/// that ran through the whole line. And the calibration here takes the transit rows of its file too.
const ALLOWED: f64 = 0.05;

/// Fluxgate, scalar calibrated, scalar surveyed; causal f64 standard deviations over box 2, nT: before, fixed, rls,
/// saddle-point.
const FIGURES: [(&str, u32, u32, [f64; 4]); 5] = [
    ("b", 5, 5, [12.098, 0.696, 0.430, 0.430]),
    ("c", 4, 4, [40.230, 2.011, 1.666, 1.766]),
    ("c", 5, 4, [40.230, 42.525, 1.848, 1.905]),
    ("c", 4, 5, [12.098, 42.242, 0.426, 0.426]),
    ("b", 5, 4, [40.230, 42.623, 3.520, 3.632]),
];

fn data() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = std::env::var_os("TOWMAG_DATA").map_or(beside, PathBuf::from).join("sgl_line_1002_20");
    folder.is_dir().then_some(folder)
}

/// Population standard deviation of `residual_nT` over the rows of box 2.
fn box2_std_nt(compensated: &Path) -> f64 {
    let mut reader = csv::Reader::from_path(compensated).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|header| header == name).unwrap();
    let (line, residual, valid) = (column("line"), column("residual_nT"), column("valid"));
    let values: Vec<f64> = reader
        .records()
        .map(Result::unwrap)
        .filter(|record| &record[line] == "box2")
        .inspect(|record| assert_eq!(&record[valid], "1"))
        .map(|record| record[residual].parse().unwrap())
        .collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn residuals_are_those_of_the_f64_reference() {
    let Some(data) = data() else {
        println!("skipped: no flight recordings beside the project, and TOWMAG_DATA is not set");
        return;
    };
    let out = tempfile::tempdir().unwrap();
    let methods = [Method::None, Method::Fixed, Method::Rls, Method::SaddlePoint];
    let mut worst = 0.0_f64;
    println!("fluxgate, scalar: {:?} (nT, and against the reference)", methods);
    for (flux, calibrated, surveyed, figures) in FIGURES {
        let file = |scalar: u32, part: &str| data.join(format!("flux_{flux}_mag_{scalar}_{part}.csv"));
        let calibration = out.path().join("calibration");
        command::calibrate(&file(calibrated, "calibration"), &calibration, &Settings::default()).unwrap();
        print!("{flux} {calibrated} -> {surveyed}:");
        for (method, figure) in methods.into_iter().zip(figures) {
            let settings = Settings { method, ..Settings::default() };
            let coefficients = calibration.join("coefficients.toml");
            let replay = out.path().join("replay");
            command::replay(&file(surveyed, "survey"), Some(&coefficients), &replay, &settings).unwrap();
            let std_nt = box2_std_nt(&replay.join("compensated.csv"));
            let off = std_nt / figure - 1.0;
            print!("  {std_nt:7.3} {:+5.1} %", 100.0 * off);
            worst = worst.max(off.abs());
        }
        println!();
    }
    assert!(worst <= ALLOWED, "off by {:.1} %", 100.0 * worst);
}

#[test]
fn coefficients_of_an_exchanged_sensor_are_told_and_not_taken_for_other_axes() {
    let Some(data) = data() else {
        println!("skipped: no flight recordings beside the project, and TOWMAG_DATA is not set");
        return;
    };
    let out = tempfile::tempdir().unwrap();
    for (flux, calibrated, surveyed, _) in FIGURES {
        let file = |scalar: u32, part: &str| data.join(format!("flux_{flux}_mag_{scalar}_{part}.csv"));
        let [calibration, replay] = ["calibration", "replay"].map(|name| out.path().join(name));
        command::calibrate(&file(calibrated, "calibration"), &calibration, &Settings::default()).unwrap();
        let settings = Settings { method: Method::None, ..Settings::default() };
        let coefficients = Some(calibration.join("coefficients.toml"));
        let summary = command::replay(&file(surveyed, "survey"), coefficients.as_deref(), &replay, &settings).unwrap();
        let is_exchanged = calibrated != surveyed;
        let says = summary.warnings.iter().any(|warning| warning.contains("a sensor that was moved"));
        assert_eq!((summary.warnings.len(), says), (usize::from(is_exchanged), is_exchanged), "{:?}", summary.warnings);
    }
}

//! The real flight recordings, against figures computed in f64 by another program. They may not be distributed with
//! the project: the tests look for them in `../shared/data` beside the project, or where `TOWMAG_DATA` points, and say
//! that they skip when they are not there.

use std::path::{Path, PathBuf};

use host_sim::command;
use host_sim::recording::Input;
use host_sim::run::{CoefficientCheck, Mismatch, Start, pass};
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

/// Population standard deviation of the residual over the rows of box 2, all of which must be valid.
fn box2_std_nt(of: &Combination, method: Method) -> f64 {
    let settings = Settings { method, ..Settings::default() };
    let mut recording = Input::new(&of.survey, false).open().unwrap();
    let mut residual_nt: Vec<f64> = Vec::new();
    pass(&mut *recording, &[method], &settings, &of.start, |passed| {
        if passed.row.line == "box2" {
            residual_nt.push(passed.output.compensated.expect("valid").residual_nt.into());
        }
        Ok(())
    })
    .unwrap();
    let mean = residual_nt.iter().sum::<f64>() / residual_nt.len() as f64;
    (residual_nt.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / residual_nt.len() as f64).sqrt()
}

/// What a coefficient check says of a survey.
fn checked(of: &Combination) -> Option<Mismatch> {
    let settings = Settings::default();
    let mut check = CoefficientCheck::new(settings.band_pass).unwrap();
    let mut recording = Input::new(&of.survey, false).open().unwrap();
    pass(&mut *recording, &[Method::None], &settings, &of.start, |passed| {
        check.step(&passed.row.epoch);
        Ok(())
    })
    .unwrap();
    check.verdict(&of.start.prior.coefficients)
}

/// One of [`FIGURES`], with the start that its calibration gives.
struct Combination {
    name: String,
    survey: PathBuf,
    start: Start,
    is_exchanged: bool,
}

fn combinations(data: &Path) -> impl Iterator<Item = Combination> + use<'_> {
    FIGURES.into_iter().map(move |(flux, calibrated, surveyed, _)| {
        let out = tempfile::tempdir().unwrap();
        let file = |scalar: u32, part: &str| data.join(format!("flux_{flux}_mag_{scalar}_{part}.csv"));
        let calibration = command::calibrate(&file(calibrated, "calibration"), out.path(), &Settings::default());
        Combination {
            name: format!("{flux} {calibrated} -> {surveyed}"),
            survey: file(surveyed, "survey"),
            start: command::start_at(&calibration.unwrap().file),
            is_exchanged: calibrated != surveyed,
        }
    })
}

#[test]
fn residuals_are_those_of_the_f64_reference() {
    let Some(data) = data() else {
        println!("skipped: no flight recordings beside the project, and TOWMAG_DATA is not set");
        return;
    };
    let methods = [Method::None, Method::Fixed, Method::Rls, Method::SaddlePoint];
    let mut worst = 0.0_f64;
    println!("fluxgate, scalar: {methods:?} (nT, and against the reference)");
    for (combination, (.., figures)) in combinations(&data).zip(FIGURES) {
        print!("{}:", combination.name);
        for (method, figure) in methods.into_iter().zip(figures) {
            let std_nt = box2_std_nt(&combination, method);
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
    for combination in combinations(&data) {
        let told = checked(&combination);
        let is_told = told.as_ref().is_some_and(|mismatch| mismatch.explanation.is_none());
        let expected = (combination.is_exchanged, combination.is_exchanged);
        assert_eq!((told.is_some(), is_told), expected, "{}: {told:?}", combination.name);
    }
}

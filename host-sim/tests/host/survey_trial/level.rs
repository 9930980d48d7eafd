//! Error of the level on simulated tows with iron in them.
//!
//! The truth is the field at the sensor: Earth, rock, diurnal change and iron, without the body's own field and without
//! noise. Scored are the rows from 5 minutes on; the mean of the error over them is taken off, for no recording tells it.
//! A row of the survey that has no field counts as an error of 10 nT: leaving rows out is no way to a small figure.
//!
//! Each seed has a body, a tow and four dipoles of its own. `lake` and `sea` are surveyed without coefficients; `land to lake`
//! and `land to sea` with those of a calibration on land of the same body; `other body` with those of another one.

use std::path::{Path, PathBuf};

use host_sim::simulator::scenario::{DipoleSpec, Moment, Motion, Scenario, Simulation};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::csv_file::CsvFile;
use super::program::{self, Folder, calibrated, text};
use super::statistics::{mean, quantile};
use super::table::{FREE, Figure, finish};

const LAND: &str = include_str!("../../../../scenarios/land_calibration.toml");
const LAKE: &str = include_str!("../../../../scenarios/lake_tow.toml");
const SEA: &str = include_str!("../../../../scenarios/sea_tow.toml");

/// Rows that are not scored, at the begin.
const SKIPPED_ROWS: usize = 3000;
/// Error that a row without a field counts as, nT.
const ABSENT_NT: f64 = 10.0;

/// Whose calibration is given.
#[derive(Clone, Copy, PartialEq)]
enum Calibration {
    Absent,
    SameBody,
    OtherBody,
}

/// What is surveyed after which calibration, and the error that is asked for, nT rms.
const CASES: [(&str, &str, Calibration, f64); 6] = [
    ("lake", LAKE, Calibration::Absent, 0.2),
    ("sea", SEA, Calibration::Absent, 0.5),
    ("land to lake", LAKE, Calibration::SameBody, 0.5),
    ("land to sea", SEA, Calibration::SameBody, 0.5),
    ("lake, other body's calibration", LAKE, Calibration::OtherBody, 0.5),
    ("sea, other body's calibration", SEA, Calibration::OtherBody, 0.5),
];

/// A preset with four dipoles, each somewhere in a quarter of it.
fn with_iron(preset: &str, seed: u64) -> Scenario {
    let mut draw = ChaCha8Rng::seed_from_u64(seed ^ 0x6c65_7665_6c00_0000);
    let mut scenario = Scenario::parse(preset).unwrap();
    if let Motion::LakeTow { speed_m_per_s, .. } = &mut scenario.motion {
        *speed_m_per_s = Some(2.0);
    }
    for quarter in 0..4 {
        let distance_m = draw.random_range(2.0..12.0);
        let side: f64 = draw.random_range(-1.5..1.5);
        let size = 10.0_f64.powf(draw.random_range(-1.0..2.0));
        let (inclination, declination) = (draw.random_range(-90.0..90.0), draw.random_range(-180.0..180.0));
        let at_s = scenario.duration_s * (f64::from(quarter) + draw.random_range(0.15..0.85)) / 4.0;
        scenario.dipoles.push(DipoleSpec {
            moment_am2: Moment::Size(size),
            inclination_deg: Some(inclination),
            declination_deg: Some(declination),
            at_s: Some(at_s),
            offset_m: Some(distance_m * side.sin()),
            below_m: Some(distance_m * side.cos()),
            latitude_deg: None,
            longitude_deg: None,
            depth_m: None,
        });
    }
    scenario
}

fn record(simulation: &Simulation, path: &Path) {
    let mut bytes = Vec::new();
    simulation.record(&[]).write_csv(&mut bytes).unwrap();
    std::fs::write(path, bytes).unwrap();
}

/// For whoever looks at where the error is.
fn write_truth(truth_nt: &[f64], path: &Path) {
    let rows: String = truth_nt.iter().map(|nt| format!("{nt:.4}\n")).collect();
    std::fs::write(path, format!("field_nT\n{rows}")).unwrap();
}

/// A calibration on land of the tow's body, or of the one that the calibration's own seed draws.
fn calibration(tow: &Simulation, case: Calibration, seed: u64, base: &Path) -> Option<PathBuf> {
    if case == Calibration::Absent {
        return None;
    }
    let mut land = Scenario::parse(LAND).unwrap();
    if case == Calibration::SameBody {
        land.interference.coefficients = Some(*tow.signals().coefficients());
        land.interference.uncompensated_std_nt = None;
    }
    let (file, out) = (base.with_extension("calibration.csv"), base.with_extension("calibration"));
    record(&Simulation::new(&land, seed + 5000).unwrap(), &file);
    Some(calibrated(&file, &out).unwrap())
}

/// Rms of the error, nT, and the share of the rows from 5 minutes on that have a field.
fn error_nt(field_nt: &[f64], truth_nt: &[f64]) -> [f64; 2] {
    assert_eq!(field_nt.len(), truth_nt.len(), "one row of the result a row of the recording");
    let error: Vec<f64> =
        field_nt.iter().zip(truth_nt).map(|(field, truth)| field - truth).skip(SKIPPED_ROWS).collect();
    let present: Vec<f64> = error.iter().copied().filter(|nt| !nt.is_nan()).collect();
    let (level_nt, absent) = (if present.is_empty() { 0.0 } else { mean(&present) }, error.len() - present.len());
    let squares: f64 = present.iter().map(|nt| (nt - level_nt).powi(2)).sum();
    let all = error.len() as f64;
    [((squares + absent as f64 * ABSENT_NT.powi(2)) / all).sqrt(), present.len() as f64 / all]
}

/// Of one seed: the survey's error, the causal error, the share of rows with a field, and the survey's own idea of its error.
fn outcome(folder: &Folder, (name, preset, case, _): (&str, &str, Calibration, f64), seed: u64) -> [f64; 4] {
    let base = folder.file(&format!("{}_{seed}.csv", name.replace([' ', ',', '\''], "_")));
    let simulation = Simulation::new(&with_iron(preset, seed), seed).unwrap();
    record(&simulation, &base);
    let truth_nt = &simulation.signals().rows().field_nt;
    write_truth(truth_nt, &base.with_extension("truth.csv"));
    let coefficients = calibration(&simulation, case, seed, &base);
    let (survey, replay) = (base.with_extension("survey"), base.with_extension("replay"));
    let mut arguments = vec!["replay", text(&base), "--method", "adaptive", "--out", text(&replay)];
    arguments.extend(coefficients.iter().flat_map(|file| ["--coefficients", text(file)]));
    program::run(&arguments).unwrap();
    let causal_nt = CsvFile::read(&replay.join("compensated.csv")).numbers("compensated_nT");
    let [causal, _] = error_nt(&causal_nt, truth_nt);
    if std::env::var_os("SURVEY_TRIAL_CAUSAL_ONLY").is_some() {
        return [f64::NAN, causal, f64::NAN, f64::NAN];
    }
    program::survey(&base, coefficients.as_deref(), &survey).unwrap();
    let levelled = CsvFile::read(&survey.join("levelled.csv"));
    let [desk, present] = error_nt(&levelled.numbers("field_nT"), truth_nt);
    let stated: Vec<f64> =
        levelled.numbers("field_std_nT").into_iter().skip(SKIPPED_ROWS).filter(|nt| !nt.is_nan()).collect();
    [desk, causal, present, mean(&stated.iter().map(|nt| nt * nt).collect::<Vec<_>>()).sqrt()]
}

/// A figure of the root mean square over seeds.
fn figure(what: String, of_seeds: &[f64], most: f64) -> Figure {
    let rms = mean(&of_seeds.iter().map(|x| x * x).collect::<Vec<_>>()).sqrt();
    let (half, worst) = (quantile(of_seeds.to_vec(), 0.5), of_seeds.iter().copied().fold(0.0, f64::max));
    Figure::new(what, [rms, FREE[0], most], format!("{} seeds, median {half:.3}, worst {worst:.3}", of_seeds.len()))
}

#[test]
#[ignore = "minutes, and the survey; see the top of survey_trial.rs"]
fn level() {
    let (folder, mut figures) = (Folder::new("level"), Vec::new());
    for case in CASES {
        let (name, _, _, asked_nt) = case;
        let outcomes: Vec<[f64; 4]> =
            program::seeds(701..721).into_par_iter().map(|seed| outcome(&folder, case, seed)).collect();
        let of = |k: usize| outcomes.iter().map(|outcome| outcome[k]).collect::<Vec<f64>>();
        figures.push(figure(format!("{name}: error of the level, nT rms"), &of(0), asked_nt));
        figures.push(figure(format!("{name}: stated, nT rms"), &of(3), FREE[1]));
        figures.push(figure(format!("{name}: causal, nT rms"), &of(1), 3.0 * asked_nt));
        let rows = quantile(of(2), 0.0);
        figures.push(Figure::new(format!("{name}: rows with a field"), [rows, 0.99, FREE[1]], "least of all seeds"));
    }
    finish("Level", &figures);
}

#[test]
fn a_constant_is_no_error_and_rows_left_out_are() {
    let truth_nt: Vec<f64> = (0..6000).map(|row| (f64::from(row) * 0.01).sin()).collect();
    let mut field_nt: Vec<f64> = truth_nt.iter().map(|nt| nt + 31_000.0).collect();
    field_nt[..SKIPPED_ROWS].fill(0.0);
    assert!(error_nt(&field_nt, &truth_nt)[0] < 1e-9);
    // A step of 2 nT in the middle is 1 nT rms.
    field_nt[4500..].iter_mut().for_each(|nt| *nt += 2.0);
    assert!((error_nt(&field_nt, &truth_nt)[0] - 1.0).abs() < 1e-9);
    field_nt[3000..4500].fill(f64::NAN);
    let [error, present] = error_nt(&field_nt, &truth_nt);
    assert!((error - 50.0_f64.sqrt()).abs() < 1e-9 && (present - 0.5).abs() < 1e-9, "{error}");
}

//! The level against a truth: a body on legs and turns whose interference is written straight from eq. (4).
#![cfg(not(target_os = "none"))]

use nalgebra::{Rotation3, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use towmag_survey::Tow;
use towmag_survey::level::{Coefficients, level};

const FIELD_NT: f64 = 50_000.0;

/// A tow whose truth is known.
struct Made {
    tow: Tow,
    truth_nt: Vec<f64>,
}

/// White noise of variance one, the same every time.
fn noise(rows: usize) -> Vec<f64> {
    StandardNormal.sample_iter(ChaCha8Rng::seed_from_u64(7)).take(rows).collect()
}

/// Legs of two minutes and turns of one by 90 degrees (or none), a swinging body, rock that wanders by 10 nT, noise of 0.03 nT.
/// Without turns it does not swing either.
fn made(rows: usize, turns: bool) -> Made {
    along(rows, &|time_s| direction(time_s, turns, if turns { 1.0 } else { 1e-3 }))
}

/// The same with these directions.
fn along(rows: usize, direction: &dyn Fn(f64) -> Vector3<f64>) -> Made {
    let noise = noise(rows);
    let directions: Vec<Vector3<f64>> = (0..rows).map(|row| direction(0.1 * row as f64)).collect();
    let mut made = Made { tow: Tow::default(), truth_nt: Vec::new() };
    for row in 0..rows {
        let (time_s, c) = (0.1 * row as f64, directions[row]);
        let rate = (directions[(row + 1).min(rows - 1)] - directions[row.saturating_sub(1)]) / 0.2;
        let truth_nt = FIELD_NT + 10.0 * (time_s / 31.0).sin() + 6.0 * (time_s / 17.0 + 1.0).sin();
        made.tow.time_s.push(time_s);
        made.tow.is_usable.push(true);
        made.tow.flux_nt.push((FIELD_NT * c).into());
        made.tow.scalar_nt.push(truth_nt + interference_nt(c, rate) + 0.03 * noise[row]);
        made.truth_nt.push(truth_nt);
    }
    made
}

/// Of the field, 60 degrees down, in the axes of the body.
fn direction(time_s: f64, turns: bool, swings: f64) -> Vector3<f64> {
    let (leg, into) = ((time_s / 180.0).floor(), time_s % 180.0);
    let turn = std::f64::consts::FRAC_PI_2 * (leg + ((into - 120.0) / 60.0).max(0.0));
    let swing =
        |degrees: f64, period_s: f64| swings * degrees.to_radians() * (std::f64::consts::TAU * time_s / period_s).sin();
    let heading = 0.3 + if turns { turn } else { 0.0 } + swing(2.0, 7.3);
    let body = Rotation3::from_euler_angles(swing(3.0, 4.1), swing(2.0, 5.7), heading);
    body.inverse() * Vector3::new(0.5, 0.0, 0.75_f64.sqrt())
}

/// Permanent, induced and eddy part of a body with some steel in it.
fn interference_nt(c: Vector3<f64>, rate: Vector3<f64>) -> f64 {
    let permanent = 40.0 * c.x - 25.0 * c.y + 60.0 * c.z;
    let induced = FIELD_NT * (8e-4 * c.x * c.x - 3e-4 * c.x * c.y + 5e-4 * c.y * c.z + 2e-4 * c.z * c.z);
    permanent + induced + FIELD_NT * (2e-3 * c.x * rate.y - 3e-3 * c.z * rate.x)
}

/// Standard deviation of the error, and its mean, over some rows.
fn error_nt(made: &Made, field_nt: &[f64], rows: std::ops::Range<usize>) -> (f64, f64) {
    let count = rows.len() as f64;
    let mean = rows.clone().map(|row| field_nt[row] - made.truth_nt[row]).sum::<f64>() / count;
    let square = rows.map(|row| (field_nt[row] - made.truth_nt[row] - mean).powi(2)).sum::<f64>() / count;
    (square.sqrt(), mean)
}

#[test]
fn legs_in_all_directions_are_at_one_level() {
    let made = made(9_000, true);
    let raw = error_nt(&made, &made.tow.scalar_nt, 0..9_000);
    let found = level(std::slice::from_ref(&made.tow), None, None, Coefficients::Moving);
    let (error, _) = error_nt(&made, &found.field_nt, 0..9_000);
    assert!(raw.0 > 10.0 && error < 0.15, "{} {error}", raw.0);
    // The mean over the circle is that of the reading, whose legs and turns are as long in each direction.
    let over_circle = |values: &[f64]| values[..7_200].iter().sum::<f64>() / 7_200.0;
    assert!((over_circle(&found.field_nt) - over_circle(&made.tow.scalar_nt)).abs() < 3.0);
    assert!(found.moves.is_empty());
    let stated = found.field_std_nt[4_000];
    assert!(stated > 0.02 && stated < 0.5, "{stated}");
}

#[test]
fn on_one_heading_the_level_is_not_known_and_its_standard_deviation_says_so() {
    let made = made(6_000, false);
    let found = level(std::slice::from_ref(&made.tow), None, None, Coefficients::Moving);
    let stated = found.field_std_nt[3_000];
    assert!(stated > 5.0, "{stated}");
    assert!(error_nt(&made, &found.field_nt, 0..6_000).0 < 1.0);
}

#[test]
fn targets_that_are_known_are_left_as_they_are() {
    let plain = made(9_000, true);
    let mut with = made(9_000, true);
    let anomaly_nt: Vec<f64> =
        (0..9_000).map(|row| 30.0 / (1.0 + ((row as f64 - 4_000.0) / 20.0).powi(2)).powf(2.5)).collect();
    for (row, nt) in anomaly_nt.iter().enumerate() {
        with.tow.scalar_nt[row] += nt;
        let larger = 1.0 + nt / FIELD_NT;
        with.tow.flux_nt[row] = with.tow.flux_nt[row].map(|axis| larger * axis);
    }
    let [plain, with] = [(&plain, vec![0.0; 9_000]), (&with, anomaly_nt.clone())]
        .map(|(made, known)| level(std::slice::from_ref(&made.tow), Some(&known), None, Coefficients::Moving));
    let product = |a: &dyn Fn(usize) -> f64| (3_900..4_100).map(|row| a(row) * anomaly_nt[row]).sum::<f64>();
    let kept = product(&|row| with.field_nt[row] - plain.field_nt[row]) / product(&|row| anomaly_nt[row]);
    assert!((kept - 1.0).abs() < 0.01, "{kept}");
}

/// On one line a body swings by few degrees. Its fluxgate is quiet, and reads a target and the rock as the scalar sensor does.
#[test]
fn nothing_that_a_fluxgate_reads_of_the_field_is_taken_off() {
    let [plain, with] = [0.0, 30.0].map(|peak_nt| {
        let mut made = along(9_000, &|time_s| direction(time_s, false, 1.0));
        let unlike = noise(18_000);
        for row in 0..9_000 {
            let nt = peak_nt / (1.0 + ((row as f64 - 4_000.0) / 20.0).powi(2)).powf(2.5);
            made.tow.scalar_nt[row] += nt;
            made.truth_nt[row] += nt;
            let larger = (made.truth_nt[row] + 0.1 * unlike[9_000 + row]) / FIELD_NT;
            made.tow.flux_nt[row] = made.tow.flux_nt[row].map(|axis| larger * axis);
        }
        made
    });
    let [a, b] = [&plain, &with].map(|made| level(std::slice::from_ref(&made.tow), None, None, Coefficients::Still));
    let target_nt = |row: usize| with.truth_nt[row] - plain.truth_nt[row];
    let product = |x: &dyn Fn(usize) -> f64| (3_900..4_100).map(|row| x(row) * target_nt(row)).sum::<f64>();
    // On one heading a constant is not known.
    let more_nt = |row: usize| b.field_nt[row] - a.field_nt[row];
    let constant_nt = more_nt(1_000);
    let kept = product(&|row| more_nt(row) - constant_nt) / product(&target_nt);
    assert!((0.97..1.03).contains(&kept), "{kept}");
    let error_nt = error_nt(&with, &b.field_nt, 0..9_000).0;
    assert!(error_nt < 0.2, "{error_nt}");
}

#[test]
fn what_is_induced_by_a_field_that_changes_is_taken_off_as_it_is() {
    let mut made = made(9_000, true);
    for row in 0..9_000 {
        // 1,000 nT over some minutes, by which the 40 nT of the strongest induced part change by 0.8 nT.
        let more_nt = 1_000.0 * (row as f64 / 1_000.0).sin();
        let c = Vector3::from(made.tow.flux_nt[row]) / FIELD_NT;
        let rate = Vector3::zeros();
        let permanent_nt = 40.0 * c.x - 25.0 * c.y + 60.0 * c.z;
        let growth_nt = more_nt / FIELD_NT * (interference_nt(c, rate) - permanent_nt);
        made.tow.scalar_nt[row] += more_nt + growth_nt;
        made.truth_nt[row] += more_nt;
        made.tow.flux_nt[row] = made.tow.flux_nt[row].map(|axis| (1.0 + more_nt / FIELD_NT) * axis);
    }
    let found = level(std::slice::from_ref(&made.tow), None, None, Coefficients::Still);
    let error_nt = error_nt(&made, &found.field_nt, 0..9_000).0;
    assert!(error_nt < 0.2, "{error_nt}");
}

#[test]
fn a_strong_target_that_its_dipole_misses_by_a_little_does_not_move_the_level() {
    let mut made = made(9_000, true);
    let anomaly_nt = |nt: f64, width: f64, row: usize| nt / (1.0 + ((row as f64 - 4_000.0) / width).powi(2)).powf(2.5);
    // A thousand nT, and a fit that is three hundredths too wide.
    for row in 0..9_000 {
        let nt = anomaly_nt(1_000.0, 20.0, row);
        made.tow.scalar_nt[row] += nt;
        made.truth_nt[row] += nt;
    }
    let fitted_nt: Vec<f64> = (0..9_000).map(|row| anomaly_nt(1_000.0, 20.6, row)).collect();
    let found = level(std::slice::from_ref(&made.tow), Some(&fitted_nt), None, Coefficients::Moving);
    assert!(error_nt(&made, &found.field_nt, 0..9_000).0 < 0.15, "{}", error_nt(&made, &found.field_nt, 0..9_000).0);
}

/// The sensor is turned in its mount after 600 s.
fn moved(rows: usize) -> Made {
    let mut made = made(rows, true);
    for row in 6_000..rows {
        let c = direction(0.1 * row as f64, true, 1.0);
        made.tow.scalar_nt[row] += 20.0 * c.x - 15.0 * c.y + FIELD_NT * 3e-4 * c.x * c.z;
    }
    made
}

#[test]
fn a_sensor_that_is_moved_is_found_moved() {
    let found = level(&[moved(12_000).tow], None, None, Coefficients::Moving);
    assert!(matches!(found.moves[..], [at] if at.abs_diff(6_000) < 300), "{:?}", found.moves);
}

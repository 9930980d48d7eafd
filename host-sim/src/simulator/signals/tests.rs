//! A small trajectory for the tests of the effects, and tests of the signals themselves.

use super::*;
use crate::simulator::Attitude;

/// Field of the test trajectory, nT, where nothing slow changes it.
pub(crate) const FIELD_NT: f64 = 50_000.0;

/// 60 s at 10 Hz, rocking about all axes at 0.15 to 1 Hz, depth a sine of 0.1 Hz, temperature rising by 1 K a minute.
pub(crate) fn trajectory() -> Trajectory {
    let epochs_s: Vec<f64> = (0..600).map(|k| f64::from(k) * 0.1).collect();
    let grid = Grid { rate_hz: 100.0, start_s: -5.0, len: 7001 };
    Trajectory {
        rate_hz: grid.rate_hz,
        start_s: grid.start_s,
        field_nt: (0..grid.len).map(|k| FIELD_NT + 3.0 * libm::sin(0.05 * grid.time_s(k))).collect(),
        direction: (0..grid.len).map(|k| direction(grid.time_s(k))).collect(),
        first_row_time_s: 100.0,
        depth_m: Some(epochs_s.iter().map(|t| 10.0 + libm::sin(std::f64::consts::TAU * 0.1 * t)).collect()),
        temperature_deg_c: Some(epochs_s.iter().map(|t| 12.0 + t / 60.0).collect()),
        currents_a: vec![("strobe".into(), epochs_s.iter().map(|t| f64::from(t % 2.0 < 0.5)).collect())],
        columns: Vec::new(),
        epochs_s,
    }
}

/// Of the body of the tests, in the units of eq. (4).
fn coefficients() -> [f64; TERMS] {
    let mut coefficients = [0.0; TERMS];
    let some = [20.0, -35.0, 90.0, -0.011, 0.001, 0.005, -0.0014, 0.0009, -0.01, -0.006, -0.0017, 0.0009, 0.0012];
    coefficients[..13].copy_from_slice(&some);
    coefficients
}

pub(crate) fn signals() -> Signals {
    signals_of(trajectory())
}

/// Of the same body on another trajectory.
pub(crate) fn signals_of(trajectory: Trajectory) -> Signals {
    Signals::new(trajectory, coefficients())
}

/// Direction of the field in body axes of the test trajectory, as a function of time.
pub(crate) fn direction(time_s: f64) -> [f64; 3] {
    let sine = |amplitude: f64, hz: f64| amplitude * libm::sin(std::f64::consts::TAU * hz * time_s);
    let attitude = Attitude {
        roll: sine(0.2, 0.15) + sine(0.02, 1.0),
        pitch: sine(0.15, 0.22),
        heading: 0.5 + 0.02 * time_s + sine(0.1, 0.3),
    };
    attitude.to_body([0.48, 0.0, 0.877_268_487_978_452_4])
}

/// A trajectory whose scalar is one sine of amplitude `amplitude_nt`: the first coefficient alone, and `c` in a plane.
pub(crate) fn sine_signals(amplitude_nt: f64, frequency_hz: f64) -> Signals {
    let mut trajectory = trajectory();
    let grid = Grid { rate_hz: trajectory.rate_hz, start_s: trajectory.start_s, len: trajectory.field_nt.len() };
    let turn = std::f64::consts::TAU * frequency_hz;
    trajectory.direction = (0..grid.len)
        .map(|k| {
            let x = libm::sin(turn * grid.time_s(k));
            [0.1 * x, 0.0, (1.0 - 0.01 * x * x).sqrt()]
        })
        .collect();
    trajectory.field_nt.fill(FIELD_NT);
    let mut coefficients = [0.0; TERMS];
    coefficients[0] = 10.0 * amplitude_nt;
    Signals::new(trajectory, coefficients)
}

#[test]
fn the_vector_projects_onto_the_terms_of_eq_4() {
    let signals = signals();
    let beta = signals.coefficients();
    for row in (0..signals.len()).step_by(37) {
        let (f, c, d) =
            (signals.rows().field_nt[row], signals.rows().direction[row], signals.rows().direction_rate[row]);
        let mut sum = beta[0] * c[0] + beta[1] * c[1] + beta[2] * c[2];
        let mut term = 3;
        for i in 0..3 {
            for j in i..3 {
                sum += beta[term] * f * c[i] * c[j];
                term += 1;
            }
        }
        for i in 0..9 {
            sum += beta[9 + i] * f * c[i / 3] * d[i % 3];
        }
        assert!((signals.interference(row).total_nt() - sum).abs() < 1e-9);
    }
}

#[test]
fn rows_and_grid_agree_and_the_derivative_is_the_true_one() {
    let signals = signals();
    for row in (0..signals.len()).step_by(29) {
        let time_s = signals.epochs_s()[row];
        let from_grid_nt = signals.scalar_at(&signals.segments()[0], time_s);
        assert!((from_grid_nt - signals.scalar_at_rows_nt()[row]).abs() < 1e-4);
        let (before, after) = (direction(time_s - 1e-4), direction(time_s + 1e-4));
        for i in 0..3 {
            assert!((signals.rows().direction_rate[row][i] - (after[i] - before[i]) / 2e-4).abs() < 1e-6);
        }
    }
}

#[test]
fn a_gap_parts_the_rows() {
    let mut trajectory = trajectory();
    trajectory.epochs_s.drain(200..260);
    let signals = signals_of(trajectory);
    let [first, second] = signals.segments() else { panic!("{:?}", signals.segments()) };
    assert_eq!((first.epochs.clone(), second.epochs.clone()), (0..200, 200..540));
    assert_eq!(first.span_s, [-5.0, 199.0 * 0.1]);
    assert!((second.span_s[0] - 26.0).abs() < 1e-9 && second.span_s[1] == 65.0);
    let at_edge_nt = signals.scalar_at(second, 26.0);
    assert_eq!(signals.scalar_at(second, 25.0), at_edge_nt);
    assert_eq!(signals.points(second), 3100..7001);
}

/// What `A beta` is made from at a row.
struct AtRow {
    beta: [f64; TERMS],
    field_nt: f64,
    c: [f64; 3],
    rate: [f64; 3],
}

fn at_some_rows() -> Vec<AtRow> {
    let signals = signals();
    let (rows, beta) = (signals.rows(), *signals.coefficients());
    (0..signals.len())
        .step_by(41)
        .map(|row| AtRow { beta, field_nt: rows.field_nt[row], c: rows.direction[row], rate: rows.direction_rate[row] })
        .collect()
}

#[test]
fn the_columns_times_the_coefficients_are_the_interference() {
    for AtRow { beta, field_nt, c, rate } in at_some_rows() {
        let product: f64 =
            tolles_lawson::columns(field_nt, c, rate).iter().zip(beta).map(|(column, beta)| column * beta).sum();
        assert!((product - interference(&beta, field_nt, c, rate).total_nt()).abs() < 1e-9);
    }
}

#[test]
fn the_slopes_are_the_derivatives() {
    let step = 1e-5;
    for AtRow { beta, field_nt, c, rate } in at_some_rows() {
        let slopes = tolles_lawson::slopes(&beta, field_nt, c);
        for i in 0..3 {
            let shifted = |mut vector: [f64; 3], by: f64| {
                vector[i] += by;
                vector
            };
            let of_c = |c| interference(&beta, field_nt, c, [0.0; 3]).total_nt();
            let by_direction = (of_c(shifted(c, step)) - of_c(shifted(c, -step))) / (2.0 * step);
            assert!((slopes.by_direction_nt[i] - by_direction).abs() < 1e-4, "{i}");
            let of_rate = |rate| interference(&beta, field_nt, c, rate).total_nt();
            let by_rate = (of_rate(shifted(rate, step)) - of_rate(shifted(rate, -step))) / (2.0 * step);
            assert!((slopes.by_rate_nt_s[i] - by_rate).abs() < 1e-4, "{i}");
        }
    }
}

/// The two models are written apart and must stay the same model.
#[test]
fn the_core_has_the_same_columns_but_for_its_derivative_and_its_reduced_basis() {
    use towmag::model::{Terms, TermsState};
    let (field_nt, before, after) = (51_000.0, [0.48, 0.6, 0.64], [0.5, 0.5, 0.5_f64.sqrt()]);
    let mut state = TermsState::default();
    let mut step =
        |c: [f64; 3]| Terms::new(10.0).step(&mut state, c.map(|cosine| (field_nt * cosine) as f32), field_nt);
    let _ = step(before);
    let core = step(after).expect("a direction before it");
    let rate = [0, 1, 2].map(|i| 10.0 * (after[i] - before[i]));
    let here = tolles_lawson::columns(field_nt / tolles_lawson::UNIT_FIELD_NT, after, rate);
    // The core has sums over the diagonal in the places of the two zz columns.
    for k in (0..TERMS).filter(|k| ![8, 17].contains(k)) {
        assert!((f64::from(core[k]) - here[k]).abs() < 1e-5, "{k}: {} {}", core[k], here[k]);
    }
}

//! Elastic net, standard deviations and condition number against f64 and nalgebra, on twenty minutes of manoeuvres.

use super::reference::{Batch, FrontEnd, Vector};
use host_sim::simulator::{Scenario, sample_calibration, sample_survey};
use nalgebra::{SMatrix, SymmetricEigen};
use towmag::estimate::{Calibration, CalibrationError, CalibrationResult, ElasticNet, singular_values};
use towmag::model::NT_PER_UNIT;
use towmag::{Epoch, Method, Pipeline, Settings};

fn calibrate(scenario: &Scenario, penalty: ElasticNet) -> (CalibrationResult, Batch, Vec<f64>) {
    let mut core = Calibration::new(&Settings { penalty, ..Settings::default() }).unwrap();
    let (mut front_end, mut batch, mut scalar) = (FrontEnd::default(), Batch::default(), Vec::new());
    for sample in scenario.samples() {
        let _ = core.step(&sample.epoch);
        if let Some(row) = front_end.step(&sample.epoch).filter(|row| row.settled) {
            batch.add(&row.x, row.y);
            scalar.push(row.y);
        }
    }
    (core.solve().unwrap(), batch, scalar)
}

/// Objective of eq. (7), less the constant.
fn objective(batch: &Batch, beta: &Vector, ElasticNet { lambda1, lambda2 }: ElasticNet) -> f64 {
    let size = lambda1 * beta.lp_norm(1) + lambda2 * beta.norm_squared() / 2.0;
    beta.dot(&(batch.gram * beta)) / 2.0 - batch.q.dot(beta) + size
}

#[test]
fn elastic_net_is_the_minimum_for_any_penalty() {
    let scenario = sample_calibration();
    for (lambda1, lambda2) in [(0.0, 0.025), (0.001, 0.025), (100.0, 1.0), (3e3, 0.1), (1e5, 100.0)] {
        let penalty = ElasticNet { lambda1, lambda2 };
        let (result, batch, scalar) = calibrate(&scenario, penalty);
        let beta = Vector::from_row_slice(&result.coefficients.to_paper_units());
        let expected = batch.elastic_net(lambda1, lambda2);
        let zeros = |beta: &Vector| beta.iter().map(|b| *b == 0.0).collect::<Vec<_>>();
        let change = beta - expected;
        let rms_nt = (change.dot(&(batch.gram * change)) / scalar.len() as f64).sqrt();
        assert!(rms_nt < 0.001, "{penalty:?}: {rms_nt} nT");
        let (found, least) = (objective(&batch, &beta, penalty), objective(&batch, &expected, penalty));
        assert!(found <= least + 1e-9 * least.abs(), "{penalty:?}: {found} against {least}");
        // Coordinate descent stops before a coefficient that hardly matters gets to zero; the search does not.
        assert!(zeros(&beta) == zeros(&expected) || found < least, "{penalty:?}: {beta} against {expected}");
    }
}

#[test]
fn a_penalty_above_everything_leaves_nothing() {
    let (result, ..) = calibrate(&sample_calibration(), ElasticNet { lambda1: 1e6, lambda2: 0.025 });
    let permanent_and_eddy = result.coefficients.to_paper_units();
    assert!(permanent_and_eddy[..3].iter().all(|&beta| beta == 0.0), "{permanent_and_eddy:?}");
}

#[test]
fn standard_deviations_and_condition_are_those_of_f64() {
    let (result, batch, scalar) = calibrate(&sample_calibration(), ElasticNet::default());
    let n = scalar.len() as f64;
    let beta = batch.elastic_net(0.001, 0.025);
    let squares: f64 = scalar.iter().map(|y| y * y).sum();
    let rest = squares - 2.0 * batch.q.dot(&beta) + beta.dot(&(batch.gram * beta));
    assert!((result.rms_after_nt - (rest / n).sqrt()).abs() < 1e-3, "{} {}", result.rms_after_nt, (rest / n).sqrt());

    // Residuals that fill 0.1 to 0.9 Hz of the 0 to 5 Hz: 6.25 samples make one.
    let sigma = (rest / (n - 18.0) * 6.25).sqrt();
    let scale = super::reference::Matrix::from_diagonal(&Vector::from_row_slice(&NT_PER_UNIT));
    let penalised = batch.gram + super::reference::Matrix::identity() * 0.025;
    let inverse =
        |k: usize| super::reference::solve(&penalised, &Vector::from_fn(|i, _| if i == k { 1.0 } else { 0.0 }))[k];
    for (k, nt_per_unit) in NT_PER_UNIT.into_iter().enumerate() {
        let expected = sigma * inverse(k).sqrt() * nt_per_unit;
        let relative = f64::from(result.std_nt[k]) / expected - 1.0;
        assert!(relative.abs() < 0.02, "term {k}: {} against {expected}", result.std_nt[k]);
    }
    let unscale = scale.try_inverse().unwrap();
    let values = SymmetricEigen::new(unscale * batch.gram * unscale).eigenvalues;
    let expected = (values.max() / values.min()).sqrt();
    let relative = f64::from(result.condition_number) / expected - 1.0;
    assert!(relative.abs() < 0.02, "{} against {expected}", result.condition_number);
}

#[test]
fn singular_values_are_nalgebras() {
    let matrix = SMatrix::<f32, 18, 18>::from_fn(|i, j| {
        ((i * 31 + j * 17) % 23) as f32 / (1.0 + j as f32) + if i == j { 3.0 } else { 0.0 }
    });
    let ours = singular_values(matrix);
    let matrix = matrix.map(f64::from);
    for (ours, theirs) in ours.iter().zip(matrix.singular_values().iter()) {
        assert!((f64::from(*ours) - theirs).abs() < 1e-5 * matrix.norm(), "{ours} {theirs}");
    }
}

#[test]
fn too_little_data_is_said() {
    let mut core = Calibration::new(&Settings::default()).unwrap();
    for sample in sample_calibration().samples().take(500) {
        let _ = core.step(&sample.epoch);
    }
    let expected = CalibrationError::TooShort { used_epochs: 155, needed_epochs: 200 };
    assert_eq!(core.solve().unwrap_err(), expected);
}

/// What the published method leaves of the shipped survey, and how it compares.
#[test]
fn adapting_beats_standing_still_where_the_body_has_changed() {
    let (result, ..) = calibrate(&sample_calibration(), ElasticNet::default());
    let rms = |method| {
        let mut core = Pipeline::new(&Settings { method, ..Settings::default() }, result.coefficients).unwrap();
        let residuals: Vec<f64> = sample_survey()
            .samples()
            .filter_map(|sample| core.step(&sample.epoch).compensated)
            .map(|compensated| f64::from(compensated.residual_nt))
            .collect();
        (residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64).sqrt()
    };
    let [none, fixed, rls, saddle_point] = [Method::None, Method::Fixed, Method::Rls, Method::SaddlePoint].map(rms);
    println!("none {none:.3}, fixed {fixed:.3}, rls {rls:.3}, saddle-point {saddle_point:.3} nT rms");
    assert!(rls < 0.5 * fixed && saddle_point < 0.5 * fixed && fixed < none);
}

/// A body at rest, for two days: without excitation nothing may decay into infinity.
fn standing_still_does_no_harm(method: Method) {
    let at_rest = |tick: u32| Epoch {
        tick,
        scalar_pt: Some(52_000_000 + (tick % 1009 * 7919 % 101) as i32),
        flux_nt: Some([20_000.0, 3_000.0, 47_900.0]),
    };
    let start = calibrate(&sample_calibration(), ElasticNet::default()).0.coefficients;
    let mut core = Pipeline::new(&Settings { method, ..Settings::default() }, start).unwrap();
    for tick in 0..1_728_000 {
        core.step(&at_rest(tick));
    }
    let before = *core.coefficients();
    assert!(before.to_paper_units().iter().all(|beta| beta.abs() < 1e6), "{method:?}: {before:?}");
    let moved =
        sample_survey().samples().map(|s| Epoch { tick: 1_728_000 + s.epoch.tick, ..s.epoch }).collect::<Vec<_>>();
    let residuals: Vec<f32> =
        moved.iter().filter_map(|epoch| core.step(epoch).compensated).map(|c| c.residual_nt).collect();
    let late = &residuals[4500..];
    let rms = (late.iter().map(|r| r * r).sum::<f32>() / late.len() as f32).sqrt();
    assert!(rms < 1.0, "{method:?} does not come back: {rms} nT");
}

// Side by side: the two days of the bank take longer than any other test of the core.

#[test]
fn standing_still_does_rls_no_harm() {
    standing_still_does_no_harm(Method::Rls);
}

#[test]
fn standing_still_does_saddle_point_no_harm() {
    standing_still_does_no_harm(Method::SaddlePoint);
}

#[test]
fn standing_still_does_adaptive_no_harm() {
    standing_still_does_no_harm(Method::Adaptive);
}

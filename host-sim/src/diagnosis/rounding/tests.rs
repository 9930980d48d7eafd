//! Steps that are known, written with more digits than they have, and values without any.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::stretch::stretches;
use super::*;

const ROWS: usize = 1500;

/// What a rocking sensor reads, nT: a slow swing of `swing_nT`, a faster one, and white noise.
fn readings_nt(swing_nt: f64, noise_nt: f64, draw: &mut ChaCha8Rng) -> Vec<f64> {
    let phase = std::f64::consts::TAU * draw.random::<f64>();
    let reading = |k: usize| {
        let noise: f64 = StandardNormal.sample(draw);
        let time_s = 0.1 * k as f64;
        31_000.0 + swing_nt * (0.1 * time_s + phase).sin() + 0.1 * swing_nt * (5.0 * time_s).sin() + noise_nt * noise
    };
    (0..ROWS).map(reading).collect()
}

/// As a recorder of this step has them, less an offset.
fn rounded_nt(values: &[f64], step_nt: f64, offset_nt: f64) -> Vec<f64> {
    values.iter().map(|nt| (nt / step_nt).round() * step_nt - offset_nt).collect()
}

/// As they are written and read back.
fn written_nt(values: &[f64], decimals: usize) -> Vec<f64> {
    values.iter().map(|nt| format!("{nt:.decimals$}").parse().unwrap()).collect()
}

fn resolution_nt(decimals: usize) -> f64 {
    0.1_f64.powi(decimals as i32)
}

#[test]
fn a_step_is_found_however_many_digits_it_is_written_with() {
    let draw = &mut ChaCha8Rng::seed_from_u64(1);
    for (step_nt, swing_nt, noise_nt) in
        [(0.001, 30.0, 0.03), (0.01, 30.0, 0.05), (0.025, 5.0, 0.03), (0.0915527, 15_000.0, 0.3), (1.5, 15_000.0, 3.0)]
    {
        let clean_nt = readings_nt(swing_nt, noise_nt, draw);
        for decimals in (2..=6).filter(|&decimals| step_nt > 3.0 * resolution_nt(decimals)) {
            for offset_nt in [0.0, 0.37 * step_nt] {
                let values = written_nt(&rounded_nt(&clean_nt, step_nt, offset_nt), decimals);
                let found = Lattice::of(&values, resolution_nt(decimals)).expect("a step");
                assert!((found.step / step_nt - 1.0).abs() < 1e-5, "{step_nt} {decimals}: {found:?}");
                assert!(values.iter().all(|value| found.off(*value) * step_nt < 0.6 * resolution_nt(decimals)));
            }
        }
    }
}

#[test]
fn the_steps_of_a_single_precision_number_of_counts_are_found() {
    let clean_nt = readings_nt(15_000.0, 0.3, &mut ChaCha8Rng::seed_from_u64(2));
    let counts = |nt: &f64| f64::from((nt / 0.091_552_734).round() as f32 * 0.091_552_734_f32);
    let found = Lattice::of(&clean_nt.iter().map(counts).collect::<Vec<_>>(), 1e-9).expect("a step");
    assert!((found.step - 0.091_552_734).abs() < 1e-7, "{found:?}");
}

#[test]
fn a_coarse_step_is_found_beneath_the_finer_one_of_the_recorder() {
    let draw = &mut ChaCha8Rng::seed_from_u64(7);
    for (step_nt, recorder_nt) in [(9.4416, 0.25), (3.2245, 0.25), (1.4858, 0.152_587_9), (2.03, 0.25)] {
        let coarse_nt = rounded_nt(&readings_nt(15_000.0, 0.4, draw), step_nt, 0.0);
        for decimals in [3, 6] {
            let values = written_nt(&rounded_nt(&coarse_nt, recorder_nt, 0.0), decimals);
            let found = Lattice::of(&values, resolution_nt(decimals)).expect("a step");
            assert!((found.step - step_nt).abs() < 5.0 * found.step_error, "{step_nt} {decimals}: {found:?}");
            assert!(found.step_error < 1e-4 * step_nt);
        }
    }
}

#[test]
fn some_damaged_rows_hide_no_step() {
    let draw = &mut ChaCha8Rng::seed_from_u64(3);
    let mut values = rounded_nt(&readings_nt(30.0, 0.05, draw), 0.01, 0.0);
    values.iter_mut().step_by(50).for_each(|value| *value += draw.random::<f64>());
    let found = Lattice::of(&written_nt(&values, 4), 1e-4).expect("a step");
    assert!((found.step - 0.01).abs() < 1e-6, "{found:?}");
}

/// None in 300, so that at 95 % it is below one in 100.
#[test]
fn values_without_a_step_show_none_beyond_that_of_their_digits() {
    let draw = &mut ChaCha8Rng::seed_from_u64(4);
    for swing_nt in [0.3, 30.0, 15_000.0] {
        for decimals in [1, 2, 3, 4, 9] {
            for _ in 0..20 {
                let values = written_nt(&readings_nt(swing_nt, 0.2, draw), decimals);
                let found = Lattice::of(&values, resolution_nt(decimals));
                assert_eq!(found, None, "{swing_nt} {decimals}");
            }
        }
    }
}

#[test]
fn a_change_of_the_export_is_found_where_it_is() {
    let draw = &mut ChaCha8Rng::seed_from_u64(5);
    let clean_nt: Vec<f64> = (0..4).flat_map(|_| readings_nt(30.0, 0.05, draw)).collect();
    let (first, others) = clean_nt.split_at(1730);
    let (second, third) = others.split_at(2000);
    let parts = [rounded_nt(first, 0.01, 0.0), second.to_vec(), rounded_nt(third, 0.05, 0.0)];
    let mut values = written_nt(&parts.concat(), 4);
    values[400..420].fill(f64::NAN);
    let found = stretches(&values, 1e-4);
    let steps: Vec<f64> = found.iter().map(|stretch| (stretch.step * 1e6).round() / 1e6).collect();
    assert_eq!(steps, [0.01, 0.0001, 0.05]);
    let starts: Vec<usize> = found.iter().map(|stretch| stretch.rows.start).collect();
    for (start, expected) in starts.into_iter().zip([0, 1730, 3730]) {
        assert!(start.abs_diff(expected) <= 20, "{start} {expected}");
    }
    assert_eq!(found.last().unwrap().rows.end, 6000);
}

#[test]
fn rounding_adds_a_twelfth_of_the_square_of_the_step_along_the_field() {
    let draw = &mut ChaCha8Rng::seed_from_u64(6);
    let component = |step_nt: f64, draw: &mut ChaCha8Rng| rounded_nt(&readings_nt(2000.0, 0.5, draw), step_nt, 0.0);
    let [x, y, z] = [0.1, 0.1, 0.3].map(|step_nt| written_nt(&component(step_nt, draw), 4));
    let table = Prepared {
        time_s: (0..ROWS).map(|k| 0.1 * k as f64).collect(),
        scalar_nt: written_nt(&rounded_nt(&readings_nt(30.0, 0.05, draw), 0.01, 0.0), 4),
        flux_nt: (0..ROWS).map(|k| [x[k], y[k], z[k]]).collect(),
        usable: vec![true; ROWS],
        flux_resolution_nt: [1e-4; 3],
        scalar_resolution_nt: 1e-4,
        ..Prepared::default()
    };
    let rounding = Rounding::of(&table);
    assert!((rounding.scalar_power_nt2() / (0.0001 / 12.0) - 1.0).abs() < 1e-3);
    // A third of the field is along each.
    let expected_nt2 = (0.01 + 0.01 + 0.09) / 12.0 / 3.0;
    assert!((rounding.fluxgate_power_nt2(&table) / expected_nt2 - 1.0).abs() < 0.1);
    let steps = rounding.scalar_steps_nt();
    assert!(steps.len() == ROWS && (steps[ROWS - 1] - 0.01).abs() < 1e-6);
}

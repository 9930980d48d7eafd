//! What no effect of the library makes is told as such, however long it lasts; and a recording without it stays one without a gap.

use host_sim::diagnosis::{Diagnosis, Verdict};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal, StudentT};

use super::{recorded, said_of};

/// Of the scalar of the preset, nT.
const NOISE_NT: f64 = 0.03;

/// What is said of four minutes of a tow on a lake, with something added to each reading of the scalar, nT.
fn said(seed: u64, mut added_nt: impl FnMut(usize) -> f64) -> Diagnosis {
    let mut table = recorded("lake_tow.toml", Some(seed));
    table.scalar_nt.iter_mut().enumerate().for_each(|(row, nt)| *nt += added_nt(row));
    said_of(&table)
}

fn normal(random: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(random)
}

/// The verdict, and what no effect explains.
fn told(diagnosis: &Diagnosis) -> (Verdict, Vec<&'static str>) {
    (diagnosis.verdict, diagnosis.unexplained.iter().map(|rest| rest.what).collect())
}

#[test]
fn noise_of_any_colour_and_with_heavy_tails_is_no_gap() {
    for seed in 1..3 {
        let random = &mut ChaCha8Rng::seed_from_u64(seed);
        assert_eq!(told(&said(seed, |_| 0.0)).0, Verdict::NoGap, "{seed}");
        let mut red_nt = 0.0;
        let red = said(seed, |_| {
            red_nt = 0.9 * red_nt + 0.5 * NOISE_NT * normal(random);
            red_nt
        });
        assert_eq!(told(&red), (Verdict::NoGap, vec![]), "{seed}");
        let student = StudentT::new(3.5).expect("degrees of freedom");
        let heavy = said(seed, |_| NOISE_NT * student.sample(random));
        assert_eq!(told(&heavy), (Verdict::NoGap, vec![]), "{seed}");
    }
}

#[test]
fn a_cable_that_strums_all_the_time_is_no_noise() {
    for seed in 1..3 {
        let random = &mut ChaCha8Rng::seed_from_u64(seed);
        let (mut last_nt, mut before_nt) = (0.0, 0.0);
        // About 1 Hz, a third of that wide; three times as loud as the noise.
        let (angle, keep) = (std::f64::consts::TAU * 0.1, 0.9_f64);
        let diagnosis = said(seed, |_| {
            let next_nt = 2.0 * keep * angle.cos() * last_nt - keep * keep * before_nt + NOISE_NT * normal(random);
            (last_nt, before_nt) = (next_nt, last_nt);
            next_nt
        });
        let (verdict, rest) = told(&diagnosis);
        assert!(verdict == Verdict::Unknown && rest.contains(&"lines"), "{seed}: {verdict:?} {rest:?}");
    }
}

#[test]
fn noise_in_every_third_row_is_no_jitter_and_a_reading_that_hops_is_no_noise() {
    for seed in 1..3 {
        let random = &mut ChaCha8Rng::seed_from_u64(seed);
        let third = said(seed, |row| if row % 3 == 0 { 4.0 * NOISE_NT * normal(random) } else { 0.0 });
        let (verdict, rest) = told(&third);
        assert!(verdict == Verdict::Unknown && rest.contains(&"rhythm"), "{seed}: {verdict:?} {rest:?}");
        let hops = said(seed, |_| 3.0 * NOISE_NT * normal(random).signum());
        let (verdict, rest) = told(&hops);
        assert!(verdict == Verdict::Unknown && rest.contains(&"levels"), "{seed}: {verdict:?} {rest:?}");
    }
}

#[test]
fn what_a_recorded_column_drives_is_no_noise_in_whatever_shape() {
    for seed in 1..3 {
        let depth_m = recorded("lake_tow.toml", Some(seed)).depth_m.expect("a tow with depth");
        let (least_m, most_m) = depth_m.iter().fold((f64::MAX, f64::MIN), |(a, b), m| (a.min(*m), b.max(*m)));
        let middle_m = 0.5 * (least_m + most_m);
        // As loud as the noise where the body is in the upper half of its way.
        let upper = said(seed, |row| 2.0 * NOISE_NT * f64::from(u8::from(depth_m[row] < middle_m)));
        let (verdict, rest) = told(&upper);
        assert!(verdict == Verdict::Unknown && rest.contains(&"inputs"), "{seed}: {verdict:?} {rest:?}");
    }
}

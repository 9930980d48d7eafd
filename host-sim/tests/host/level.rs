//! The level of `compensated_nT` against the truth of simulated tows: the same scenario without interference and noise.
//! Three seeds; `TOWMAG_LEVEL_SEEDS=20` tries as many, and prints the table of docs/adaptive.md with `--nocapture`.
//!
//! The constants were chosen on seeds 901 to 906 and 2001 to 2006, with other targets, and 3001 to 3020 were looked at; those
//! tried here were not seen.

use std::path::Path;

use host_sim::simulator::scenario::{Scenario, Simulation, TargetSpec};
use towmag::estimate::{Calibration, Prior};
use towmag::model::Coefficients;
use towmag::{Epoch, Pipeline, Settings};

/// The first seed that is tried.
const FIRST_SEED: u64 = 4001;

/// Rows that are left out: five minutes.
const SKIPPED: usize = 3_000;

/// Added to a seed, it makes another body.
const OTHER_BODY: u64 = 5_000;

/// A tow with its truth.
struct Tow {
    epochs: Vec<Epoch>,
    truth_nt: Vec<f64>,
}

fn scenario(name: &str) -> Scenario {
    Scenario::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenarios/{name}.toml"))).unwrap()
}

/// A target of 5 to 15 nT, 1 to 3 s wide, about every 100 s, up and down.
fn targets(duration_s: f64, seed: u64) -> Vec<TargetSpec> {
    // Fractions of multiples of an irrational number lie evenly.
    let fraction = |k: u64| (seed as f64 * 0.754_877_67 + k as f64 * 0.569_840_29).fract();
    let count = (duration_s / 100.0) as u64;
    let target = |k: u64| TargetSpec {
        at_s: 100.0 * k as f64 + 20.0 + 60.0 * fraction(3 * k),
        peak_nt: (5.0 + 10.0 * fraction(3 * k + 1)) * if k.is_multiple_of(2) { 1.0 } else { -1.0 },
        width_s: 1.0 + 2.0 * fraction(3 * k + 2),
    };
    (0..count).map(target).collect()
}

/// The readings of both sensors.
fn record(scenario: &Scenario, seed: u64) -> Vec<Epoch> {
    let simulation = Simulation::new(scenario, seed).unwrap();
    let readings = simulation.record(&[]).readings;
    let epoch = |(tick, (scalar_nt, flux_nt)): (u32, (&f64, &[f64; 3]))| Epoch {
        tick,
        scalar_pt: Some((scalar_nt * 1e3).round() as i32),
        flux_nt: Some(flux_nt.map(|nt| nt as f32)),
    };
    (0..).zip(readings.scalar_nt.iter().zip(&readings.flux_nt)).map(epoch).collect()
}

fn tow(name: &str, seed: u64) -> Tow {
    let scenario = scenario(name);
    let targets = targets(scenario.duration_s, seed);
    tow_with(scenario, targets, seed)
}

fn tow_with(mut scenario: Scenario, targets: Vec<TargetSpec>, seed: u64) -> Tow {
    scenario.targets = targets;
    let epochs = record(&scenario, seed);
    (scenario.interference.coefficients, scenario.interference.uncompensated_std_nt) = (Some([0.0; 18]), None);
    (scenario.scalar.noise_rms_nt, scenario.fluxgate.noise_rms_nt) = (0.0, 0.0);
    let truth_nt = record(&scenario, seed).iter().map(|epoch| f64::from(epoch.scalar_pt.unwrap()) / 1e3).collect();
    Tow { epochs, truth_nt }
}

fn calibrate(epochs: &[Epoch]) -> Prior {
    let mut calibration = Calibration::new(&Settings::default()).unwrap();
    for epoch in epochs {
        _ = calibration.step(epoch);
    }
    calibration.solve().unwrap().prior()
}

/// Error of the compensated field after five minutes, nT rms about its mean.
fn error_nt(tow: &Tow, prior: &Prior) -> f64 {
    let mut pipeline = Pipeline::new(&Settings::default(), *prior).unwrap();
    let error = |(epoch, truth_nt): (&Epoch, &f64)| {
        let compensated = pipeline.step(epoch).compensated?;
        Some(f64::from(compensated.compensated_pt) / 1e3 - truth_nt)
    };
    let errors: Vec<f64> = tow.epochs.iter().zip(&tow.truth_nt).map(error).skip(SKIPPED).flatten().collect();
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    (errors.iter().map(|error| (error - mean) * (error - mean)).sum::<f64>() / n).sqrt()
}

#[test]
fn the_level_is_that_of_the_truth() {
    let seeds = std::env::var("TOWMAG_LEVEL_SEEDS").map_or(3, |seeds| seeds.parse().expect("a number of seeds"));
    let mut squares = [0.0; 3];
    for seed in FIRST_SEED..FIRST_SEED + seeds {
        let (lake, sea) = (tow("lake_tow", seed), tow("sea_tow", seed));
        let land = record(&scenario("land_calibration"), seed + OTHER_BODY);
        let errors_nt = [
            error_nt(&lake, &calibrate(&lake.epochs)),
            error_nt(&sea, &calibrate(&sea.epochs)),
            error_nt(&lake, &calibrate(&land)),
        ];
        println!("seed {seed}: lake {:.2}, sea {:.2}, land to lake {:.2} nT", errors_nt[0], errors_nt[1], errors_nt[2]);
        squares.iter_mut().zip(errors_nt).for_each(|(sum, error_nt)| *sum += error_nt * error_nt / seeds as f64);
    }
    let [lake, sea, land_to_lake] = squares.map(f64::sqrt);
    println!("{seeds} seeds, rms: lake {lake:.2}, sea {sea:.2}, land to lake {land_to_lake:.2} nT");
    assert!(lake <= 0.6 && sea <= 1.5, "lake {lake}, sea {sea} nT");
    assert!(land_to_lake <= 1.5, "land to lake {land_to_lake} nT");
}

/// The body of a tow at sea, calibrated on land, where the field is 7 % stronger: eddy currents grow with it, and nothing is learnt
/// anew.
#[test]
fn a_calibration_holds_where_the_field_is_another() {
    for seed in FIRST_SEED..FIRST_SEED + 2 {
        let sea = tow("sea_tow", seed);
        let mut land = scenario("land_calibration");
        let body = *Simulation::new(&scenario("sea_tow"), seed).unwrap().signals().coefficients();
        (land.interference.coefficients, land.interference.uncompensated_std_nt) = (Some(body), None);
        let error_nt = error_nt(&sea, &calibrate(&record(&land, seed)));
        println!("seed {seed}: land to sea {error_nt:.3} nT");
        assert!(error_nt < 0.2, "seed {seed}: {error_nt} nT");
    }
}

/// A body of which nothing is known turns for the first time, and passes iron meanwhile: the bank takes it for the body's, and
/// its interference goes astray by tens of nT before the turn is over.
#[test]
fn a_target_in_the_first_turn_does_not_move_the_level() {
    for seed in FIRST_SEED..FIRST_SEED + 3 {
        // The turn lasts from 300 to 380 s.
        let target = TargetSpec { at_s: 320.0, peak_nt: 35.0, width_s: 3.0 };
        let [without_nt, error_nt] = [vec![], vec![target]]
            .map(|targets| error_nt(&tow_with(scenario("sea_tow"), targets, seed), &Prior::from(Coefficients::ZERO)));
        println!("seed {seed}: {error_nt:.2} nT with a target in the turn, {without_nt:.2} nT without");
        assert!(error_nt < 1.5, "seed {seed}: {error_nt} nT");
    }
}

/// Compensated field less the reading, by epoch, nT: what is taken off, as it is written.
fn taken_off_nt(tow: &Tow, prior: &Prior) -> Vec<Option<f64>> {
    let mut pipeline = Pipeline::new(&Settings::default(), *prior).unwrap();
    let taken_off = |epoch: &Epoch| {
        let compensated_pt = pipeline.step(epoch).compensated?.compensated_pt;
        Some(f64::from(compensated_pt - epoch.scalar_pt?) / 1e3)
    };
    tow.epochs.iter().map(taken_off).collect()
}

#[test]
fn the_mean_over_a_circle_of_headings_is_that_of_the_reading() {
    let tow = tow("lake_tow", FIRST_SEED);
    let taken_off_nt = taken_off_nt(&tow, &calibrate(&tow.epochs));
    // Four legs of 200 s, each followed by a quarter turn of 60 s.
    let legs_nt = [0, 2_600, 5_200, 7_800].map(|begin| {
        let leg_nt: Vec<f64> = taken_off_nt[begin + 10..begin + 2_000].iter().copied().flatten().collect();
        leg_nt.iter().sum::<f64>() / leg_nt.len() as f64
    });
    let largest_nt = legs_nt.into_iter().map(f64::abs).fold(0.0, f64::max);
    let mean_nt = legs_nt.iter().sum::<f64>() / 4.0;
    println!("taken off by leg: {legs_nt:.1?}, in the mean {mean_nt:.2} nT");
    assert!(mean_nt.abs() < 2.0, "{legs_nt:?}");
    assert!(largest_nt > 10.0, "the headings do not differ, so that the test says nothing: {legs_nt:?}");
}

/// A body of which nothing is known: the level finds its place over hundreds of nT, and no epoch shows it.
#[test]
fn the_level_is_found_without_a_step() {
    let tow = tow("lake_tow", FIRST_SEED);
    let taken_off_nt = taken_off_nt(&tow, &Prior::from(Coefficients::ZERO));
    let error_nt: Vec<f64> = (tow.epochs.iter().zip(&tow.truth_nt).zip(&taken_off_nt))
        .filter_map(|((epoch, truth_nt), taken_off_nt)| {
            Some(f64::from(epoch.scalar_pt?) / 1e3 + (*taken_off_nt)? - truth_nt)
        })
        .collect();
    let step_nt = error_nt.windows(2).skip(1_000).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    let (least_nt, most_nt) = error_nt.iter().fold((f64::MAX, f64::MIN), |(a, b), &e| (a.min(e), b.max(e)));
    println!("error from {least_nt:.0} to {most_nt:.0} nT, at most {step_nt:.2} nT from an epoch to the next");
    assert!(most_nt - least_nt > 50.0 && step_nt < 3.0, "{least_nt} to {most_nt} nT, {step_nt} nT");
}

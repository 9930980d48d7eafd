//! What is far louder than the noise: bodies of more than a hundred nT, which leave of the smoothest model more than a scalar's noise, and
//! a scalar that is blind.

use host_sim::diagnosis::{Prepared, Verdict};
use host_sim::simulator::scenario::{Scenario, Simulation};

use super::{names, requests, said_of};
use crate::common::of_repository;

/// Eight minutes of a tow on a lake of a body of so many nT, with these noises of scalar and fluxgate, nT rms.
fn recorded(seed: u64, body_nt: f64, [scalar_nt, fluxgate_nt]: [f64; 2], effects: &[&str]) -> Prepared {
    let path = of_repository("scenarios/lake_tow.toml");
    let mut scenario = Scenario { duration_s: 480.0, ..Scenario::read(&path).expect("a scenario of this repository") };
    scenario.interference.uncompensated_std_nt = Some(body_nt);
    (scenario.scalar.noise_rms_nt, scenario.fluxgate.noise_rms_nt) = (scalar_nt, fluxgate_nt);
    let simulation = Simulation::new(&scenario, seed).expect("a good scenario");
    Prepared::of_simulation(&simulation, &requests(effects), "simulated", &[]).expect("a recording")
}

/// It leaves a hundred-thousandth of its power, which goes with the attitude's history beyond all doubt, as the delay does.
#[test]
fn a_long_delay_is_named_whatever_its_imperfection_leaves() {
    for (seed, effect) in [(2, "scalar_lag:lag_s=0.4"), (2, "averaging_window:window_s=0.9")] {
        let told = said_of(&recorded(seed, 120.0, [0.03, 0.5], &[effect]));
        let name = effect.split(':').next().expect("a name");
        assert_eq!((told.verdict, names(&told)), (Verdict::Explained, vec![name]), "{seed} {effect}");
    }
}

/// Through the 18 terms it is as loud as the scalar's own, and ends at the frequency where the smoothing of the direction does.
#[test]
fn noise_of_the_fluxgate_is_no_tone() {
    for seed in [1, 2] {
        let told = said_of(&recorded(seed, 120.0, [0.01, 2.0], &[]));
        assert_eq!((told.verdict, names(&told)), (Verdict::NoGap, Vec::new()), "{seed}");
    }
}

/// A sensor of 5 pT that gives noise of 30 nT where it is blind: six thousand times its own.
#[test]
fn a_dead_zone_far_louder_than_the_noise_is_named() {
    let zone = "dead_zone:axis_azimuth_deg=-116,axis_elevation_deg=57.6,half_angle_deg=12,noise_nT=30";
    let told = said_of(&recorded(5, 14.0, [0.005, 0.5], &[zone]));
    assert_eq!((told.verdict, names(&told)), (Verdict::Explained, vec!["dead_zone"]));
    let noise = told.effects[0].parameters.iter().find(|parameter| parameter.name == "noise_nT").expect("its noise");
    let [low, high] = noise.ci95.expect("an interval");
    assert!((low..=high).contains(&30.0), "{low} {high}");
}

//! Bodies of more than a hundred nT: what they leave of the smoothest model is far above the noise of a scalar, and no finding by itself.

use host_sim::diagnosis::{Prepared, Verdict};
use host_sim::simulator::scenario::{Scenario, Simulation};

use super::{names, requests, said_of};
use crate::common::of_repository;

/// Eight minutes of a tow on a lake of a body of 120 nT, with these noises of scalar and fluxgate, nT rms.
fn recorded(seed: u64, [scalar_nt, fluxgate_nt]: [f64; 2], effects: &[&str]) -> Prepared {
    let path = of_repository("scenarios/lake_tow.toml");
    let mut scenario = Scenario { duration_s: 480.0, ..Scenario::read(&path).expect("a scenario of this repository") };
    scenario.interference.uncompensated_std_nt = Some(120.0);
    (scenario.scalar.noise_rms_nt, scenario.fluxgate.noise_rms_nt) = (scalar_nt, fluxgate_nt);
    let simulation = Simulation::new(&scenario, seed).expect("a good scenario");
    Prepared::of_simulation(&simulation, &requests(effects), "simulated", &[]).expect("a recording")
}

/// It leaves a hundred-thousandth of its power, which goes with the attitude's history beyond all doubt, as the delay does.
#[test]
fn a_long_delay_is_named_whatever_its_imperfection_leaves() {
    for (seed, effect) in [(2, "scalar_lag:lag_s=0.4"), (2, "averaging_window:window_s=0.9")] {
        let told = said_of(&recorded(seed, [0.03, 0.5], &[effect]));
        let name = effect.split(':').next().expect("a name");
        assert_eq!((told.verdict, names(&told)), (Verdict::Explained, vec![name]), "{seed} {effect}");
    }
}

/// Through the 18 terms it is as loud as the scalar's own, and ends at the frequency where the smoothing of the direction does.
#[test]
fn noise_of_the_fluxgate_is_no_tone() {
    for seed in [1, 2] {
        let told = said_of(&recorded(seed, [0.01, 2.0], &[]));
        assert_eq!((told.verdict, names(&told)), (Verdict::NoGap, Vec::new()), "{seed}");
    }
}

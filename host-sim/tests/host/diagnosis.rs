//! What a diagnosis says of four minutes of a preset, called as a library.

mod clean;
mod loads;
mod loud;
mod own;
mod planned;
mod steps;
mod unknown;
mod withheld;

use host_sim::diagnosis::{DiagnoseSettings, Diagnosis, Prepared, diagnose};
use host_sim::effects::Request;
use host_sim::simulator::scenario::{Scenario, Simulation};

use crate::common::of_repository;

/// Four minutes of a preset, from a seed or else the preset's own.
fn simulation(preset: &str, seed: Option<u64>) -> Simulation {
    let path = of_repository(&format!("scenarios/{preset}"));
    let scenario = Scenario { duration_s: 240.0, ..Scenario::read(&path).expect("a scenario of this repository") };
    Simulation::new(&scenario, seed.unwrap_or(scenario.seed)).expect("a good scenario")
}

fn requests(effects: &[&str]) -> Vec<Request> {
    effects.iter().map(|text| text.parse().expect("an effect")).collect()
}

/// A recording of it, with nothing in it but noise.
fn recorded(preset: &str, seed: Option<u64>) -> Prepared {
    recorded_with(preset, seed, &[])
}

/// The same with some effects, as `--effect` has them.
fn recorded_with(preset: &str, seed: Option<u64>, effects: &[&str]) -> Prepared {
    let simulation = simulation(preset, seed);
    Prepared::of_simulation(&simulation, &requests(effects), "simulated", &[]).expect("a recording")
}

/// What is said of it with the whole library.
fn said_of(table: &Prepared) -> Diagnosis {
    diagnose(table, None, &DiagnoseSettings::default()).expect("long enough")
}

fn names(diagnosis: &Diagnosis) -> Vec<&'static str> {
    diagnosis.effects.iter().map(|effect| effect.name).collect()
}

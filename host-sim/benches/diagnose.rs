//! How `diagnose` grows with the length of a recording and with the number of effects in it.
//!
//! `cargo bench --bench diagnose` prints seconds; all cores are used.

use std::path::Path;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use host_sim::diagnosis::{DiagnoseSettings, Prepared, diagnose};
use host_sim::effects::Request;
use host_sim::simulator::scenario::{Scenario, Simulation};

/// One after the other is put in: of different kinds, each well above the noise.
const EFFECTS: [&str; 3] = [
    "scalar_lag:lag_s=0.02",
    "depth_gradient:gradient_nT_per_m=0.3",
    "mains_alias:frequency_hz=1.7,amplitude_nT=0.2,phase_rad=0.3",
];

fn length(c: &mut Criterion) {
    let mut group = c.benchmark_group("diagnose, one effect");
    // An hour takes so long that only few are measured.
    group.sample_size(10).warm_up_time(Duration::from_millis(1)).measurement_time(Duration::from_secs(1));
    for minutes in [5, 10, 20, 60] {
        let table = recorded(minutes, 1);
        group.bench_with_input(BenchmarkId::new("minutes", minutes), &table, |bencher, table| {
            bencher.iter(|| diagnosed(table, 1));
        });
    }
    group.finish();
}

fn effects(c: &mut Criterion) {
    let mut group = c.benchmark_group("diagnose, 10 minutes");
    group.sample_size(10).warm_up_time(Duration::from_millis(1)).measurement_time(Duration::from_secs(1));
    for count in 0..=EFFECTS.len() {
        let table = recorded(10, count);
        group.bench_with_input(BenchmarkId::new("effects", count), &table, |bencher, table| {
            bencher.iter(|| diagnosed(table, count));
        });
    }
    group.finish();
}

/// The tow on a lake, so many minutes long, with so many effects, as `diagnose` reads it.
fn recorded(minutes: u32, effects: usize) -> Prepared {
    let preset = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/lake_tow.toml");
    let preset = Scenario::read(&preset).expect("a scenario of this repository");
    let scenario = Scenario { duration_s: 60.0 * f64::from(minutes), ..preset };
    let simulation = Simulation::new(&scenario, scenario.seed).expect("a good scenario");
    let requests: Vec<Request> = EFFECTS[..effects].iter().map(|text| text.parse().expect("an effect")).collect();
    Prepared::of_simulation(&simulation, &requests, "simulated", &[]).expect("a recording")
}

/// What is measured is only worth it where the effects are found.
fn diagnosed(table: &Prepared, effects: usize) {
    let diagnosis = diagnose(table, None, &DiagnoseSettings::default()).expect("long enough");
    assert_eq!(diagnosis.effects.len(), effects);
}

criterion_group!(benches, length, effects);
criterion_main!(benches);

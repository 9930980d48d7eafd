//! Speed of the core and of `replay`, beside the plain way to do the same: eq. (16) solved directly in f64, per epoch.
//!
//! `cargo bench` prints epochs (or rows) per second of each. One core is used.

use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use host_sim::command;
use host_sim::simulator::{Scenario, sample_survey};
use nalgebra::{Cholesky, SMatrix, SVector};
use towmag::model::{Coefficients, Row};
use towmag::{Epoch, Method, Pipeline, Settings};
use towmag::{FrontEnd, FrontEndState};

const CORE_EPOCHS: usize = 6_000;
const REPLAY_ROWS: u32 = 100_000;

fn core(c: &mut Criterion) {
    let epochs: Vec<Epoch> = sample_survey().samples().take(CORE_EPOCHS).map(|sample| sample.epoch).collect();
    let mut group = c.benchmark_group("core");
    group.throughput(Throughput::Elements(CORE_EPOCHS as u64));
    let methods = [Method::Fixed, Method::Rls, Method::SaddlePoint, Method::Adaptive];
    for (name, method) in ["fixed", "rls", "saddle-point", "adaptive"].into_iter().zip(methods) {
        let fresh = Pipeline::new(&Settings { method, ..Settings::default() }, Coefficients::ZERO).expect("defaults");
        group.bench_function(name, |bencher| {
            bencher.iter_batched(
                || fresh.clone(),
                |mut pipeline| epochs.iter().for_each(|epoch| _ = black_box(pipeline.step(epoch))),
                BatchSize::LargeInput,
            );
        });
    }
    let rows = band_passed(&epochs);
    group.throughput(Throughput::Elements(rows.len() as u64));
    group.bench_function("f64 direct solve of eq. (16)", |bencher| bencher.iter(|| direct(&rows)));
    group.finish();
}

fn band_passed(epochs: &[Epoch]) -> Vec<Row> {
    let front_end = FrontEnd::new(Settings::default().band_pass).expect("defaults");
    let mut state = FrontEndState::default();
    epochs.iter().filter_map(|epoch| front_end.step(&mut state, epoch).ok()).map(|seen| seen.band_passed).collect()
}

/// The normal equations with forgetting, solved by Cholesky at every epoch; band-pass and terms not counted.
fn direct(rows: &[Row]) -> SVector<f64, 18> {
    let identity = SMatrix::<f64, 18, 18>::identity();
    let (mut gram, mut q, mut beta) = (identity * 0.025, SVector::<f64, 18>::zeros(), SVector::<f64, 18>::zeros());
    for row in rows {
        let x = SVector::<f64, 18>::from_iterator(row.terms.iter().map(|&x| f64::from(x)));
        gram = gram * 0.9999 + x * x.transpose() + identity * (1e-4 * 0.025);
        q = q * 0.9999 + x * f64::from(row.scalar_nt);
        beta = Cholesky::new(gram).map_or(beta, |cholesky| cholesky.solve(&q));
        black_box(&beta);
    }
    beta
}

fn replay(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let recording = folder.path().join("survey.csv");
    let scenario = Scenario { duration_s: f64::from(REPLAY_ROWS) / 10.0, ..sample_survey() };
    std::fs::write(&recording, command::recording(&scenario)).expect("room for a recording");
    let settings = Settings::default();
    let out = folder.path().join("out");
    let mut group = c.benchmark_group("replay");
    group.throughput(Throughput::Elements(u64::from(REPLAY_ROWS))).sample_size(10);
    group.bench_function("CSV to CSV and report, adaptive", |bencher| {
        bencher.iter(|| command::replay(&recording, None, &out, &settings).expect("a good recording"));
    });
    group.finish();
}

criterion_group!(benches, core, replay);
criterion_main!(benches);

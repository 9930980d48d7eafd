//! The null distribution of the search on a recording's own design, by parametric bootstrap: noise of the fitted spectrum is drawn
//! in the place of what was read, and everything is looked for in it. The analytic chances with their trials factors are held
//! against it.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use towmag::model::TERMS;
use towmag_fourier::Complex;

use super::DiagnoseSettings;
use super::simulated::recorded;
use crate::diagnosis::noise::spectrum::NoiseSpectrum;
use crate::diagnosis::null::omnibus::tests;
use crate::diagnosis::policy::RATE_HZ;
use crate::diagnosis::recording::Recording;
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::search::GlrtTable;
use crate::diagnosis::selection::Selection;

/// Chances at which what was met is counted.
const LEVELS: [f64; 3] = [0.1, 0.01, 0.001];

/// One realisation over the rows, nT.
fn draw(spectrum: &NoiseSpectrum, rows: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
    let n = 2 * rows;
    let mut values: Vec<Complex<f64>> = (0..n)
        .map(|k| {
            let power = spectrum.at(k.min(n - k) as f64 * RATE_HZ / n as f64) * RATE_HZ / n as f64;
            let normal = |random: &mut ChaCha8Rng| -> f64 { StandardNormal.sample(random) };
            Complex::new(normal(random), normal(random)) * (0.5 * power).sqrt()
        })
        .collect();
    towmag_fourier::inverse(n).process(&mut values);
    values[..rows].iter().map(|value| value.re).collect()
}

/// Chances, by effect and test, of one draw in the place of the reading.
fn chances(selection: &Selection<'_>, recording: &Recording<'_>, random: &mut ChaCha8Rng) -> Vec<(&'static str, f64)> {
    let (problem, noise) = (&selection.problem, &selection.noise);
    let reading_nt = draw(noise.spectrum.as_ref().expect("long enough"), problem.signals.len(), random);
    let signals = (*problem.signals).clone();
    let drawn = RegressionProblem::new(problem.library, problem.channel, signals, reading_nt, noise.whitening.clone());
    let fit = drawn.fit(&[]);
    let of_effects: Vec<(&'static str, f64)> = GlrtTable::of(&drawn, &fit, &[])
        .into_rows()
        .map(|candidate| (problem.library[candidate.term.effect].spec().name, candidate.log_p(1.0).min(0.0).exp()))
        .collect();
    let drawn = Selection {
        before: fit.clone(),
        fit,
        problem: drawn,
        noise: noise.clone(),
        accepted: Vec::new(),
        last_scan: Vec::new(),
        variance: 1.0,
        sensor_variance: 1.0,
        allowed: Vec::new(),
        is_cut_short: false,
    };
    let of_tests = tests(&drawn, Some(&recording.direction_noise), recording.table);
    let of_tests = of_tests.into_iter().map(|finding| (finding.what, finding.log_p.min(0.0).exp()));
    of_effects.into_iter().chain(of_tests).collect()
}

/// How often each chance was met, in some draws on the design of a preset, in both channels.
fn met(preset: &str, draws: u64) -> BTreeMap<&'static str, [u64; 3]> {
    let (table, settings) = (recorded(preset), DiagnoseSettings::default());
    let recording = Recording::of(&table, [0.0; TERMS]);
    let library = settings.library.applicable_to(&recording.start);
    let found = recording.findings(&library, &settings, &|_| {});
    let mut met: BTreeMap<&'static str, [u64; 3]> = BTreeMap::new();
    for channel in found.channels() {
        for seed in 0..draws {
            for (name, chance) in chances(&channel.selection, &recording, &mut ChaCha8Rng::seed_from_u64(seed)) {
                let counts = met.entry(name).or_default();
                counts.iter_mut().zip(LEVELS).for_each(|(count, level)| *count += u64::from(chance <= level));
            }
        }
    }
    met
}

/// A chance that is met so often in so many draws is too low: once in a thousand such tests if it is right.
fn most(draws: u64, level: f64) -> u64 {
    let expected = draws as f64 * level;
    (expected + 3.1 * expected.sqrt() + 1.5).ceil() as u64
}

#[test]
fn noise_meets_a_chance_no_more_often_than_it_says() {
    let draws = 24;
    let library = DiagnoseSettings::default().library;
    for (name, counts) in met("lake_tow.toml", draws) {
        // An effect is one channel's; the tests of what is left see both.
        let draws = if library.specs().any(|spec| spec.name == name) { draws } else { 2 * draws };
        for (count, level) in counts.into_iter().zip(LEVELS) {
            assert!(count <= most(draws, level), "{name}: {count} of {draws} at {level}");
        }
    }
}

#[test]
#[ignore = "minutes: prints what the trials factors are held against"]
fn table_of_the_null() {
    let draws = 400;
    for preset in ["lake_tow.toml", "land_calibration.toml"] {
        println!("{preset}: met in {draws} draws at a chance of {LEVELS:?}");
        for (name, counts) in met(preset, draws) {
            println!("{name:28} {counts:?}");
        }
    }
}

//! Effects that the library does not have: described by what drives them, and not by pieces that other effects make of them.

use host_sim::diagnosis::{Description, DiagnoseSettings, Diagnosis, diagnose};

use super::recorded_with;

/// What is said of four minutes of a preset with an effect that is taken out of the library.
fn said(preset: &str, seed: u64, effect: &str) -> Diagnosis {
    let name = effect.split(':').next().expect("a name");
    let settings = DiagnoseSettings { withheld: vec![name.into()], ..DiagnoseSettings::default() };
    diagnose(&recorded_with(preset, Some(seed), &[effect]), None, &settings).expect("long enough")
}

/// The input that comes first, and the share that a proposal of it closes.
fn driver(diagnosis: &Diagnosis) -> (&str, Option<f64>) {
    let Description { drivers, gap_closed, .. } = diagnosis.description.as_ref().expect("a rest");
    (&drivers[0].input, gap_closed.map(|closed| closed.fraction))
}

#[test]
fn a_bias_of_the_fluxgate_is_no_pieces_of_other_faults() {
    // Skewed axes and a nonlinearity make most of it on these headings, and leave a rest.
    let told = said("land_calibration.toml", 1, "fluxgate_bias:x_nT=-16,y_nT=4,z_nT=-15");
    let names: Vec<&str> = told.effects.iter().map(|effect| effect.name).collect();
    let (input, closed) = driver(&told);
    assert_eq!((names, input), (vec![], "attitude"));
    assert!(closed.is_some_and(|closed| closed > 0.9), "{closed:?}");
}

#[test]
fn a_bias_of_the_fluxgate_that_drifts_follows_the_temperature() {
    let told = said("lake_tow.toml", 3, "fluxgate_temperature_drift:x_nT_per_K=4,y_nT_per_K=-3,z_nT_per_K=2");
    let (input, closed) = driver(&told);
    assert_eq!(input, "temperature");
    assert!(closed.is_some_and(|closed| closed > 0.7), "{closed:?}");
}

#[test]
fn a_clock_that_drifts_follows_time() {
    let told = said("sea_tow.toml", 1, "clock_drift:rate_ppm=150");
    assert_eq!(driver(&told).0, "time_irregular");
}

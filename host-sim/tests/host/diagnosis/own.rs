//! A recording held against a simulation of the user's own: the offset of its clock is found, and what is said is what would be said
//! of the recording by itself; what the simulation has too is no gap.

use host_sim::diagnosis::{DiagnoseSettings, Diagnosis, OwnSimulation, Prepared, SimulatedTrack, Verdict, diagnose};
use host_sim::effects::no_draw;
use host_sim::simulator::signals::Grid;

use super::{names, recorded_with, requests, said_of, simulation};

/// Of the simulation's clock, s.
const OFFSET_S: f64 = 12.3456;
/// Motion, body and noise of the recording; the simulation has no noise.
const SEED: u64 = 33;
/// Rows of the simulation in a second.
const RATES_HZ: [f64; 4] = [16.0, 50.0, 10.0, 25.0];

/// A preset without noise, as another program would write it: from some 5 s after the start on, between two rows, at another rate and by another clock; with
/// some effects, whose change is told at the rows of the preset and put between them by cubics.
fn simulated(preset: &str, effects: &[&str], rate_hz: f64) -> SimulatedTrack {
    let simulation = simulation(preset, Some(SEED));
    let (signals, trajectory) = (simulation.signals(), simulation.signals().trajectory());
    let mut scalar_nt = signals.scalar_nt().to_vec();
    for request in requests(effects) {
        let change = request.effect.change(signals, &request.parameters, &mut no_draw());
        let rows = Grid { rate_hz: 10.0, start_s: 0.0, len: signals.len() };
        let dense = (0..scalar_nt.len()).map(|point| rows.at(&change.scalar_nt, signals.grid().time_s(point)));
        scalar_nt.iter_mut().zip(dense.collect::<Vec<_>>()).for_each(|(nt, more)| *nt += more);
    }
    let times_s: Vec<f64> = (0..(230.0 * rate_hz) as u32).map(|row| 5.0375 + f64::from(row) / rate_hz).collect();
    let flux_nt = |&time_s: &f64| {
        let direction = signals.grid().vector_at(&trajectory.direction, time_s);
        let field_nt = signals.grid().at(&trajectory.field_nt, time_s);
        direction.map(|c| field_nt * c)
    };
    SimulatedTrack {
        file: "own.csv".into(),
        time_s: times_s.iter().map(|time_s| time_s + trajectory.first_row_time_s + OFFSET_S).collect(),
        scalar_nt: times_s.iter().map(|&time_s| signals.grid().at(&scalar_nt, time_s)).collect(),
        flux_nt: times_s.iter().map(flux_nt).collect(),
    }
}

fn held_against(effects: &[&str], of_simulation: &[&str], holds_terms: bool) -> Diagnosis {
    let table = recorded_with("land_calibration.toml", Some(SEED), effects);
    held(&table, simulated("land_calibration.toml", of_simulation, RATES_HZ[0]), holds_terms)
}

fn held(table: &Prepared, track: SimulatedTrack, holds_terms: bool) -> Diagnosis {
    let simulation = Some(OwnSimulation { track, holds_terms });
    diagnose(table, None, &DiagnoseSettings { simulation, ..DiagnoseSettings::default() }).expect("long enough")
}

const ON_LAND: [&str; 12] = [
    "scalar_lag:lag_s=0.02",
    "fluxgate_bias:x_nT=60,y_nT=-40,z_nT=30",
    "load_current:x_nT=1,y_nT=0.7,z_nT=-0.6,period_s=11,duty=0.3,phase=0.2",
    "clock_drift:rate_ppm=60",
    "scalar_lowpass:time_constant_s=0.03",
    "heading_error:axis_azimuth_deg=20,axis_elevation_deg=10,cubic_nT=20,quartic_nT=-12",
    "mains_alias:frequency_hz=0.7,amplitude_nT=0.3,phase_rad=1",
    "fluxgate_scale:x_ppm=2000,y_ppm=-1500,z_ppm=-500",
    "fluxgate_nonorthogonality:xy_mrad=2,xz_mrad=-1,yz_mrad=1",
    "permanent_step:time_s=120,x_nT=6,y_nT=-4,z_nT=5",
    "eddy_lag:time_constant_s=0.03",
    "sample_jitter:sigma_s=0.01",
];

const ON_LAKE: [&str; 12] = [
    "scalar_lag:lag_s=0.03",
    "heading_error:axis_azimuth_deg=30,axis_elevation_deg=40,cubic_nT=8,quartic_nT=4",
    "fluxgate_bias:x_nT=20,y_nT=-15,z_nT=30",
    "depth_gradient:gradient_nT_per_m=0.5",
    "clock_drift:rate_ppm=100",
    "sample_slip:time_s=100,samples=1",
    "mains_alias:frequency_hz=0.7,amplitude_nT=0.1,phase_rad=1",
    "fluxgate_scale:x_ppm=500,y_ppm=-400,z_ppm=-100",
    "fluxgate_nonorthogonality:xy_mrad=1,xz_mrad=-0.8,yz_mrad=0.6",
    "permanent_step:time_s=150,x_nT=3,y_nT=-4,z_nT=5",
    "swell_induction:gain_nT_per_m=0.5",
    "averaging_window:window_s=0.2",
];

/// By how much an offset is off with an effect in the recording alone, s, and whether the verdict is that without the simulation.
fn of_effect(preset: &str, effect: &str, rate_hz: f64) -> (f64, bool) {
    let table = recorded_with(preset, Some(SEED), &[effect]);
    let alone = said_of(&table);
    let with = held(&table, simulated(preset, &[], rate_hz), false);
    let off_s = with.simulation.as_ref().expect("told").offset_s - OFFSET_S;
    let (told, told_alone) = ((with.verdict, names(&with)), (alone.verdict, names(&alone)));
    println!("{preset} {effect}, {rate_hz} Hz: {told:?}, alone {told_alone:?}, offset off by {:.3} ms", 1e3 * off_s);
    (off_s, told == told_alone)
}

#[test]
fn with_effects_in_the_recording_alone_the_verdict_is_the_same_and_the_offset_is_found() {
    for (effect, rate_hz) in ON_LAND[..3].iter().zip(RATES_HZ) {
        let (off_s, is_same) = of_effect("land_calibration.toml", effect, rate_hz);
        assert!(is_same && off_s.abs() < 0.005, "{effect}: {off_s}");
    }
}

#[test]
#[ignore = "all effects: a minute"]
fn own_simulation_with_twelve_effects_each() {
    for (preset, effects) in [("land_calibration.toml", ON_LAND), ("lake_tow.toml", ON_LAKE)] {
        let rates_hz = RATES_HZ.into_iter().cycle();
        let told: Vec<(f64, bool)> =
            effects.iter().zip(rates_hz).map(|(effect, hz)| of_effect(preset, effect, hz)).collect();
        let largest_s = told.iter().map(|(off_s, _)| off_s.abs()).fold(0.0, f64::max);
        println!(
            "{preset}: {} of 12 the same; offset off by {:.3} ms at most",
            told.iter().filter(|told| told.1).count(),
            1e3 * largest_s
        );
        assert!(largest_s < 0.005);
    }
}

#[test]
fn what_the_simulation_has_too_is_no_gap() {
    let heading_error = "heading_error:axis_azimuth_deg=20,axis_elevation_deg=10,cubic_nT=20,quartic_nT=-12";
    assert_eq!(names(&held_against(&[heading_error], &[], false)), ["heading_error"]);
    let both = held_against(&[heading_error], &[heading_error], false);
    assert_eq!((both.verdict, names(&both)), (Verdict::NoGap, vec![]));
    assert!(both.simulation.expect("told").beyond_nt.is_some());
}

#[test]
fn held_terms_make_a_gap_of_what_a_refit_would_swallow() {
    // Linear in the field's direction: within the span of the 18 terms.
    let clean = held_against(&[], &[], true);
    assert_eq!((clean.verdict, names(&clean)), (Verdict::NoGap, vec![]));
    let swallowed = "permanent_step:time_s=0.05,x_nT=6,y_nT=-4,z_nT=5";
    assert_eq!(held_against(&[swallowed], &[], false).verdict, Verdict::NoGap);
    assert_ne!(held_against(&[swallowed], &[], true).verdict, Verdict::NoGap);
}

#[test]
fn a_simulation_of_another_track_is_refused() {
    let table = recorded_with("land_calibration.toml", Some(SEED), &[]);
    let mut track = simulated("lake_tow.toml", &[], RATES_HZ[0]);
    track.file = "other.csv".into();
    let simulation = Some(OwnSimulation { track, holds_terms: false });
    let refused = diagnose(&table, None, &DiagnoseSettings { simulation, ..DiagnoseSettings::default() });
    let text = refused.expect_err("refused").to_string();
    assert!(text.contains("other.csv") && text.contains("same track"), "{text}");
}

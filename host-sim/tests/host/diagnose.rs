//! `host-sim diagnose` as a user runs it, on recordings that `simulate` makes.

mod targets;

use std::path::Path;

use crate::common::{done, preset_of, refused, text};
use serde_json::Value;
use tempfile::TempDir;

/// The land preset, of four minutes in place of ten, with as many headings.
fn short_land() -> String {
    let preset = preset_of("land_calibration.toml", 240.0);
    assert!(preset.contains("leg_s = 80.0"));
    preset.replace("leg_s = 80.0", "leg_s = 40.0")
}

/// A recording of the short land preset with some effects.
fn recording(folder: &TempDir, name: &str, seed: &str, effects: &[&str]) -> String {
    let scenario = folder.path().join("land.toml");
    std::fs::write(&scenario, short_land()).unwrap();
    recording_of(&scenario, folder, name, seed, effects)
}

fn recording_of(scenario: &Path, folder: &TempDir, name: &str, seed: &str, effects: &[&str]) -> String {
    let out = folder.path().join(name);
    let mut arguments = vec!["simulate", text(scenario), "--out", text(&out), "--seed", seed];
    effects.iter().for_each(|effect| arguments.extend(["--effect", effect]));
    done(&arguments);
    text(&out).into()
}

fn diagnosed(folder: &TempDir, recording: &str, more: &[&str]) -> Value {
    printed_and_diagnosed(folder, recording, more).1
}

fn printed_and_diagnosed(folder: &TempDir, recording: &str, more: &[&str]) -> (String, Value) {
    let out = folder.path().join("diagnosis");
    let mut arguments = vec!["diagnose", recording, "--out", text(&out)];
    arguments.extend(more);
    let printed = done(&arguments);
    assert!(std::fs::read_to_string(out.join("gap.csv")).unwrap().lines().count() > 600);
    (printed, serde_json::from_str(&std::fs::read_to_string(out.join("diagnosis.json")).unwrap()).unwrap())
}

fn names(diagnosis: &Value) -> Vec<&str> {
    diagnosis["effects"].as_array().unwrap().iter().map(|effect| effect["name"].as_str().unwrap()).collect()
}

/// The promises about the file that hold whatever it says.
fn well_formed(diagnosis: &Value) {
    let candidates = diagnosis["candidates"].as_array().unwrap();
    let sum: f64 = candidates.iter().map(|candidate| candidate["probability"].as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    assert!(["none", "unknown"].iter().all(|name| candidates.iter().any(|candidate| candidate["name"] == *name)));
    let cells = diagnosis["where"].as_array().unwrap();
    for by in ["channel", "band", "time", "heading", "attitude_rate", "amplitude"] {
        let shares = cells.iter().filter(|cell| cell["by"] == by).map(|cell| cell["excess_share"].as_f64().unwrap());
        assert!((shares.sum::<f64>() - 1.0).abs() < 1e-9, "{by}");
    }
}

#[test]
fn a_recording_of_the_simulator_has_no_gap() {
    let folder = TempDir::new().unwrap();
    let scenario = folder.path().join("scenario.toml");
    // The tow on the lake is as long as it comes.
    for (preset, seed, duration_s) in
        [("sea_tow.toml", "5", 600.0), ("lake_tow.toml", "1", 1200.0), ("land_calibration.toml", "21", 600.0)]
    {
        std::fs::write(&scenario, preset_of(preset, duration_s)).unwrap();
        let diagnosis = diagnosed(&folder, &recording_of(&scenario, &folder, "clean.csv", seed, &[]), &[]);
        well_formed(&diagnosis);
        let found = (diagnosis["verdict"].as_str(), names(&diagnosis).len());
        assert_eq!(found, (Some("no_gap"), 0), "{preset} {seed}: {diagnosis:#}");
    }
}

#[test]
fn a_withheld_effect_is_missed_and_with_it_the_gap_closes() {
    let folder = TempDir::new().unwrap();
    let recording =
        recording(&folder, "tone.csv", "6", &["mains_alias:frequency_hz=1.7,amplitude_nT=0.5,phase_rad=0.3"]);
    let with = diagnosed(&folder, &recording, &[]);
    well_formed(&with);
    assert_eq!((with["verdict"].as_str(), names(&with)), (Some("explained"), vec!["mains_alias"]));
    let effect = &with["effects"][0];
    let frequency = &effect["parameters"][0];
    assert!((frequency["value"].as_f64().unwrap() - 1.7).abs() < 1e-3, "{frequency}");
    assert!(effect["gap_closed"]["fraction"].as_f64().unwrap() > 0.9, "{effect}");
    let main = with["candidates"][0]["probability"].as_f64();
    assert_eq!((main, with["candidates"][0]["name"].as_str()), (effect["probability"].as_f64(), Some("mains_alias")));
    let without = diagnosed(&folder, &recording, &["--withhold", "mains_alias"]);
    well_formed(&without);
    assert!(["unknown", "partly_explained"].contains(&without["verdict"].as_str().unwrap()), "{without:#}");
}

#[test]
fn the_same_seed_gives_the_same_answer() {
    let folder = TempDir::new().unwrap();
    let recording = recording(&folder, "lag.csv", "7", &["scalar_lag:lag_s=0.04"]);
    let (first, second) = (diagnosed(&folder, &recording, &[]), diagnosed(&folder, &recording, &[]));
    assert_eq!(first, second);
    let lag = &first["effects"][0];
    let named: Vec<&str> = std::iter::once(&lag["name"])
        .chain(lag["indistinguishable_from"].as_array().unwrap())
        .map(|name| name.as_str().unwrap())
        .collect();
    assert!(named.contains(&"scalar_lag"), "{named:?}");
}

#[test]
fn a_recording_that_is_too_short_is_bad_input() {
    let folder = TempDir::new().unwrap();
    let whole = std::fs::read_to_string(recording(&folder, "whole.csv", "8", &[])).unwrap();
    let short = folder.path().join("short.csv");
    std::fs::write(&short, whole.lines().take(590).collect::<Vec<_>>().join("\n")).unwrap();
    let out = folder.path().join("out");
    let refusal = refused(&["diagnose", text(&short), "--out", text(&out)]);
    assert!(refusal.contains("at least 60 s") && !out.exists(), "{refusal}");
    let refusal = refused(&["diagnose", "x.csv", "--withhold", "gremlins", "--out", text(&out)]);
    assert!(refusal.contains("no such effect"), "{refusal}");
}

const LAG: &str = "scalar_lag:lag_s=0.04";

#[test]
fn a_second_recording_with_the_effect_confirms_it() {
    let folder = TempDir::new().unwrap();
    let first = recording(&folder, "first.csv", "11", &[LAG]);
    let second = recording(&folder, "second.csv", "12", &[LAG]);
    let (printed, diagnosis) = printed_and_diagnosed(&folder, &first, &["--confirm", &second]);
    let confirmed = &diagnosis["effects"][0]["confirmed"];
    assert!(confirmed["fraction"].as_f64().unwrap() > 0.9, "{diagnosis:#}");
    assert!(printed.contains("on the second") && !printed.contains("not confirmed"), "{printed}");
}

#[test]
fn a_second_recording_without_the_effect_does_not_confirm_it_and_that_is_said() {
    let folder = TempDir::new().unwrap();
    let first = recording(&folder, "first.csv", "11", &[LAG]);
    let second = recording(&folder, "second.csv", "12", &[]);
    let (printed, diagnosis) = printed_and_diagnosed(&folder, &first, &["--confirm", &second]);
    let confirmed = &diagnosis["effects"][0]["confirmed"];
    assert!(confirmed["fraction"].as_f64().unwrap() < 0.05, "{diagnosis:#}");
    assert!(printed.contains("not confirmed"), "{printed}");
    let page = std::fs::read_to_string(folder.path().join("diagnosis/report.html")).unwrap();
    assert!(page.contains("not confirmed"));
}

/// The short land preset with a recorder that steps by 0.005 and 0.1526 nT and an export that pads the digits.
fn padded_recording(folder: &TempDir, effects: &[&str]) -> String {
    let padded = short_land()
        .replace("resolution_nT = 0.001", "resolution_nT = 0.005\ndecimals = 5")
        .replace("resolution_nT = 0.01\n", "resolution_nT = 0.152588\ndecimals = 4\n");
    let scenario = folder.path().join("padded.toml");
    std::fs::write(&scenario, padded).unwrap();
    recording_of(&scenario, folder, "padded.csv", "3", effects)
}

#[test]
fn what_a_recorder_rounds_is_no_gap_and_is_told() {
    let folder = TempDir::new().unwrap();
    let (printed, diagnosis) = printed_and_diagnosed(&folder, &padded_recording(&folder, &[]), &[]);
    assert_eq!((diagnosis["verdict"].as_str(), names(&diagnosis).len()), (Some("no_gap"), 0), "{diagnosis:#}");
    let told = |key: &str| diagnosis["rounding"][key].as_f64().unwrap();
    assert!((told("scalar_nT") - 0.005).abs() < 1e-6 && (told("flux_nT") - 0.152_588).abs() < 1e-5);
    // A twelfth of the step's square over the noise: of the fluxgate 0.5 nT, of the scalar that of the direction too.
    let near = |key: &str, step_nt: f64, noise_nt: f64, within: f64| {
        (told(key) / ((step_nt / noise_nt).powi(2) / 12.0) - 1.0).abs() < within
    };
    let scalar_noise_nt = diagnosis["channels"][0]["noise_floor_rms_nT"].as_f64().unwrap();
    assert!(near("scalar_noise_share", 0.005, scalar_noise_nt, 1e-6), "{diagnosis:#}");
    assert!(near("flux_noise_share", 0.152_588, 0.5, 0.15), "{diagnosis:#}");
    assert_eq!(told("noise_share"), told("flux_noise_share"));
    let line = "Recorded: scalar in steps of 0.005 nT, under 1 % of its noise power; \
                fluxgate in steps of 0.153 nT, 1 % of its noise power.";
    assert!(printed.contains(line), "{printed}");
    let page = std::fs::read_to_string(folder.path().join("diagnosis/report.html")).unwrap();
    assert!(page.contains("Recorded: scalar in steps of 0.005"));
}

#[test]
fn what_is_beyond_the_rounding_of_a_recorder_is_named() {
    let folder = TempDir::new().unwrap();
    let effects = ["stale_sample:probability=0.03", "fluxgate_quantisation:step_nT=2"];
    let diagnosis = diagnosed(&folder, &padded_recording(&folder, &effects), &[]);
    well_formed(&diagnosis);
    let mut named = names(&diagnosis);
    named.sort_unstable();
    assert_eq!(named, ["fluxgate_quantisation", "stale_sample"], "{diagnosis:#}");
    for (name, value) in [("fluxgate_quantisation", 2.0), ("stale_sample", 0.03)] {
        let effects = diagnosis["effects"].as_array().unwrap();
        let found = &effects.iter().find(|effect| effect["name"] == name).unwrap()["parameters"][0];
        let [low, high] = [0, 1].map(|end| found["ci95"][end].as_f64().unwrap());
        assert!((low - 0.01 * value..=high + 0.01 * value).contains(&value), "{found}");
    }
}

//! What a diagnosis names is taken off before contacts are looked for, and said; with `--no-diagnose` nothing is.

use serde_json::Value;

use super::tow::Tow;
use crate::common::{done, host_sim, preset_of, text};

/// A lake tow of a few minutes without iron, with an effect; its survey's `summary.json` and what the survey says of its rows.
fn surveyed(effect: &str, options: &[&str]) -> (Value, Tow) {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("tow.toml"), preset_of("lake_tow.toml", 300.0)).unwrap();
    let [scenario, recording, out] = ["tow.toml", "tow.csv", "out"].map(path);
    done(&["simulate", text(&scenario), "--seed", "3", "--effect", effect, "--out", text(&recording)]);
    done(&[&["survey", text(&recording), "--out", text(&out)], options].concat());
    let summary = std::fs::read_to_string(path("out/summary.json")).unwrap();
    (serde_json::from_str(&summary).unwrap(), Tow::read(&path("out/levelled.csv")))
}

#[test]
fn a_line_of_the_mains_is_taken_off_the_field_and_said() {
    let effect = "mains_alias:frequency_hz=0.31,amplitude_nT=1,phase_rad=0.3";
    let floor_nt = |summary: &Value| summary["noise_floor_nT"].as_f64().unwrap();
    let ((summary, tow), (plain, as_read)) = (surveyed(effect, &[]), surveyed(effect, &["--no-diagnose"]));
    let found = &summary["recordings"][0]["effects"][0];
    assert_eq!((&found["name"], &found["is_random"]), (&"mains_alias".into(), &false.into()));
    // The terms describe a little of it on so short a tow.
    assert!((found["rms_nT"].as_f64().unwrap() - 0.5_f64.sqrt()).abs() < 0.1, "{found}");
    assert!(plain["recordings"][0]["effects"].is_null());
    let said = summary["warnings"].to_string();
    assert!(said.contains("taken off before contacts were looked for"), "{said}");
    assert!(floor_nt(&summary) < 0.1 * floor_nt(&plain), "{} {}", floor_nt(&summary), floor_nt(&plain));
    // The readings stay as they were.
    assert_eq!(tow.numbers("scalar_nT"), as_read.numbers("scalar_nT"));
}

#[test]
fn a_recording_that_is_too_short_for_a_diagnosis_is_surveyed_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let mut tow = Tow::sample();
    tow.rows.truncate(3000);
    // A bad row every 5 s: no stretch is as long as a block.
    let scalar = tow.column("scalar_nT");
    (0..tow.rows.len()).filter(|row| row % 50 < 10).for_each(|row| tow.rows[row][scalar] = String::new());
    let (rec, out) = (tow.written(folder.path(), "rec.csv"), folder.path().join("out"));
    done(&["survey", text(&rec), "--out", text(&out)]);
    let summary: Value = serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
    let said = summary["warnings"].to_string();
    assert!(said.contains("Not diagnosed"), "{said}");
}

/// A logger stamps each line of text when it comes, up to 20 ms off; the sensors sample evenly.
#[test]
fn stamps_that_jitter_are_no_fault_and_make_no_noise() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("tow.toml"), preset_of("lake_tow.toml", 300.0)).unwrap();
    done(&["simulate", text(&path("tow.toml")), "--seed", "3", "--out", text(&path("even.csv"))]);
    let mut tow = Tow::read(&path("even.csv"));
    let time = tow.column("time_s");
    for (row, fields) in tow.rows.iter_mut().enumerate() {
        let jitter_s = 0.04 * ((row * 104_729 % 997) as f64 / 997.0 - 0.5);
        fields[time] = format!("{:.3}", fields[time].parse::<f64>().unwrap() + jitter_s);
    }
    tow.written(folder.path(), "late.csv");
    let [even, late] = [("even", &["--no-diagnose"][..]), ("late", &[])].map(|(name, options)| {
        done(&[&["survey", text(&path(&format!("{name}.csv"))), "--out", text(&path(name))], options].concat());
        let summary = std::fs::read_to_string(path(name).join("summary.json")).unwrap();
        serde_json::from_str::<Value>(&summary).unwrap()
    });
    assert!(late["recordings"][0]["effects"].is_null(), "{late}");
    let [even_nt, late_nt] = [even, late].map(|summary| summary["noise_floor_nT"].as_f64().unwrap());
    assert!((late_nt / even_nt - 1.0).abs() < 0.03, "{even_nt} {late_nt}");
}

#[test]
fn an_axis_that_stands_still_while_the_others_move_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let mut tow = Tow::two_minutes();
    let axis = tow.column("flux_y_nT");
    tow.rows.iter_mut().for_each(|row| row[axis] = "1234.5".into());
    let (rec, out) = (tow.written(folder.path(), "rec.csv"), folder.path().join("out"));
    let said = host_sim(&["survey", text(&rec), "--out", text(&out), "--no-diagnose"]);
    assert!(String::from_utf8_lossy(&said.stderr).contains("flux_y_nT stands still for"), "{said:?}");
}

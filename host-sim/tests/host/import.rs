//! `host-sim import`: what is wrong with a recording is found and named, what is right is left alone, and what is imported
//! compensates as the original does.

mod copies;
mod damage;
mod rates;

use std::fs;

use crate::common::{done, host_sim, of_repository, refused, text};
use copies::{Copy, flights, peer, sample, scenarios};
use tempfile::TempDir;

#[test]
fn what_is_damaged_is_found_and_named() {
    let mut originals = sample();
    // Of both fluxgates and both scalars.
    originals.extend(flights().into_iter().step_by(3));
    let damaged: Vec<_> = originals.iter().flat_map(damage::of).collect();
    let missed: Vec<String> = damaged.iter().filter_map(damage::Damaged::missed).collect();
    println!("{} damaged copies, {} found and named", damaged.len(), damaged.len() - missed.len());
    assert!(damaged.len() >= 30 && missed.is_empty(), "{} of {}:\n{}", missed.len(), damaged.len(), missed.join("\n"));
}

#[test]
fn what_is_right_gets_no_warning() {
    let mut right = sample();
    right.extend(scenarios());
    right.extend(peer());
    for copy in &right {
        assert_eq!(copy.warnings(), [""; 0], "{}", copy.name);
    }
    // Their axes are an aircraft's: that is said where it can be seen, and nothing else.
    for copy in flights() {
        let warnings = copy.warnings();
        let said = warnings.iter().all(|warning| warning.contains("the axes are not forward, starboard, down"));
        assert!(said && warnings.len() <= 1, "{}: {warnings:?}", copy.name);
    }
}

#[test]
fn the_option_that_is_named_mends() {
    for original in sample() {
        for damaged in damage::of(&original).into_iter().filter(|damaged| damaged.option.is_some()) {
            if let Some(left) = damaged.left_after_option(&original) {
                panic!("{}: {left}", damaged.copy.name);
            }
        }
    }
}

#[test]
fn faster_copies_compensate_as_the_recording_does() {
    let folder = TempDir::new().unwrap();
    let tow = sample().remove(1);
    let own = rates::residual_nt(folder.path(), &tow.csv());
    for rate_hz in [20, 40, 100, 160] {
        let imported = rates::copy(&tow, rate_hz).imported_csv();
        let residual = rates::residual_nt(folder.path(), &imported);
        println!("{rate_hz} Hz: residual {residual:.4} nT, of the recording {own:.4} nT");
        assert!((residual / own - 1.0).abs() < 0.02, "{rate_hz} Hz: {residual} nT, of the recording {own} nT");
    }
}

#[test]
fn aliases_are_below_a_hundredth_of_a_nanotesla() {
    for rate_hz in [20, 40, 100, 160] {
        for tone_hz in rates::tones(rate_hz) {
            let alias_nt = rates::alias_rms_nt(rate_hz, tone_hz);
            assert!(alias_nt < 0.01, "{tone_hz} Hz at {rate_hz} Hz: {alias_nt} nT rms of 10 nT");
        }
    }
}

/// A flight that goes out as HDF5 and comes back is the same to the bit.
#[test]
fn a_recording_survives_magnav_hdf5_to_the_bit() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| text(&folder.path().join(name)).to_string();
    let mut recordings = flights();
    recordings.extend(sample());
    for copy in recordings {
        let (csv, hdf5, back) = (path("rec.csv"), path("rec.h5"), path("back.csv"));
        fs::write(&csv, copy.csv()).unwrap();
        done(&["export", &csv, "--format", "hdf5", "--out", &hdf5]);
        done(&["import", &hdf5, "--out", &back]);
        let back = Copy::read(&copy.name, &fs::read(&back).unwrap());
        for name in ["time_s", "scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"] {
            assert!(back.column(name) == copy.column(name), "{}: {name}", copy.name);
        }
    }
}

#[test]
fn the_command_writes_recording_profile_and_report_and_the_profile_gives_the_same_bytes() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| text(&folder.path().join(name)).to_string();
    let source = text(&of_repository("import/tests/corpus/semicolon_decimal_comma.csv")).to_string();
    let printed = done(&["import", &source, "--out", &path("a.csv")]);
    assert!(printed.contains("decimals stand behind a comma"), "{printed}");
    let report: serde_json::Value = serde_json::from_slice(&fs::read(path("a.import.json")).unwrap()).unwrap();
    assert_eq!(report["rows_out"], 150);
    done(&["import", &source, "--profile", &path("a.profile.toml"), "--out", &path("b.csv")]);
    assert!(fs::read(path("a.csv")).unwrap() == fs::read(path("b.csv")).unwrap());
    let streamed = host_sim(&["import", &source, "--out", "-"]);
    assert!(streamed.stdout == fs::read(path("a.csv")).unwrap());
}

#[test]
fn a_fluxgate_in_counts_is_refused_with_its_scale_and_imported_with_it() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| text(&folder.path().join(name)).to_string();
    let (own, mut counts) = (sample().remove(0), sample().remove(0));
    for axis in ["flux_x_nT", "flux_y_nT", "flux_z_nT"] {
        counts.column_mut(axis).iter_mut().for_each(|value| *value *= 37.3);
    }
    for (name, _) in &mut counts.columns {
        *name = name.trim_end_matches("_nT").to_string();
    }
    fs::write(path("counts.csv"), counts.csv()).unwrap();
    let message = refused(&["import", &path("counts.csv"), "--out", &path("a.csv")]);
    let (_, factor) = message.split_once("--flux-factor ").unwrap_or_else(|| panic!("{message}"));
    let factor = factor.split(')').next().unwrap();
    done(&["import", &path("counts.csv"), "--flux-factor", factor, "--out", &path("a.csv")]);
    let imported = Copy::read("a", &fs::read(path("a.csv")).unwrap());
    let off = imported.column("flux_z_nT").iter().zip(own.column("flux_z_nT")).map(|(a, b)| (a / b - 1.0).abs());
    assert!(off.fold(0.0, f64::max) < 0.02);
}

#[test]
fn what_cannot_be_is_refused_with_the_remedy_and_leaves_nothing() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| text(&folder.path().join(name)).to_string();
    let import = |arguments: &[&str]| {
        let out = path("a.csv");
        let arguments: Vec<&str> = ["import"].iter().chain(arguments).copied().chain(["--out", &out]).collect();
        let message = refused(&arguments);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        message
    };
    let corpus = |name: &str| text(&of_repository("import/tests/corpus").join(name)).to_string();
    assert!(import(&[&corpus("prose.txt")]).contains("no table of numbers"));
    assert!(import(&[&corpus("no_time_no_rate.csv")]).contains("--time NAME"));
    assert!(import(&[&corpus("own.csv"), "--scalar", "mag"]).contains("has no column \"mag\"; it has time_s"));
    assert!(import(&["none.csv"]).starts_with("none.csv: "));
    let own = path("own.csv");
    fs::copy(corpus("own.csv"), &own).unwrap();
    assert!(refused(&["import", &own, "--out", &own]).contains("would be replaced"));
}

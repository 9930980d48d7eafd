//! The files are what the contract says.

use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use super::readers::opened_by_others;
use super::tow::{START, Tow};
use crate::common::{done, host_sim, text};

const ADDED: [&str; 5] = ["field_nT", "field_std_nT", "anomaly_nT", "anomaly_std_nT", "valid"];
const CONTACTS: &str = "contact,passes,time_s,line,latitude_deg,longitude_deg,easting_m,northing_m,peak_nT,width_s,snr,\
                        false_alarm_probability,distance_m,distance_low_m,distance_high_m,moment_Am2,moment_low_Am2,\
                        moment_high_Am2";

pub(super) fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn survey(recordings: &[&Path], options: &[&str], out: &Path) {
    let recordings: Vec<&str> = recordings.iter().map(|path| text(path)).collect();
    done(&[&["survey"], &recordings[..], options, &["--out", text(out)]].concat());
}

/// Where what `diagnose` would say of it changes nothing.
pub(super) fn survey_alone(recordings: &[&Path], options: &[&str], out: &Path) {
    survey(recordings, &[&["--no-diagnose"], options].concat(), out);
}

pub(super) fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Features of a GeoJSON file whose geometry is of this type.
fn features(file: &Value, of_type: &str) -> Vec<Value> {
    let all = file["features"].as_array().unwrap();
    all.iter().filter(|feature| feature["geometry"]["type"] == of_type).cloned().collect()
}

#[test]
fn every_column_of_the_recording_is_kept_as_it_was() {
    let folder = folder();
    let mut tow = Tow::two_minutes().with_positions().with("note", |row| format!("a, \"{row:05}\" 007.50"));
    let scalar = tow.column("scalar_nT");
    tow.rows[300][scalar] = "9e9".into();
    tow.rows[301][scalar] = String::new();
    let rec = tow.written(folder.path(), "rec.csv");
    survey_alone(&[&rec], &[], &folder.path().join("out"));
    let levelled = Tow::read(&folder.path().join("out/levelled.csv"));
    let kept = tow.header.len();
    assert_eq!((&levelled.header[..kept], &levelled.header[kept..]), (&tow.header[..], &ADDED.map(String::from)[..]));
    assert_eq!(levelled.rows.len(), tow.rows.len());
    assert!(levelled.rows.iter().zip(&tow.rows).all(|(levelled, row)| levelled[..kept] == row[..]));
    for row in [300, 301] {
        assert_eq!(levelled.rows[row][kept..], ["", "", "", "", "0"].map(String::from));
    }
    let (field, valid) = (levelled.numbers("field_nT"), levelled.numbers("valid"));
    assert!(field.iter().zip(&valid).all(|(field, valid)| field.is_some() == (*valid == Some(1.0))));
    assert!(valid.iter().filter(|valid| **valid == Some(1.0)).count() > 1150);
    // Surveyed again, its columns are not there twice.
    survey_alone(&[&folder.path().join("out/levelled.csv")], &[], &folder.path().join("again"));
    assert_eq!(Tow::read(&folder.path().join("again/levelled.csv")).header, levelled.header);
}

#[test]
fn track_and_contacts_have_their_places_and_other_programs_open_them() {
    let folder = folder();
    let rec = Tow::sample().with_positions().written(folder.path(), "rec.csv");
    let out = folder.path().join("out");
    survey_alone(&[&rec], &[], &out);
    assert_eq!(std::fs::read_to_string(out.join("contacts.csv")).unwrap().lines().next(), Some(CONTACTS));
    let rows = Tow::read(&out.join("contacts.csv")).rows.len();
    assert_eq!(json(&out.join("contacts.geojson"))["features"].as_array().unwrap().len(), rows);
    let track = json(&out.join("track.geojson"));
    let lines = features(&track, "LineString");
    let named: Vec<&str> =
        lines.iter().map(|line| line["properties"]["line"].as_str().unwrap()).filter(|line| !line.is_empty()).collect();
    assert_eq!(named, ["L1", "L2", "L3", "L4"]);
    let start = &lines[0]["geometry"]["coordinates"][0];
    assert!(
        (start[0].as_f64().unwrap() - START[1]).abs() < 1e-5 && (start[1].as_f64().unwrap() - START[0]).abs() < 1e-5
    );
    let points = features(&track, "Point");
    assert!((580..640).contains(&points.len()), "{}", points.len());
    assert!(points.iter().all(|point| point["properties"]["anomaly_nT"].is_number()));
    let summary = json(&out.join("summary.json"));
    assert_eq!((&summary["grid"]["epsg"], &summary["contacts"]), (&Value::from(32632), &Value::from(rows)));
    let placed = summary["recordings"][0]["placed_rows"].as_u64().unwrap();
    assert!(placed > 5980, "{placed}");
    assert!(summary["duration_s"].as_f64().unwrap() > 590.0);
    opened_by_others(&out);
}

#[test]
fn several_recordings_become_one_table() {
    let folder = folder();
    let one = Tow::beginning().with_positions().with("note", |_| "first".into());
    let mut two = Tow::beginning().with("depth_m", |_| "4.5".into()).with_positions();
    two.rows[9][1] = "x".into();
    let paths = [one.written(folder.path(), "one.csv"), two.written(folder.path(), "two.csv")];
    let out = folder.path().join("out");
    survey(&[&paths[0], &paths[1]], &[], &out);
    let levelled = Tow::read(&out.join("levelled.csv"));
    assert_eq!((levelled.header[0].as_str(), levelled.rows.len()), ("recording", 6_000));
    let [note, depth, recording] = ["note", "depth_m", "recording"].map(|name| levelled.column(name));
    for (row, name, in_note, in_depth) in [(2999, "one.csv", "first", ""), (3000, "two.csv", "", "4.5")] {
        let fields = &levelled.rows[row];
        assert_eq!([&fields[recording], &fields[note], &fields[depth]], [name, in_note, in_depth]);
    }
    assert_eq!(Tow::read(&out.join("contacts.csv")).header[0], "recording");
    let summary = json(&out.join("summary.json"));
    let names = |at: usize| summary["recordings"][at]["recording"].as_str().unwrap();
    assert_eq!([names(0), names(1)], ["one.csv", "two.csv"]);
    assert_eq!(summary["recordings"][1]["lines"][0], "L3");
    let bad = &summary["bad_rows"];
    assert_eq!((&bad["count"], &bad["first"][0]["line"]), (&Value::from(1), &Value::from(11)));
    assert!(bad["first"][0]["what"].as_str().unwrap().starts_with("two.csv: "), "{bad}");
}

#[test]
fn a_map_that_reaches_too_far_for_its_cells_is_said() {
    let folder = folder();
    let near = Tow::two_minutes().with_positions();
    let latitude = near.column("latitude_deg");
    let mut far = near.clone();
    for field in far.rows.iter_mut().map(|fields| &mut fields[latitude]).filter(|field| !field.is_empty()) {
        *field = format!("{:.8}", field.parse::<f64>().unwrap() + 3.0);
    }
    let [near, far] = [(near, "near.csv"), (far, "far.csv")].map(|(tow, name)| tow.written(folder.path(), name));
    let is_said = |recordings: &[&Path], name: &str| {
        let out = folder.path().join(name);
        survey_alone(recordings, &[], &out);
        json(&out.join("summary.json"))["warnings"].to_string().contains("The map's cells are")
    };
    assert!(is_said(&[&near, &far], "both") && !is_said(&[&near], "one"));
}

#[test]
fn without_positions_there_is_no_map_and_it_is_said() {
    let folder = folder();
    let rec = Tow::two_minutes().written(folder.path(), "rec.csv");
    let out = folder.path().join("out");
    let output = host_sim(&["survey", text(&rec), "--json", "--no-diagnose", "--out", text(&out)]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.contains("warning: rec.csv has no positions"), "{stderr}");
    assert_eq!(output.stdout, std::fs::read(out.join("summary.json")).unwrap());
    assert_eq!(json(&out.join("track.geojson"))["features"], Value::Array(Vec::new()));
    assert!(!out.join("grid.tif").exists() && json(&out.join("summary.json")).get("grid").is_none());
}

#[test]
fn a_map_of_other_recordings_does_not_stay() {
    let folder = folder();
    let with = Tow::two_minutes().with_positions().written(folder.path(), "with.csv");
    let without = Tow::two_minutes().written(folder.path(), "without.csv");
    let out = folder.path().join("out");
    survey_alone(&[&with], &[], &out);
    assert!(out.join("grid.tif").exists());
    std::fs::write(out.join("theirs.txt"), "mine").unwrap();
    survey_alone(&[&without], &[], &out);
    assert!(!out.join("grid.tif").exists() && out.join("theirs.txt").exists());
}

#[test]
fn the_body_is_behind_the_ship() {
    let folder = folder();
    let rec = Tow::two_minutes().with_positions().written(folder.path(), "rec.csv");
    let cable = |_| "50".to_string();
    let ship = Tow::two_minutes().with_positions().with("cable_out_m", cable).with("depth_m", |_| "30".into());
    let ship = ship.written(folder.path(), "ship.csv");
    let out = |name: &str| folder.path().join(name);
    survey_alone(&[&rec], &[], &out("body"));
    survey_alone(&[&rec], &["--layback-m", "40"], &out("fixed"));
    survey_alone(&[&ship], &["--ship-position"], &out("cable"));
    let start = |name: &str| {
        let track = json(&out(name).join("track.geojson"));
        let place = features(&track, "LineString").remove(0)["geometry"]["coordinates"][0].clone();
        [place[0].as_f64().unwrap(), place[1].as_f64().unwrap()]
    };
    let ([body, fixed], cable) = (["body", "fixed"].map(start), start("cable"));
    let metres =
        |a: [f64; 2], b: [f64; 2]| ((a[0] - b[0]) * START[0].to_radians().cos()).hypot(a[1] - b[1]) * 111_200.0;
    assert!((metres(body, fixed) - 40.0).abs() < 1.0, "{}", metres(body, fixed));
    assert!(metres(cable, fixed) < 0.1, "{}", metres(cable, fixed));
}

#[test]
fn compressed_and_through_a_pipe_it_is_the_same() {
    use std::io::Write;
    let folder = folder();
    let rec = Tow::two_minutes().written(folder.path(), "rec.csv");
    let bytes = std::fs::read(&rec).unwrap();
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(&bytes).unwrap();
    let compressed = folder.path().join("rec.csv.gz");
    std::fs::write(&compressed, encoder.finish().unwrap()).unwrap();
    let out = |name: &str| folder.path().join(name);
    survey_alone(&[&rec], &[], &out("file"));
    survey_alone(&[&compressed], &[], &out("gzip"));
    let mut piped = std::process::Command::new(env!("CARGO_BIN_EXE_host-sim"));
    piped.args(["survey", "-", "--no-diagnose", "--out", text(&out("pipe"))]).stdin(std::process::Stdio::piped());
    let mut child = piped.stdout(std::process::Stdio::null()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(&bytes).unwrap();
    assert!(child.wait().unwrap().success());
    let levelled = |name: &str| std::fs::read(out(name).join("levelled.csv")).unwrap();
    assert!(levelled("gzip") == levelled("file") && levelled("pipe") == levelled("file"));
}

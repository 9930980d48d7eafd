//! What is proposed for a gap without a name explains the next recording of the same body by that name.

use crate::common::{done, of_repository, preset_of, refused, text};
use serde_json::Value;
use tempfile::TempDir;

/// Both follow the depth: with neither, what follows it has no name.
const WITHHELD: [&str; 4] = ["--withhold", "depth_gradient", "--withhold", "swell_induction"];

/// A flap that lies on one side until the body pitches by more than the play to the other.
const FLAP: &str = r#"
name = "loose_flap"
channel = "scalar"
kind = "additive"
formula = "size * signum(slack)"

[parameters.size]
unit = "nT"
low = -5.0
high = 5.0
default = 0.3

[inputs.slack]
of = "pitch_deg"
filter = "play"
width = 1.5
"#;

/// A counter that takes the longer the higher the field is. The 18 terms take most of it.
const LATE: &str = r#"
name = "late_by_the_reading"
channel = "scalar"
kind = "additive"
formula = "delay_s * slope * (s - 52379.0) / 14.0"

[parameters.delay_s]
unit = "s"
low = -1.0
high = 1.0
default = 0.05

[inputs.slope]
of = "s"
filter = "rate"
"#;

/// Eight minutes on a lake, with what a simulation is told beside.
fn simulated(folder: &TempDir, name: &str, seed: &str, more: &[&str]) -> String {
    lasting(480.0, folder, name, seed, more)
}

fn lasting(duration_s: f64, folder: &TempDir, name: &str, seed: &str, more: &[&str]) -> String {
    let [out, scenario] = [name, "scenario.toml"].map(|name| folder.path().join(name));
    std::fs::write(&scenario, preset_of("lake_tow.toml", duration_s)).unwrap();
    let mut arguments = vec!["simulate", text(&scenario), "--out", text(&out), "--seed", seed];
    arguments.extend(more);
    done(&arguments);
    text(&out).into()
}

fn recording(folder: &TempDir, name: &str, seed: &str) -> String {
    simulated(folder, name, seed, &["--effect", "depth_gradient:gradient_nT_per_m=0.6"])
}

fn diagnosed(folder: &TempDir, out: &str, recording: &str, more: &[&str]) -> Value {
    let out = folder.path().join(out);
    let mut arguments = vec!["diagnose", recording, "--out", text(&out)];
    arguments.extend(more);
    done(&arguments);
    serde_json::from_str(&std::fs::read_to_string(out.join("diagnosis.json")).unwrap()).unwrap()
}

#[test]
fn a_proposed_effect_is_held_against_a_second_recording_and_names_the_gap_of_a_third() {
    let folder = TempDir::new().unwrap();
    // The second is one in which the gap stands out of its noise.
    let [first, second, third] = ["11", "14", "13"].map(|seed| recording(&folder, &format!("{seed}.csv"), seed));
    let unknown = diagnosed(&folder, "unknown", &first, &[&WITHHELD[..], &["--confirm", &second]].concat());
    let rest = &unknown["unexplained"];
    assert_eq!((unknown["verdict"].as_str(), rest["drivers"][0]["input"].as_str()), (Some("unknown"), Some("depth")));
    assert!(rest["gap_closed"]["ci95"][0].as_f64().unwrap() > 0.5, "{rest}");
    assert!(rest["text"].as_str().unwrap().contains("a vertical gradient of the field"), "{rest}");
    let file = folder.path().join("unknown").join(rest["effect_file"].as_str().unwrap());

    let named = diagnosed(&folder, "named", &third, &[&WITHHELD[..], &["--effect-file", text(&file)]].concat());
    assert_eq!(
        (named["verdict"].as_str(), named["effects"][0]["name"].as_str()),
        (Some("explained"), Some("proposed_depth"))
    );
    let scale = named["effects"][0]["parameters"][0]["value"].as_f64().unwrap();
    assert!((scale - 1.0).abs() < 0.1, "{scale}");

    // A proposal that is being used is not written over; one of an earlier diagnosis is not left beside one that proposes nothing.
    let out = folder.path().join("unknown");
    let said = refused(&["diagnose", &third, "--out", text(&out), "--effect-file", text(&file)]);
    assert!(said.contains("would be replaced") && file.exists(), "{said}");
    done(&["diagnose", text(&of_repository("sample/calibration.csv")), "--out", text(&out)]);
    assert!(!file.exists());
}

#[test]
fn what_follows_a_recorded_tilt_is_proposed_as_the_formula_that_it_is() {
    let folder = TempDir::new().unwrap();
    let flap = folder.path().join("flap.toml");
    std::fs::write(&flap, FLAP).unwrap();
    let more = ["--effect-file", text(&flap), "--effect", "loose_flap"];
    let [first, next] = ["11", "13"].map(|seed| simulated(&folder, &format!("{seed}.csv"), seed, &more));
    let said = diagnosed(&folder, "unknown", &first, &[]);
    assert_eq!(said["unexplained"]["drivers"][0]["input"], "attitude_history", "{said}");
    // Over what a play leaves of the pitch it is a step from one side to the other.
    let curve = &said["unexplained"]["curve"];
    assert_eq!(curve["over"], "pitch, °, as it was before", "{curve}");
    let points = curve["points"].as_array().unwrap();
    let [first_nt, last_nt] = [&points[0], &points[points.len() - 1]].map(|point| point["left_nT"].as_f64().unwrap());
    assert!((last_nt - first_nt - 0.6).abs() < 0.1, "{curve}");
    let file = folder.path().join("unknown").join("proposed_effect.toml");
    let proposed: toml::Table = std::fs::read_to_string(&file).unwrap().parse().unwrap();
    let inputs = proposed["inputs"].as_table().unwrap();
    let slack = inputs.values().next().unwrap();
    assert_eq!((inputs.len(), slack["of"].as_str(), slack["filter"].as_str()), (1, Some("pitch_deg"), Some("play")));
    assert!((slack["width"].as_float().unwrap() - 1.5).abs() < 0.05, "{proposed}");

    let said = diagnosed(&folder, "named", &next, &["--effect-file", text(&file)]);
    // The play is known to a hundredth: at the edge of it the flap falls some seconds early or late.
    let named = &said["effects"][0];
    assert_eq!(named["name"], "proposed_attitude_history", "{said}");
    assert!(named["gap_closed"]["ci95"][0].as_f64().unwrap() > 0.9, "{named}");
}

#[test]
fn what_the_reading_does_to_itself_is_told_although_the_18_terms_take_most_of_it() {
    let folder = TempDir::new().unwrap();
    let late = folder.path().join("late.toml");
    std::fs::write(&late, LATE).unwrap();
    let more = ["--effect-file", text(&late), "--effect", "late_by_the_reading"];
    let recording = lasting(240.0, &folder, "late.csv", "12", &more);
    let said = diagnosed(&folder, "unknown", &recording, &[]);
    let rest = &said["unexplained"];
    assert_eq!(
        (rest["drivers"][0]["input"].as_str(), rest["form"].as_str()),
        (Some("reading"), Some("delay")),
        "{rest}"
    );
    assert!(rest["gap_closed"]["ci95"][0].as_f64().unwrap() > 0.9, "{rest}");
    assert!(rest["text"].as_str().unwrap().contains("A short formula"), "{rest}");
}

//! What is proposed for a gap without a name explains the next recording of the same body by that name.

use crate::common::{done, of_repository, preset_of, refused, text};
use serde_json::Value;
use tempfile::TempDir;

/// Both follow the depth: with neither, what follows it has no name.
const WITHHELD: [&str; 4] = ["--withhold", "depth_gradient", "--withhold", "swell_induction"];

/// Eight minutes on a lake.
fn recording(folder: &TempDir, name: &str, seed: &str) -> String {
    let [out, scenario] = [name, "scenario.toml"].map(|name| folder.path().join(name));
    std::fs::write(&scenario, preset_of("lake_tow.toml", 480.0)).unwrap();
    let effect = "depth_gradient:gradient_nT_per_m=0.6";
    done(&["simulate", text(&scenario), "--out", text(&out), "--seed", seed, "--effect", effect]);
    text(&out).into()
}

fn diagnosed(folder: &TempDir, out: &str, recording: &str, more: &[&str]) -> Value {
    let out = folder.path().join(out);
    let mut arguments = vec!["diagnose", recording, "--out", text(&out)];
    arguments.extend(WITHHELD);
    arguments.extend(more);
    done(&arguments);
    serde_json::from_str(&std::fs::read_to_string(out.join("diagnosis.json")).unwrap()).unwrap()
}

#[test]
fn a_proposed_effect_is_held_against_a_second_recording_and_names_the_gap_of_a_third() {
    let folder = TempDir::new().unwrap();
    // The second is one in which the gap stands out of its noise.
    let [first, second, third] = ["11", "14", "13"].map(|seed| recording(&folder, &format!("{seed}.csv"), seed));
    let unknown = diagnosed(&folder, "unknown", &first, &["--confirm", &second]);
    let rest = &unknown["unexplained"];
    assert_eq!((unknown["verdict"].as_str(), rest["drivers"][0]["input"].as_str()), (Some("unknown"), Some("depth")));
    assert!(rest["gap_closed"]["ci95"][0].as_f64().unwrap() > 0.5, "{rest}");
    assert!(rest["text"].as_str().unwrap().contains("a vertical gradient of the field"), "{rest}");
    let file = folder.path().join("unknown").join(rest["effect_file"].as_str().unwrap());

    let named = diagnosed(&folder, "named", &third, &["--effect-file", text(&file)]);
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

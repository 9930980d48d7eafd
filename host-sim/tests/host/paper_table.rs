//! The paper's Table 1 on the simulated tows: improvement ratios above the paper's, where the noise allows it.

use std::path::{Path, PathBuf};

use host_sim::command;
use towmag::Settings;

/// Scenario, and the improvement ratio of the published method in the paper's experiment.
const TOWS: [(&str, f64); 2] = [("sea_tow.toml", 9.0767), ("lake_tow.toml", 6.7613)];

fn scenario(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios").join(name)
}

#[test]
fn above_the_papers_ratios() {
    let out = tempfile::tempdir().unwrap();
    let tows = TOWS.map(|(name, _)| scenario(name));
    let table = command::table(&scenario("land_calibration.toml"), &tows, out.path(), &Settings::default()).unwrap();
    assert!(out.path().join("table.json").is_file());
    for (tow, (name, papers)) in table.tows.iter().zip(TOWS) {
        println!("{tow:?}");
        assert_eq!(tow.scenario, name);
        let names: Vec<&str> = tow.late.iter().map(|entry| entry.method.as_str()).collect();
        assert_eq!(names, ["none", "fixed", "rls", "saddle-point", "adaptive"]);
        assert!(tow.late_bound_improvement_ratio > papers);
        let others = tow.late[..4].iter().map(|entry| entry.std_after_nT).fold(f64::INFINITY, f64::min);
        assert!(tow.late[4].std_after_nT <= 1.02 * others, "{name}: another method leaves less");
        for learning in &tow.late[2..] {
            assert!(learning.improvement_ratio > papers, "{name}: {learning:?}");
        }
    }
}

//! The adaptive method on the real flight recordings: what it leaves, and what it keeps of injected anomalies.

use std::path::{Path, PathBuf};

use host_sim::command;
use host_sim::detection::{Detection, TrialSettings, detection_trial};
use towmag::{Method, Settings};

const COMBINATIONS: [(&str, u32, u32); 8] =
    [("b", 5, 5), ("c", 4, 4), ("b", 4, 4), ("c", 5, 5), ("c", 5, 4), ("c", 4, 5), ("b", 5, 4), ("b", 4, 5)];

const METHODS: [Method; 4] = [Method::Fixed, Method::Rls, Method::SaddlePoint, Method::Adaptive];

fn data() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = std::env::var_os("TOWMAG_DATA").map_or(beside, PathBuf::from).join("sgl_line_1002_20");
    folder.is_dir().then_some(folder)
}

#[test]
fn residual_and_amplitude_kept() {
    let Some(data) = data() else {
        println!("skipped: no flight recordings beside the project, and TOWMAG_DATA is not set");
        return;
    };
    let out = tempfile::tempdir().unwrap();
    for (flux, calibrated, surveyed) in COMBINATIONS {
        let file = |scalar: u32, part: &str| data.join(format!("flux_{flux}_mag_{scalar}_{part}.csv"));
        command::calibrate(&file(calibrated, "calibration"), out.path(), &Settings::default()).unwrap();
        let start = command::start_from(Some(&out.path().join("coefficients.toml"))).unwrap();
        for skip_s in [0.0, 120.0] {
            if skip_s > 0.0 && calibrated == surveyed {
                continue;
            }
            let mut mean: Vec<Detection> = Vec::new();
            for seed in 0..4 {
                let trial = TrialSettings { anomalies: 8, seed, line: Some("box2".into()), skip_s };
                let (_, figures) =
                    detection_trial(&file(surveyed, "survey"), &METHODS, &Settings::default(), &start, &trial).unwrap();
                if mean.is_empty() {
                    mean = figures;
                } else {
                    for (mean, figure) in mean.iter_mut().zip(figures) {
                        mean.kept += figure.kept;
                        mean.distortion += figure.distortion;
                    }
                }
            }
            print!("{flux} {calibrated} -> {surveyed} +{skip_s:3}:");
            for figure in &mean {
                print!(
                    " {} {:.3} kept {:.3} dist {:.3} e2e {:.2};",
                    figure.method,
                    figure.residual_over_bound,
                    figure.kept / 4.0,
                    figure.distortion / 4.0,
                    figure.end_to_end_over_bound
                );
            }
            println!();
        }
    }
}

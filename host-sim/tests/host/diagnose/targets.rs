//! Targets in a recording that `host-sim diagnose` is given: signal, and no gap.

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{done, of_repository, preset_of, text};

fn diagnosed(folder: &TempDir, recording: &std::path::Path) -> Value {
    let out = folder.path().join("diagnosis");
    done(&["diagnose", text(recording), "--out", text(&out)]);
    serde_json::from_str(&std::fs::read_to_string(out.join("diagnosis.json")).unwrap()).unwrap()
}

/// Times and peaks of the targets that are listed.
fn listed(diagnosis: &Value) -> Vec<[f64; 2]> {
    let number = |target: &Value, key: &str| target[key].as_f64().unwrap();
    let targets = diagnosis["targets"].as_array().unwrap();
    targets.iter().map(|target| [number(target, "time_s"), number(target, "peak_nT")]).collect()
}

/// Whether some targets are listed, all of them and no others: each within a second and a fifth of its peak.
fn are_listed(diagnosis: &Value, targets: &[[f64; 2]]) -> bool {
    let found = listed(diagnosis);
    let is_near = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).abs() < 1.0 && (a[1] / b[1] - 1.0).abs() < 0.2;
    found.len() == targets.len() && found.iter().zip(targets).all(|(a, b)| is_near(a, b))
}

#[test]
fn the_sample_has_its_two_targets_and_no_gap() {
    let folder = TempDir::new().unwrap();
    let diagnosis = diagnosed(&folder, &of_repository("sample").join("survey.csv"));
    assert_eq!(diagnosis["verdict"], "no_gap");
    assert!(are_listed(&diagnosis, &[[371.0, 6.0], [507.0, 9.0]]), "{:?}", listed(&diagnosis));
}

/// The diagnosis of a tow past some targets: time, s, peak, nT, and width, s, of each.
fn past(targets: &[[f64; 3]], duration_s: f64, seed: &str) -> Value {
    let folder = TempDir::new().unwrap();
    let mut scenario = preset_of("lake_tow.toml", duration_s);
    for [at_s, peak_nt, width_s] in targets {
        scenario += &format!("\n[[target]]\nat_s = {at_s:?}\npeak_nT = {peak_nt:?}\nwidth_s = {width_s:?}\n");
    }
    let [file, recording] = ["scenario.toml", "tow.csv"].map(|name| folder.path().join(name));
    std::fs::write(&file, scenario).unwrap();
    done(&["simulate", text(&file), "--out", text(&recording), "--seed", seed]);
    diagnosed(&folder, &recording)
}

#[test]
fn a_tow_past_small_and_large_iron_has_no_gap() {
    let targets = [[70.0, -40.0, 2.0], [170.0, 8.0, 2.0], [260.0, 3.0, 1.5], [390.0, 250.0, 1.2]];
    let diagnosis = past(&targets, 480.0, "7");
    assert_eq!(diagnosis["verdict"], "no_gap", "{diagnosis:#}");
    assert!(are_listed(&diagnosis, &targets.map(|[at_s, peak_nt, _]| [at_s, peak_nt])), "{:?}", listed(&diagnosis));
}

/// Forty times the noise of the scalar, of which the fluxgate says next to nothing.
#[test]
fn a_small_target_that_the_scalar_alone_can_tell_is_listed() {
    let diagnosis = past(&[[120.0, 1.2, 3.0]], 240.0, "4");
    assert_eq!(diagnosis["verdict"], "no_gap", "{diagnosis:#}");
    assert!(are_listed(&diagnosis, &[[120.0, 1.2]]), "{:?}", listed(&diagnosis));
}

/// A tow of five minutes past nothing, with what `added` makes of each row: its time, s, scalar and fluxgate, nT.
fn rewritten(seed: &str, added: impl Fn(f64, f64, [f64; 3]) -> (f64, [f64; 3])) -> Value {
    let folder = TempDir::new().unwrap();
    let [file, clean, other] = ["tow.toml", "clean.csv", "other.csv"].map(|name| folder.path().join(name));
    std::fs::write(&file, preset_of("lake_tow.toml", 300.0)).unwrap();
    done(&["simulate", text(&file), "--out", text(&clean), "--seed", seed]);
    let table = std::fs::read_to_string(&clean).unwrap();
    let names = ["time_s", "scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"];
    let columns = names.map(|name| table.lines().next().unwrap().split(',').position(|other| other == name).unwrap());
    let line = |line: &str| {
        let mut cells: Vec<String> = line.split(',').map(String::from).collect();
        let [s, scalar_nt, x_nt, y_nt, z_nt] = columns.map(|column| cells[column].parse().unwrap());
        let (scalar_nt, [x_nt, y_nt, z_nt]) = added(s, scalar_nt, [x_nt, y_nt, z_nt]);
        for (column, nt) in columns[1..].iter().zip([scalar_nt, x_nt, y_nt, z_nt]) {
            cells[*column] = format!("{nt:.3}");
        }
        cells.join(",")
    };
    let mut lines = table.lines();
    let lines = std::iter::once(lines.next().unwrap().to_string()).chain(lines.map(line));
    std::fs::write(&other, lines.collect::<Vec<_>>().join("\n") + "\n").unwrap();
    diagnosed(&folder, &other)
}

/// What the scalar alone reads is a fault of it, however much it looks like passing iron.
#[test]
fn what_one_sensor_alone_reads_is_no_target() {
    let diagnosis = rewritten("8", |s, scalar_nt, flux_nt| {
        let u = (s - 150.0) / 2.5;
        (scalar_nt + 20.0 * (1.0 + u * u).powf(-2.5), flux_nt)
    });
    assert!(listed(&diagnosis).is_empty(), "{:?}", listed(&diagnosis));
    assert_ne!(diagnosis["verdict"], "no_gap");
}

/// No dipole on a straight line is what a body reads that heaves as it passes iron: by a fifth of its distance, which is half of the
/// anomaly. What that leaves about each target is no gap.
#[test]
fn iron_that_a_heaving_body_passes_is_no_gap() {
    let times_s = [25.0, 55.0, 85.0, 112.0, 140.0, 170.0, 195.0, 225.0, 255.0, 280.0];
    let peaks_nt = [20.0, 30.0, -18.0, 44.0, 60.0, -12.0, 25.0, 33.0, -40.0, 15.0];
    let diagnosis = rewritten("9", |s, scalar_nt, flux_nt| {
        let above = 1.0 + 0.2 * (std::f64::consts::TAU * s / 6.5).sin();
        let passed = |(at_s, nt): (f64, f64)| {
            let along = (s - at_s) / 2.0;
            let square = above * above + along * along;
            nt * (above * above - 0.5 * along * along) / square.powf(2.5)
        };
        let anomaly_nt: f64 = times_s.into_iter().zip(peaks_nt).map(passed).sum();
        let field_nt = flux_nt.iter().map(|nt| nt * nt).sum::<f64>().sqrt();
        (scalar_nt + anomaly_nt, flux_nt.map(|nt| nt * (1.0 + anomaly_nt / field_nt)))
    });
    assert_eq!(diagnosis["verdict"], "no_gap", "{diagnosis:#}");
    let found = listed(&diagnosis);
    // The lobe that is largest in the fit may be another than that of the target.
    assert_eq!(found.len(), times_s.len());
    assert!(times_s.iter().zip(&found).all(|(at_s, [s, _])| (s - at_s).abs() < 3.0), "{found:?}");
}

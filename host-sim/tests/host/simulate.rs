//! `host-sim simulate` as a user runs it, and that the other commands read what it makes.

use crate::common::{done, of_repository, refused, text};
use tempfile::TempDir;

fn scenario(name: &str) -> String {
    text(&of_repository("scenarios").join(name)).into()
}

#[test]
fn a_preset_becomes_a_recording_that_calibrate_reads() {
    let folder = TempDir::new().unwrap();
    let (out, cal) = (folder.path().join("new/land.csv"), folder.path().join("cal"));
    let (out, cal) = (text(&out), text(&cal));
    assert_eq!(
        done(&["simulate", &scenario("land_calibration.toml"), "--out", out]),
        "6000 rows, seed 1, 65.090 nT in the band.\n"
    );
    done(&["calibrate", out, "--out", cal]);
    let first = std::fs::read(out).unwrap();
    let printed =
        done(&["simulate", &scenario("land_calibration.toml"), "--out", out, "--effect", "scalar_lag:lag_s=0.05"]);
    assert!(printed.contains("scalar_lag: ") && printed.ends_with(" nT rms\n"), "{printed}");
    assert_ne!(std::fs::read(out).unwrap(), first);
    done(&["simulate", &scenario("land_calibration.toml"), "--out", out, "--seed", "1"]);
    assert!(std::fs::read(out).unwrap() == first, "the same seed gives the same bytes");
}

#[test]
fn what_cannot_be_is_refused_and_leaves_nothing() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("rec.csv");
    let (preset, out_text) = (scenario("land_calibration.toml"), text(&out));
    let with = |effect: &str| refused(&["simulate", &preset, "--out", out_text, "--effect", effect]);
    assert!(
        with("scalar_lg:lag_s=1").starts_with("--effect there is no effect \"scalar_lg\"; did you mean scalar_lag?")
    );
    assert!(with("scalar_lag:lag_s=9").contains("lag_s=9 is outside -2 to 2 s"));
    assert!(with("firmware_mismatch").contains("cannot be simulated"));
    assert!(with("depth_gradient:gradient_nT_per_m=1").contains("needs a tow"));
    assert!(with("load_current:load=pump,x_nT=1").contains("a [[current]] named \"pump\""));
    assert!(with("permanent_step:time_s=9999,x_nT=1").contains("outside the recording, 0 to 599.9 s"));
    let bad = folder.path().join("bad.toml");
    std::fs::write(&bad, "duration_s = 60.0\nnonsense = 1\n").unwrap();
    let bad = text(&bad);
    assert!(refused(&["simulate", bad, "--out", out_text]).contains("bad.toml: line 2: unknown field `nonsense`"));
    assert!(refused(&["simulate", "none.toml", "--out", out_text]).starts_with("none.toml: cannot be read"));
    assert!(!out.exists());
}

/// Time, scalar and fluxgate of each row; not a number where nothing is.
fn readings(path: &str) -> Vec<[f64; 5]> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let row = |row: csv::StringRecord| std::array::from_fn(|k| row[k].parse().unwrap_or(f64::NAN));
    reader.records().map(|record| row(record.unwrap())).collect()
}

#[test]
fn through_the_sensors_comes_what_their_formats_resolve() {
    let folder = TempDir::new().unwrap();
    let (direct, through) = (folder.path().join("direct.csv"), folder.path().join("through.csv"));
    let (scenario, direct, through) = (scenario("lake_tow.toml"), text(&direct), text(&through));
    done(&["simulate", &scenario, "--out", direct]);
    let direct = readings(direct);
    for sensor in ["--through-sensors", "--through-sensors=qtfm-gen1"] {
        let printed = done(&["simulate", &scenario, "--out", through, sensor]);
        assert!(printed.ends_with("Through the sensors: 0 scalar and 0 fluxgate readings lost.\n"), "{printed}");
        let through = readings(through);
        assert_eq!(through.len(), direct.len());
        for (sent, sensed) in direct.iter().zip(&through) {
            let off = |k: usize| (sent[k] - sensed[k]).abs();
            // A picotesla; half a count of 0.01 nT, and an f32 at 50,000 nT.
            assert!(off(0) == 0.0 && off(1) < 0.001_1 && (2..5).all(|k| off(k) < 0.009), "{sent:?} {sensed:?}");
        }
    }
}

#[test]
fn what_befalls_the_wires_is_counted() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("rec.csv");
    let (scenario, out) = (scenario("lake_tow.toml"), text(&out));
    let run = |fault: &str| done(&["simulate", &scenario, "--out", out, "--through-sensors", "--fault", fault]);
    let lost = |printed: &str, scalar: usize, fluxgate: usize, counted: &str| {
        let said = format!("Through the sensors: {scalar} scalar and {fluxgate} fluxgate readings lost{counted}.\n");
        assert!(printed.ends_with(&said), "{printed}");
    };
    lost(&run("drop@100+3"), 3, 0, "");
    let rows = readings(out);
    assert!((100..103).all(|row| rows[row][1].is_nan() && !rows[row][2].is_nan()) && !rows[103][1].is_nan());
    lost(&run("damage@100"), 1, 0, ", sentences with a bad number: 1");
    lost(&run("crc@100"), 0, 1, ", damaged frames: 1");
    let refusal = refused(&["simulate", &scenario, "--out", out, "--through-sensors", "--fault", "reset@5"]);
    assert!(refusal.starts_with("--fault: reset, power and panic befall the body"), "{refusal}");
}

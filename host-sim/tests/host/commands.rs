//! The commands as a user runs them: exit codes, what is printed, what is written and what is left alone.

use std::path::{Path, PathBuf};

use crate::common::{done, host_sim, of_repository, refused, text, without_marks};
use serde_json::Value;
use tempfile::TempDir;

fn sample(name: &str) -> PathBuf {
    of_repository("sample").join(name)
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(path: &Path) -> Self {
        let mut reader = csv::Reader::from_path(path).unwrap();
        let header = reader.headers().unwrap().iter().map(String::from).collect();
        let rows = reader.records().map(|row| row.unwrap().iter().map(String::from).collect()).collect();
        Self { header, rows }
    }

    fn column(&self, name: &str) -> Vec<Option<f64>> {
        let index = self.header.iter().position(|header| header == name).unwrap();
        self.rows.iter().map(|row| row[index].parse().ok()).collect()
    }
}

fn std_of(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// A folder with a calibration in it.
fn calibrated() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    done(&["calibrate", text(&sample("calibration.csv")), "--out", text(&folder.path().join("cal"))]);
    folder
}

#[test]
fn the_sample_is_what_the_program_makes() {
    let folder = tempfile::tempdir().unwrap();
    done(&["sample", "--out", text(folder.path())]);
    for name in ["calibration.csv", "survey.csv", "survey.targets.csv"] {
        assert!(std::fs::read(folder.path().join(name)).unwrap() == std::fs::read(sample(name)).unwrap(), "{name}");
    }
}

#[test]
fn calibrate_writes_what_replay_needs() {
    let folder = calibrated();
    let cal = folder.path().join("cal");
    let summary = json(&cal.join("summary.json"));
    assert_eq!((&summary["schema"], &summary["method"]), (&Value::from(1), &Value::from("elastic-net")));
    // The first row has no derivative; none is lost to settling.
    assert_eq!((summary["rows"].as_u64(), summary["used_rows"].as_u64()), (Some(3600), Some(3600 - 1)));
    assert!(summary["improvement_ratio"].as_f64().unwrap() > 50.0);
    for key in ["coefficients", "coefficient_std"] {
        assert!(summary[key].as_array().unwrap().iter().all(Value::is_number) && summary[key][17].is_number());
    }
    let file = std::fs::read_to_string(cal.join("coefficients.toml")).unwrap();
    assert!(file.starts_with("schema = 1\n") && file.matches("[[term]]").count() == 18);
    assert!(std::fs::read_to_string(cal.join("report.html")).unwrap().starts_with("<!DOCTYPE html>"));
}

#[test]
fn replay_writes_the_recording_and_what_became_of_it() {
    let folder = calibrated();
    let (coefficients, out) = (folder.path().join("cal/coefficients.toml"), folder.path().join("out"));
    let survey = without_marks(folder.path());
    for method in ["none", "fixed", "rls", "saddle-point", "adaptive"] {
        let printed = done(&[
            "replay",
            text(&survey),
            "--coefficients",
            text(&coefficients),
            "--method",
            method,
            "--out",
            text(&out),
            "--json",
        ]);
        let summary = json(&out.join("summary.json"));
        assert_eq!(serde_json::from_str::<Value>(&printed).unwrap(), summary);
        let table = Table::read(&out.join("compensated.csv"));
        let input = Table::read(&survey);
        assert_eq!(table.header[..6], input.header[..]);
        let added = [
            "interference_nT",
            "compensated_nT",
            "residual_nT",
            "residual_after_update_nT",
            "valid",
            "predicted_std_nT",
            "adapted_share",
            "adaptation",
        ];
        assert_eq!(table.header[6..], added);
        assert!(table.rows.iter().zip(&input.rows).all(|(row, input)| row[..6] == input[..]));
        assert_eq!(table.rows.len(), 599);
        assert_eq!(table.rows[0][6..11], ["", "", "", "", "0"]);
        assert!(table.rows[1..].iter().all(|row| row[10] == "1"));

        let [scalar, interference, compensated, residual] =
            ["scalar_nT", "interference_nT", "compensated_nT", "residual_nT"]
                .map(|name| table.column(name)[1..].iter().map(|value| value.unwrap()).collect::<Vec<f64>>());
        let off = |i: usize| (scalar[i] - interference[i] - compensated[i]).abs();
        assert!((0..scalar.len()).all(|i| off(i) < 2e-6));
        let std_after = summary["std_after_nT"].as_f64().unwrap();
        assert!((std_of(&residual) / std_after - 1.0).abs() < 1e-6, "{method}");
    }
}

/// The interference of fixed coefficients, straight from eq. (4).
#[test]
fn fixed_interference_is_a_beta() {
    let folder = calibrated();
    let (coefficients, out) = (folder.path().join("cal/coefficients.toml"), folder.path().join("out"));
    let survey = without_marks(folder.path());
    let from = text(&coefficients);
    done(&["replay", text(&survey), "--coefficients", from, "--method", "fixed", "--out", text(&out)]);
    let summary = json(&out.join("summary.json"));
    let beta: Vec<f64> = summary["coefficients"].as_array().unwrap().iter().map(|b| b.as_f64().unwrap()).collect();
    let table = Table::read(&out.join("compensated.csv"));
    let [x, y, z] = ["flux_x_nT", "flux_y_nT", "flux_z_nT"].map(|name| table.column(name));
    let cosines = |i: usize| {
        let f = [x[i].unwrap(), y[i].unwrap(), z[i].unwrap()];
        let magnitude = f.iter().map(|c| c * c).sum::<f64>().sqrt();
        (magnitude, f.map(|c| c / magnitude))
    };
    for (i, interference) in table.column("interference_nT").into_iter().enumerate().skip(1) {
        let ((magnitude, u), (_, before)) = (cosines(i), cosines(i - 1));
        let mut expected = u[0] * beta[0] + u[1] * beta[1] + u[2] * beta[2];
        for (k, (a, b)) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].into_iter().enumerate() {
            expected += magnitude * u[a] * u[b] * beta[3 + k];
        }
        for k in 0..9 {
            expected += magnitude * u[k / 3] * (u[k % 3] - before[k % 3]) / 0.1 * beta[9 + k];
        }
        let interference = interference.unwrap();
        assert!((interference - expected).abs() < 1e-3, "row {i}: {interference} nT, not {expected}");
    }
}

#[test]
fn compare_shows_every_method() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let printed =
        done(&["compare", text(&sample("calibration.csv")), text(&sample("survey.csv")), "--out", text(&out)]);
    let summary = json(&out.join("summary.json"));
    let methods = summary["methods"].as_array().unwrap();
    let names: Vec<_> = methods.iter().map(|method| method["method"].as_str().unwrap()).collect();
    assert_eq!(names, ["none", "fixed", "rls", "saddle-point", "adaptive"]);
    assert!(names.iter().all(|name| printed.lines().any(|line| line.starts_with(name))), "{printed}");
    // The badge is not for the quietest: on the sample `rls` has eaten a part of the targets.
    let kept = |i: usize| summary["targets"]["methods"][i]["kept"].as_f64().unwrap();
    assert!(kept(1) < 0.9 && kept(3) > 0.94, "{}", summary["targets"]);
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    let (_, best) = page.split_once("<tr class=\"best\">").unwrap();
    assert!(best[..300].contains("adaptive <small>best"), "{}", &best[..300]);
    assert!(page.contains("as survey.targets.csv tells: +6 nT at 371 s, +9 nT at 507 s"));
    assert!(page.contains("late, with the sign turned"), "the delay of the residual is said");
    let after = |i: usize| methods[i]["std_after_nT"].as_f64().unwrap();
    assert!(after(2) < after(1) && after(3) < after(1) && after(1) < after(0));
}

/// Coefficients that change must not write steps into the compensated field.
#[test]
fn compensated_level_is_steady_while_coefficients_change() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    done(&["replay", text(&sample("survey.csv")), "--method", "rls", "--out", text(&out)]);
    let table = Table::read(&out.join("compensated.csv"));
    let field: Vec<f64> = table.column("compensated_nT").into_iter().flatten().skip(2000).collect();
    let steepest = field.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    assert!(steepest < 10.0, "{steepest} nT in one epoch");
}

#[test]
fn gaps_and_invalid_rows_are_marked() {
    let folder = tempfile::tempdir().unwrap();
    let (recording, out) = (folder.path().join("rec.csv"), folder.path().join("out"));
    let survey = std::fs::read_to_string(sample("survey.csv")).unwrap();
    let mut lines: Vec<String> = survey.lines().take(1001).map(|line| format!("{line},1")).collect();
    lines[0] = lines[0].replace(",1", ",scalar_valid");
    lines[500] = format!("{},rubbish,nan,,x,,0", lines[500].split(',').next().unwrap());
    lines[700] =
        lines[700].split(',').enumerate().map(|(i, f)| if i == 1 { "" } else { f }).collect::<Vec<_>>().join(",");
    lines.remove(800);
    std::fs::write(&recording, lines.join("\n")).unwrap();
    done(&["replay", text(&recording), "--out", text(&out)]);
    let table = Table::read(&out.join("compensated.csv"));
    let invalid: Vec<usize> =
        table.column("valid").iter().enumerate().filter(|(_, valid)| **valid == Some(0.0)).map(|(i, _)| i).collect();
    assert_eq!(invalid, [0, 499, 500, 699, 700, 799]);
    assert_eq!(table.rows[499][1..3], ["rubbish", "nan"]);
    assert_eq!(json(&out.join("summary.json"))["used_rows"], 999 - 6);
}

#[test]
fn an_earlier_compensation_is_replaced_not_repeated() {
    let folder = tempfile::tempdir().unwrap();
    let [once, twice] = ["once", "twice"].map(|name| folder.path().join(name));
    done(&["replay", text(&without_marks(folder.path())), "--out", text(&once)]);
    done(&["replay", text(&once.join("compensated.csv")), "--out", text(&twice)]);
    let same = |name: &str| std::fs::read(once.join(name)).unwrap() == std::fs::read(twice.join(name)).unwrap();
    let summary = |of: &Path| {
        let mut summary = json(&of.join("summary.json"));
        let provenance = summary.as_object_mut().unwrap().remove("provenance").unwrap();
        (summary, provenance["inputs"][0]["sha256"].clone())
    };
    let [(of_once, source), (of_twice, again)] = [summary(&once), summary(&twice)];
    assert!(same("compensated.csv") && of_once == of_twice && source != again);
    let refusal = refused(&["replay", text(&once.join("compensated.csv")), "--out", text(&once)]);
    assert!(refusal.contains("choose another --out"), "{refusal}");
}

#[test]
fn bad_input_is_one_line_and_leaves_everything_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let (recording, out) = (folder.path().join("rec.csv"), folder.path().join("out"));
    let survey = std::fs::read_to_string(sample("survey.csv")).unwrap();
    let mut lines: Vec<&str> = survey.lines().collect();
    lines[4000] = "399.9,4857o.1,1,2,3,4";
    std::fs::write(&recording, lines.join("\n")).unwrap();
    let run = || refused(&["replay", text(&recording), "--strict", "--out", text(&out)]);
    let line = run();
    assert_eq!(line, format!("{}:4001: scalar_nT: \"4857o.1\" is not a number", recording.display()));
    assert!(!out.exists());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    done(&["replay", text(&without_marks(folder.path())), "--out", text(&out)]);
    let before = std::fs::read(out.join("compensated.csv")).unwrap();
    run();
    assert!(std::fs::read(out.join("compensated.csv")).unwrap() == before);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
}

#[test]
fn what_cannot_be_done_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let survey = sample("survey.csv");
    assert!(refused(&["replay", "no-such.csv", "--out", text(&out)]).starts_with("no-such.csv: cannot be read"));
    assert!(
        refused(&["replay", text(&survey), "--method", "fixed", "--out", text(&out)]).contains("host-sim calibrate")
    );
    assert_eq!(
        refused(&["replay", text(&survey), "--forgetting", "0.5", "--out", text(&out)]),
        "forgetting is 0.5: choose above 0.9, at most 1"
    );
    assert!(
        refused(&["replay", text(&survey), "--band-high-hz", "6", "--out", text(&out)])
            .contains("half the sample rate")
    );
    assert!(
        refused(&["replay", text(&survey), "--coefficients", text(&survey), "--out", text(&out)])
            .contains("survey.csv: line 1")
    );
    let short = folder.path().join("short.csv");
    let text_of = std::fs::read_to_string(&survey).unwrap();
    std::fs::write(&short, text_of.lines().take(500).collect::<Vec<_>>().join("\n")).unwrap();
    let line = refused(&["calibrate", text(&short), "--out", text(&out)]);
    assert!(line.ends_with("49.9 s of valid rows, a calibration needs at least 60 s"), "{line}");
    assert!(!out.exists());
    assert_eq!(host_sim(&["replay"]).status.code(), Some(2));
}

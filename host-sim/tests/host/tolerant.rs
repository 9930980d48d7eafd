//! Recordings as recorders write them: a bad row here and there is carried through, counted and not used.

use std::path::{Path, PathBuf};

use crate::common::{done, host_sim, of_repository, refused, text};
use serde_json::{Value, json};
use tempfile::TempDir;

/// So many rows have a replay without a survey for the marks on its page, which takes nearly all of its time.
const WITHOUT_MARKS: usize = 590;

/// Header and rows of the sample survey.
fn survey(rows: usize) -> Vec<String> {
    let text = std::fs::read_to_string(of_repository("sample/survey.csv")).unwrap();
    text.lines().take(rows + 1).map(String::from).collect()
}

fn with_field(line: &str, at: usize, value: &str) -> String {
    line.split(',').enumerate().map(|(i, field)| if i == at { value } else { field }).collect::<Vec<_>>().join(",")
}

struct Replayed {
    folder: TempDir,
    summary: Value,
    stderr: String,
}

impl Replayed {
    fn of(lines: &[String]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let recording = saved(&folder, &(lines.join("\n") + "\n"));
        let out = folder.path().join("out");
        let output = host_sim(&["replay", text(&recording), "--out", text(&out)]);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{stderr}");
        let summary = serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
        Self { folder, summary, stderr }
    }

    fn file(&self, name: &str) -> String {
        std::fs::read_to_string(self.folder.path().join("out").join(name)).unwrap()
    }

    fn rows(&self) -> Vec<String> {
        self.file("compensated.csv").lines().skip(1).map(String::from).collect()
    }

    fn kinds(&self) -> Vec<(String, u64)> {
        let kinds = self.summary["bad_rows"]["kinds"].as_object().unwrap().iter();
        kinds.map(|(name, count)| (name.clone(), count.as_u64().unwrap())).filter(|(_, count)| *count > 0).collect()
    }
}

fn saved(folder: &TempDir, text: &str) -> PathBuf {
    let path = folder.path().join("rec.csv");
    std::fs::write(&path, text).unwrap();
    path
}

fn refusal(text_of: &str, options: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (recording, out) = (saved(&folder, text_of), folder.path().join("out"));
    let line = refused(&[&["replay", text(&recording), "--out", text(&out)], options].concat());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left behind");
    line
}

/// Everything of a row but the field `at`.
fn without_field(row: &str, at: usize) -> Vec<&str> {
    row.split(',').enumerate().filter(|(i, _)| *i != at).map(|(_, field)| field).collect()
}

#[test]
fn bad_values_are_as_good_as_missing_ones() {
    let good = survey(500);
    let (mut bad, mut empty) = (good.clone(), good);
    let values = [(150, 1, "*"), (200, 2, "NaN"), (250, 1, "-99999"), (300, 4, "1e32"), (350, 3, "n/a"), (400, 1, "0")];
    for (line, column, value) in values {
        bad[line] = with_field(&bad[line], column, value);
        empty[line] = with_field(&empty[line], column, "");
    }
    let (bad, empty) = (Replayed::of(&bad), Replayed::of(&empty));
    let (rows, expected) = (bad.rows(), empty.rows());
    assert_eq!(rows.len(), 500);
    for (row, (is, should)) in rows.iter().zip(&expected).enumerate() {
        match values.iter().find(|(line, ..)| *line == row + 1) {
            Some((_, column, value)) => {
                assert_eq!(is.split(',').nth(*column), Some(*value), "the field as it was");
                assert_eq!(without_field(is, *column), without_field(should, *column));
                assert_eq!(is.split(',').nth(10), Some("0"));
            }
            None => assert_eq!(is, should),
        }
    }
    assert_eq!(bad.kinds(), [("not_a_number".to_string(), 3), ("out_of_range".to_string(), 3)]);
    assert_eq!(bad.summary["used_rows"], empty.summary["used_rows"]);
    let bad_rows = &bad.summary["bad_rows"];
    assert_eq!((&bad_rows["count"], &bad_rows["share"]), (&json!(6), &json!(0.012)));
    let first = json!({"line": 151, "column": "scalar_nT", "what": "\"*\" is not a number"});
    assert_eq!((&bad_rows["first"][0], bad_rows["first"].as_array().unwrap().len()), (&first, 6));
    let said = "6 of 500 rows are bad input, carried through and not used (not_a_number 3, out_of_range 3); the first: \
                line 151, scalar_nT: ";
    assert!(bad.stderr.starts_with(&format!("warning: {said}")) && bad.stderr.lines().count() == 1, "{}", bad.stderr);
    assert!(bad.file("report.html").contains(said));
    assert!(empty.summary.get("bad_rows").is_none() && empty.stderr.is_empty());
}

#[test]
fn times_that_are_wrong_move_no_other_row() {
    let good = survey(WITHOUT_MARKS);
    let expected = Replayed::of(&good).rows();
    let mut lines = good;
    // Three more rows: one twice, one much too late in the file, one half an epoch too early.
    lines.insert(201, lines[200].clone());
    lines.insert(351, lines[50].clone());
    let early = with_field(&lines[500], 0, "49.72");
    lines.insert(501, early);
    let replayed = Replayed::of(&lines);
    let names = ["backward_time", "repeated_time", "short_step"];
    assert_eq!(replayed.kinds(), names.map(|name| (name.to_string(), 1)));
    let mut rows = replayed.rows();
    for extra in [500, 350, 200] {
        let row = rows.remove(extra);
        assert_eq!(row.split(',').nth(10), Some("0"), "{row}");
    }
    assert!(rows == expected, "bit for bit what it is without them");
}

#[test]
fn a_time_that_runs_ahead_is_told_from_a_gap() {
    let lines = survey(WITHOUT_MARKS);
    for (at, time) in [(1, "1e9"), (200, "9999.9"), (300, "1e32"), (400, "-99999")] {
        let mut spoilt = lines.clone();
        spoilt[at] = with_field(&spoilt[at], 0, time);
        let mut removed = lines.clone();
        removed.remove(at);
        let (mut rows, expected) = (Replayed::of(&spoilt).rows(), Replayed::of(&removed).rows());
        assert!(rows.remove(at - 1).split(',').nth(10) == Some("0") && rows == expected, "{time}");
    }
    let mut gap = lines;
    gap.drain(200..300);
    assert!(Replayed::of(&gap).summary.get("bad_rows").is_none());
}

#[test]
fn midnight_is_no_step_back() {
    let lines = survey(WITHOUT_MARKS);
    let of_day = |line: &String, start: f64| {
        let seconds: f64 = line.split(',').next().unwrap().parse().unwrap();
        with_field(line, 0, &format!("{:.1}", (start + seconds) % 86_400.0))
    };
    let at = |start: f64| {
        let rows = lines[1..].iter().map(|line| of_day(line, start));
        std::iter::once(lines[0].clone()).chain(rows).collect::<Vec<_>>()
    };
    let (noon, midnight) = (Replayed::of(&at(43_200.0)), Replayed::of(&at(86_370.0)));
    let behind_time = |replayed: &Replayed| -> Vec<String> {
        replayed.rows().iter().map(|row| row.split_once(',').unwrap().1.to_string()).collect()
    };
    assert!(behind_time(&noon) == behind_time(&midnight));
    assert_eq!(midnight.summary["bad_rows"]["count"], 0);
    assert_eq!(midnight.summary["bad_rows"]["midnight_lines"], json!([302]));
    assert!(midnight.stderr.starts_with("warning: The time of day begins anew at midnight in line 302"));
    assert!(midnight.rows()[300].starts_with("0.0,"), "the field as it was");
    let strict = refusal(&(at(86_370.0).join("\n")), &["--strict"]);
    assert!(strict.contains(":302: time_s: 0 does not come after 86399.9"), "{strict}");
}

#[test]
fn a_last_line_that_is_cut_is_left_out_wherever_it_is_cut() {
    let lines = survey(WITHOUT_MARKS);
    let whole = Replayed::of(&lines[..WITHOUT_MARKS]).rows();
    let text_of = lines.join("\n");
    let last = lines[WITHOUT_MARKS].len();
    let folder = tempfile::tempdir().unwrap();
    for cut in [1, 2, 6, last / 2, last - 8] {
        let (recording, out) = (saved(&folder, &text_of[..text_of.len() - cut]), folder.path().join("out"));
        done(&["replay", text(&recording), "--out", text(&out)]);
        let compensated = std::fs::read_to_string(out.join("compensated.csv")).unwrap();
        let rows: Vec<&str> = compensated.lines().skip(1).collect();
        let (cut_row, before) = rows.split_last().unwrap();
        assert!(rows.len() == WITHOUT_MARKS && before == whole, "{cut}");
        let summary: Value = serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
        assert_eq!(cut_row.split(',').nth(10), Some("0"), "{cut}: {cut_row}");
        assert_eq!(summary["bad_rows"]["kinds"]["truncated_line"], 1, "{cut}");
    }
}

#[test]
fn above_a_tenth_the_file_is_refused_with_what_it_looks_like() {
    let mut lines = survey(1000);
    lines[501..=600].iter_mut().for_each(|line| *line = with_field(line, 1, "-99999"));
    let tenth = Replayed::of(&lines);
    assert_eq!(tenth.summary["bad_rows"]["count"], 100);
    assert_eq!(tenth.summary["bad_rows"]["first"].as_array().unwrap().len(), 20);
    lines[700] = with_field(&lines[700], 1, "*");
    let line = refusal(&lines.join("\n"), &[]);
    for words in
        [":502: scalar_nT: 101 of 1,000 rows are bad", "mostly out_of_range (100)", "another unit", "host-sim import"]
    {
        assert!(line.contains(words), "{line}");
    }
    let strict = refusal(&lines.join("\n"), &["--strict"]);
    assert!(strict.ends_with(":502: scalar_nT: -99999 nT is outside 1000 to 100000 nT"), "{strict}");
}

#[test]
fn another_rate_is_refused_with_its_figure_and_the_remedy() {
    let lines = survey(1000);
    for rate_hz in [20.0, 8.0, 1.0, 160.0] {
        let row = |(i, line): (usize, &String)| with_field(line, 0, &(i as f64 / rate_hz).to_string());
        let rows = lines[1..].iter().enumerate().map(row);
        let text_of = std::iter::once(lines[0].clone()).chain(rows).collect::<Vec<_>>().join("\n");
        let line = refusal(&text_of, &[]);
        assert!(
            line.contains(&format!("the recording has {rate_hz} Hz, and 10 Hz are needed: `host-sim import ")),
            "{line}"
        );
    }
}

#[test]
fn calibrate_compare_and_diagnose_read_past_bad_rows_too() {
    let folder = tempfile::tempdir().unwrap();
    let spoil = |name: &str, rows: usize| {
        let whole = std::fs::read_to_string(of_repository("sample").join(name)).unwrap();
        let mut lines: Vec<String> = whole.lines().take(rows + 1).map(String::from).collect();
        lines[100] = with_field(&lines[100], 1, "*");
        lines.insert(200, lines[199].clone());
        let path = folder.path().join(name);
        std::fs::write(&path, lines.join("\n") + "\n").unwrap();
        path
    };
    let (calibration, survey) = (spoil("calibration.csv", 3600), spoil("survey.csv", 1200));
    let summary_of = |out: &Path, name: &str| -> Value {
        serde_json::from_str(&std::fs::read_to_string(out.join(name)).unwrap()).unwrap()
    };
    let out = |name: &str| folder.path().join(name);
    done(&["calibrate", text(&calibration), "--out", text(&out("cal"))]);
    assert_eq!(summary_of(&out("cal"), "summary.json")["bad_rows"]["count"], 2);
    done(&["compare", text(&calibration), text(&survey), "--anomalies", "2", "--out", text(&out("compared"))]);
    let compared = summary_of(&out("compared"), "summary.json");
    assert_eq!(
        (&compared["calibration_bad_rows"]["count"], &compared["methods"][0]["bad_rows"]["count"]),
        (&json!(2), &json!(2))
    );
    done(&["diagnose", text(&survey), "--out", text(&out("diagnosed"))]);
    let diagnosed = summary_of(&out("diagnosed"), "diagnosis.json");
    assert_eq!(diagnosed["bad_rows"]["count"], 2);
    assert!(
        std::fs::read_to_string(out("diagnosed").join("report.html"))
            .unwrap()
            .contains("2 of 1,201 rows are bad input")
    );
    assert!(
        refused(&["diagnose", text(&survey), "--strict", "--out", text(&out("strict"))]).contains(":101: scalar_nT")
    );
}

#[test]
fn coefficients_of_other_axes_are_told_with_the_axes() {
    let folder = tempfile::tempdir().unwrap();
    let calibrated = folder.path().join("cal");
    done(&["calibrate", text(&of_repository("sample/calibration.csv")), "--out", text(&calibrated)]);
    let coefficients = calibrated.join("coefficients.toml");
    let mut lines = survey(3000);
    let replayed = |lines: &[String]| {
        let (recording, out) = (saved(&folder, &lines.join("\n")), folder.path().join("out"));
        let arguments = ["replay", text(&recording), "--coefficients", text(&coefficients), "--out", text(&out)];
        let output = host_sim(&arguments);
        assert_eq!(output.status.code(), Some(0));
        let summary: Value = serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
        let page = std::fs::read_to_string(out.join("report.html")).unwrap();
        (summary, String::from_utf8(output.stderr).unwrap(), page)
    };
    let (fits, said, _) = replayed(&lines);
    assert!(fits.get("warnings").is_none() && said.is_empty(), "{said}");
    for line in &mut lines[1..] {
        let up = -line.split(',').nth(4).unwrap().parse::<f64>().unwrap();
        *line = with_field(line, 4, &format!("{up:.2}"));
    }
    let (summary, said, page) = replayed(&lines);
    let warning = summary["warnings"][0].as_str().unwrap();
    assert!(warning.contains("z points the other way than in the calibration"), "{warning}");
    assert_eq!(said, format!("warning: {warning}\n"));
    assert!(page.contains("z points the other way than in the calibration"));
}

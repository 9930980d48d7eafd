//! What cannot be surveyed, and that nothing is left of it.

use std::path::Path;

use tempfile::TempDir;

use super::tow::Tow;
use crate::common::{refused, text};

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_bad_row_is_named_by_file_line_and_column_and_the_last_result_stays() {
    let folder = folder();
    let mut tow = Tow::two_minutes();
    let good = tow.written(folder.path(), "good.csv");
    tow.rows[130][1] = "5o123.4".into();
    let bad = tow.written(folder.path(), "bad.csv");
    let out = folder.path().join("out");
    crate::common::done(&["survey", text(&good), "--no-diagnose", "--out", text(&out)]);
    let before = std::fs::read(out.join("levelled.csv")).unwrap();
    let said = refused(&["survey", text(&good), text(&bad), "--strict", "--out", text(&out)]);
    assert_eq!(said, format!("{}:132: scalar_nT: \"5o123.4\" is not a number", bad.display()));
    assert_eq!(std::fs::read(out.join("levelled.csv")).unwrap(), before);
    let fresh = folder.path().join("fresh");
    refused(&["survey", text(&bad), "--strict", "--out", text(&fresh)]);
    assert_eq!(names(folder.path()), ["bad.csv", "good.csv", "out"]);
}

#[test]
fn what_an_option_needs_and_is_not_there_is_said() {
    let folder = folder();
    let out = folder.path().join("out");
    let rec = Tow::sample().with_positions().written(folder.path(), "rec.csv");
    let base = folder.path().join("base.csv");
    std::fs::write(&base, "utc_s,scalar_nT\n1700000000,50000\n1700000060,50001\n").unwrap();
    let short = folder.path().join("short.csv");
    std::fs::write(&short, "time_s,scalar_nT\n0,50000\n60,50001\n").unwrap();
    let no_field = folder.path().join("field.csv");
    std::fs::write(&no_field, "time_s,temperature\n0,20.5\n60,20.6\n").unwrap();
    let no_time = folder.path().join("time.csv");
    std::fs::write(&no_time, "when,scalar_nT\n0,50000\n60,50001\n").unwrap();
    for (options, what) in [
        (vec!["--ship-position"], "cable_out_m is missing in more than a tenth of the rows"),
        (vec!["--layback-m", "-3"], "--layback-m -3: must be 0 or more"),
        (
            vec!["--tow-point-m", "5"],
            "--tow-point-m: is of the ship's positions: give --ship-position or --layback-m too",
        ),
        (vec!["--catenary", "0.9"], "--catenary: is of the ship's positions"),
        (vec!["--base", text(&base)], "has no utc_s, and the base station's times are UTC"),
        (vec!["--base", text(&short)], "the base station covers 10 % of its rows"),
        (vec!["--base", text(&no_field)], "needs its total field"),
        (vec!["--base", text(&no_time)], "needs its times in utc_s"),
        (vec!["--base", "nowhere.csv"], "nowhere.csv: cannot be read"),
        (vec!["--grid-m", "0"], "--grid-m 0: must be above 0 m"),
        (vec!["--grid-m", "0.001"], "give larger ones"),
        (vec!["--false-alarms-per-hour", "0"], "must be above 0"),
        (vec!["--navigation-lag-s", "inf"], "must be a finite number"),
        (vec!["--coefficients", "nowhere.toml"], "nowhere.toml: cannot be read"),
    ] {
        let mut arguments = vec!["survey", text(&rec), "--out", text(&out)];
        // A negative number is no option.
        let joined = options.join("=");
        if options.len() == 2 {
            arguments.push(&joined)
        } else {
            arguments.extend(&options)
        }
        let said = refused(&arguments);
        assert!(said.contains(what), "{said}");
        assert!(!out.exists(), "{said}");
    }
}

#[test]
fn too_little_is_refused() {
    let folder = folder();
    let mut tow = Tow::sample();
    tow.rows.truncate(599);
    let rec = tow.written(folder.path(), "rec.csv");
    let said = refused(&["survey", text(&rec), "--out", text(&folder.path().join("out"))]);
    assert_eq!(said, "rec.csv: 59.9 s of valid rows, a survey needs at least 60 s");
}

#[test]
fn what_it_reads_is_never_replaced() {
    let folder = folder();
    let rec = Tow::sample().written(folder.path(), "levelled.csv");
    let said = refused(&["survey", text(&rec), "--out", text(folder.path())]);
    assert!(said.contains("would be replaced by a result"), "{said}");
    let theirs = folder.path().join("theirs");
    std::fs::create_dir(&theirs).unwrap();
    std::fs::write(theirs.join("contacts.csv"), "mine").unwrap();
    refused(&["survey", text(&rec), "--out", text(&theirs)]);
    assert_eq!(std::fs::read_to_string(theirs.join("contacts.csv")).unwrap(), "mine");
}

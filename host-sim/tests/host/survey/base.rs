//! A base station, whoever tells it, and what is wrong with it.

use super::files::{folder, json, survey_alone};
use super::tow::Tow;
use crate::common::text;

#[test]
fn the_change_with_the_day_is_taken_away_whoever_tells_it() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    // 1 nT in a minute, 5 in all; 2026-06-01 12:00 UTC.
    let (start_s, drift_nt) = (1_780_315_200.0, |time_s: f64| 48_000.0 + time_s / 60.0);
    let utc = move |row: usize| format!("{:.1}", start_s + row as f64 / 10.0);
    let plain = Tow::beginning().with("utc_s", utc);
    let column = plain.clone().with("base_nT", |row| format!("{:.3}", drift_nt(row as f64 / 10.0)));
    let [plain, column] = [plain.written(folder.path(), "plain.csv"), column.written(folder.path(), "column.csv")];
    let minutes =
        |line: &dyn Fn(f64) -> String| (-1..12).map(|minute| line(f64::from(minute) * 60.0)).collect::<String>();
    let table = minutes(&|time_s| format!("{time_s},{}\n", drift_nt(time_s)));
    std::fs::write(path("base.csv"), format!("time_s,scalar_nT\n{table}")).unwrap();
    let iaga = minutes(&|time_s| {
        let (hour, minute) = if time_s < 0.0 { (11, 59) } else { (12, time_s as u32 / 60) };
        format!("2026-06-01 {hour:02}:{minute:02}:00.000 152  99999.00  99999.00  99999.00  {:.2}\n", drift_nt(time_s))
    });
    let head = " Format                 IAGA-2002                                    |\n\
                 \x20IAGA CODE              XXX                                          |\n\
                 DATE       TIME         DOY     XXXX      XXXY      XXXZ      XXXF   |\n";
    std::fs::write(path("base.min"), format!("{head}{iaga}")).unwrap();
    survey_alone(&[&plain], &[], &path("none"));
    let field = |name: &str| Tow::read(&path(name).join("levelled.csv")).numbers("field_nT");
    let without = field("none");
    for (recording, options) in [
        (&column, vec![]),
        (&plain, vec!["--base".to_string(), text(&path("base.csv")).into()]),
        (&plain, vec!["--base".to_string(), text(&path("base.min")).into()]),
    ] {
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        survey_alone(&[recording], &options, &path("with"));
        let with = field("with");
        let change = |row: usize| without[row].unwrap() - with[row].unwrap();
        // Over four minutes, whatever the constant.
        let drift_nt = change(2700) - change(300);
        assert!((drift_nt - 4.0).abs() < 0.25, "{options:?}: {drift_nt}");
    }
}

#[test]
fn what_is_wrong_with_a_base_station_is_left_out_or_said() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let rec = Tow::beginning().written(folder.path(), "rec.csv");
    let surveyed = |field_nt: &dyn Fn(u32) -> f64| {
        let table: String = (0..320).map(|second| format!("{second},{:.2}\n", field_nt(second))).collect();
        std::fs::write(path("base.csv"), format!("time_s,scalar_nT\n{table}")).unwrap();
        survey_alone(&[&rec], &["--base", text(&path("base.csv"))], &path("out"));
        let said = json(&path("out/summary.json"))["warnings"].to_string();
        (Tow::read(&path("out/levelled.csv")).numbers("field_nT"), said)
    };
    let quiet = |second: u32| 48_000.0 + 0.001 * f64::from(second);
    let (field, said) = surveyed(&quiet);
    assert!(!said.contains("base"), "{said}");
    let wrong = |second: u32| match second {
        100 => 48_300.0,
        180..=185 => 99_999.0,
        _ => quiet(second),
    };
    let (with_outliers, said) = surveyed(&wrong);
    assert!(said.contains("base.csv: 7 readings were not used"), "{said}");
    let off = field.iter().zip(&with_outliers).filter_map(|(a, b)| Some((a.as_ref()? - b.as_ref()?).abs()));
    let off_nt = off.fold(0.0, f64::max);
    assert!(off_nt < 0.02, "{off_nt} nT");
    // Changes that are not in the recording, and none at all.
    let (_, said) = surveyed(&|second| 48_000.0 + 20.0 * (f64::from(second) / 15.0).sin());
    assert!(said.contains("of the base station's changes the recording shows"), "{said}");
}

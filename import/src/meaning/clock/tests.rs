//! Times of every form.

use std::sync::Arc;

use super::*;

const ROWS: usize = 40;
/// date -u -d '2026-11-22 10:30:00' +%s
const UTC_S: f64 = 1_795_343_400.0;
const OF_DAY_S: f64 = 37_800.0;

fn numbers(name: &str, value: impl Fn(f64) -> f64) -> SourceColumn {
    SourceColumn::numbers(name, (0..ROWS).map(|row| value(row as f64 * 0.1)).collect())
}

fn texts(name: &str, text: impl Fn(f64) -> String) -> SourceColumn {
    let values = Values::Text((0..ROWS).map(|row| Arc::from(text(row as f64 * 0.1))).collect());
    SourceColumn { name: name.into(), unit: None, values, dummy: None }
}

fn table(columns: Vec<SourceColumn>) -> SourceTable {
    SourceTable { rows: ROWS, columns, ..SourceTable::default() }
}

fn read_of(columns: Vec<SourceColumn>) -> Times {
    times("a.csv", &table(columns), &TimeProfile::default()).unwrap()
}

/// Steps of 0.1 s from this time on.
fn assert_from(times: &Times, first_s: f64, slack_s: f64, what: &str) {
    for (row, second) in times.seconds.iter().enumerate() {
        let wanted = first_s + row as f64 * 0.1;
        assert!((second - wanted).abs() <= slack_s, "{what}: row {row} is at {second}, not {wanted}");
    }
}

fn clock_of(second: f64) -> String {
    let (hour, minute) = ((second / 3600.0).floor(), (second / 60.0).floor() % 60.0);
    format!("{hour:02}:{minute:02}:{:04.1}", second % 60.0)
}

#[test]
fn numbers_of_any_unit_are_seconds() {
    use TimeForm::{Days, Microseconds, Milliseconds, Nanoseconds, Seconds};
    let spreadsheet = 25_569.0 + UTC_S / 86_400.0;
    let matlab = 719_529.0 + UTC_S / 86_400.0;
    let columns = [
        (numbers("time", |s| 12.0 + s), Seconds, 12.0),
        (numbers("time_ms", |s| (12.0 + s) * 1e3), Milliseconds, 12.0),
        (numbers("millis", |s| (12.0 + s) * 1e3), Milliseconds, 12.0),
        (numbers("Timestamp", |s| (12.0 + s) * 1e3).in_unit("ms"), Milliseconds, 12.0),
        (numbers("time", |s| (12.0 + s) * 1e6), Microseconds, 12.0),
        (numbers("time_ns", |s| (12.0 + s) * 1e9), Nanoseconds, 12.0),
        (numbers("unix", |s| UTC_S + s), Seconds, UTC_S),
        (numbers("timestamp", |s| (UTC_S + s) * 1e3), Milliseconds, UTC_S),
        (numbers("timestamp", |s| (UTC_S + s) * 1e6), Microseconds, UTC_S),
        (numbers("timestamp", |s| (UTC_S + s) * 1e9), Nanoseconds, UTC_S),
        (numbers("DateTime", |s| spreadsheet + s / 86_400.0), Days, UTC_S),
        (numbers("DateTime", |s| matlab + s / 86_400.0), Days, UTC_S),
    ];
    for (column, form, first_s) in columns {
        let what = format!("{} as {form:?}", column.name);
        let times = read_of(vec![column, numbers("mag", |s| 50_000.0 + s.sin())]);
        assert_eq!(times.profile.form, Some(form), "{what}");
        // A number of days leaves 10 us of a second.
        assert_from(&times, first_s, if form == Days { 2e-5 } else { 1e-6 }, &what);
        assert_eq!(times.is_utc, first_s == UTC_S, "{what}");
    }
}

#[test]
fn a_column_named_by_its_unit_is_in_it_whatever_its_steps() {
    for name in ["seconds", "Sec", "time [s]"] {
        let (name, unit) = crate::text::name_and_unit(name);
        let column = numbers(&name, |s| s * 600.0).in_unit(unit.unwrap_or_default());
        assert_eq!(read_of(vec![column]).seconds[..2], [0.0, 60.0], "{name}");
    }
}

#[test]
fn digits_of_a_clock_count_sixty_seconds() {
    let digits = |s: f64| {
        let second = 37_858.0 + s;
        (second / 3600.0).floor() * 1e4 + (second / 60.0).floor() % 60.0 * 1e2 + second % 60.0
    };
    let times = read_of(vec![numbers("utc", digits)]);
    assert_eq!(times.profile.form, Some(TimeForm::ClockDigits));
    assert_from(&times, 37_858.0, 1e-6, "103058.0");
}

#[test]
fn dates_and_times_of_day_are_joined() {
    let time = || texts("Time", |s| clock_of(OF_DAY_S + s));
    let dates = [
        texts("Date", |_| "2026-11-22".into()),
        texts("Reading_Date", |_| "22.11.2026".into()),
        texts("mm/dd/yyyy", |_| "11/22/2026".into()),
        numbers("yyyymmdd", |_| 20_261_122.0),
        numbers("UTC date", |_| 20_261_122.0),
    ];
    for date in dates {
        let name = date.name.clone();
        let times = read_of(vec![date, time()]);
        assert_eq!(times.profile.columns, [name.as_str(), "Time"]);
        assert!(times.is_utc && times.is_clock);
        assert_from(&times, UTC_S, 1e-6, &name);
    }
    let both = |s| format!("2026-11-22 {}", clock_of(OF_DAY_S + s));
    for name in ["Date", "DateTime", "when"] {
        assert_from(&read_of(vec![texts(name, both)]), UTC_S, 1e-6, name);
    }
}

#[test]
fn the_title_tells_which_of_day_and_month_stands_first() {
    // date -u -d 2026-03-02 +%s and 2026-02-03
    for (title, midnight_s) in [("dd/mm/yyyy", 1_772_409_600.0), ("mm/dd/yyyy", 1_770_076_800.0)] {
        let columns = vec![texts(title, |_| "02/03/2026".into()), texts("hh:mm:ss", |s| clock_of(OF_DAY_S + s))];
        assert_from(&read_of(columns), midnight_s + OF_DAY_S, 1e-6, title);
    }
}

#[test]
fn year_and_day_of_the_year_date_the_seconds_of_a_day() {
    let tt = |s: f64| OF_DAY_S + s;
    let columns = || vec![numbers("year", |_| 2026.0), numbers("doy", |_| 326.0), numbers("tt", tt)];
    let read = read_of(columns());
    assert_from(&read, UTC_S, 1e-6, "doy");
    assert_eq!(read.profile.columns, ["doy", "tt"]);
    assert_eq!(times("a", &table(columns()), &read.profile).unwrap(), read, "the profile gives the same times");
}

#[test]
fn a_profile_gives_the_same_times_through_midnight() {
    let is_after = |s: f64| if s < 2.0 { 0.0 } else { 1.0 };
    let tt = move |s: f64| 86_398.0 + s - 86_400.0 * is_after(s);
    let doy = move |s| 326.0 + is_after(s);
    let columns = || vec![numbers("year", |_| 2026.0), numbers("doy", doy), numbers("tt", tt)];
    let read = read_of(columns());
    assert_eq!(times("a", &table(columns()), &read.profile).unwrap(), read);
    assert_from(&read, UTC_S - OF_DAY_S + 86_398.0, 1e-6, "midnight");
}

#[test]
fn a_date_may_be_asked_for_or_told_by_the_file() {
    let mut table = table(vec![texts("Time", |s| clock_of(OF_DAY_S + s))]);
    let asked = |date: &str| TimeProfile { date: Some(date.into()), ..TimeProfile::default() };
    assert!(!times("a", &table, &TimeProfile::default()).unwrap().is_utc);
    assert_from(&times("a", &table, &asked("2026-11-22")).unwrap(), UTC_S, 1e-6, "asked");
    table.facts.date = Some((2026, 11, 22));
    assert_from(&times("a", &table, &TimeProfile::default()).unwrap(), UTC_S, 1e-6, "told");
    let refusal = times("a", &table, &asked("22.11.")).unwrap_err().to_string();
    assert!(refusal.contains("as in 2026-11-22"), "{refusal}");
}

#[test]
fn a_rate_counts_the_rows() {
    let table = table(vec![numbers("mag", |s| 50_000.0 + s.sin())]);
    let asked = TimeProfile { rate_hz: Some(10.0), ..TimeProfile::default() };
    assert_from(&times("a", &table, &asked).unwrap(), 0.0, 1e-9, "rate");
}

#[test]
fn what_tells_no_times_is_answered_with_the_options_that_do() {
    let table = table(vec![texts("leg", |_| "north".into()), numbers("mag", |s| 50_000.0 + s.sin())]);
    let asked = |name: &str| TimeProfile { columns: vec![name.into()], ..TimeProfile::default() };
    for (asked, wanted) in [
        (
            TimeProfile::default(),
            "there are leg, mag): name it with --time NAME, or give the rows a second with --rate HZ",
        ),
        (TimeProfile { rate_hz: Some(0.0), ..TimeProfile::default() }, "--rate HZ"),
        (asked("when"), "has no column \"when\"; it has leg, mag"),
        (asked("leg"), "name another with --time NAME"),
    ] {
        let refusal = times("a.csv", &table, &asked).unwrap_err().to_string();
        assert!(refusal.contains(wanted), "{refusal}");
    }
    let refusal = times("a.DAT", &table, &TimeProfile::default()).unwrap_err().to_string();
    assert!(refusal.contains(".dfn"), "{refusal}");
}

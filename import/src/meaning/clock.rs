//! The times of a table's rows: which columns tell them, and how.

use super::names::normalised;
use crate::error::ImportError;
use crate::profile::{TimeForm, TimeProfile};
use crate::source::{Facts, SourceColumn, SourceTable, Values};
use crate::stamp::{self, DAY_S, DateOrder, days_since_1970};
use crate::units::{self, Dimension};

/// The times of all rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Times {
    /// Of each row, s; NaN where there is none. Since 1970 where `is_utc`.
    pub seconds: Vec<f64>,
    /// Whether they are points in time and not only differences.
    pub is_utc: bool,
    /// Whether they are a clock's: then a recording counts from the midnight before its first row.
    pub is_clock: bool,
    /// Which columns of the table they were made of.
    pub used: Vec<usize>,
    /// How, for the profile.
    pub profile: TimeProfile,
}

/// Names of columns of times, the likelier first.
const TIMES: [&str; 32] = [
    "time_s",
    "time",
    "t",
    "tt",
    "timestamp",
    "time_stamp",
    "datetime",
    "date_time",
    "utc",
    "utc_time",
    "time_utc",
    "gps_time",
    "gpstime",
    "utctime",
    "utc_s",
    "elapsed",
    "elapsed_time",
    "seconds",
    "sec",
    "secs",
    "clock",
    "zeit",
    "uhrzeit",
    "epoch",
    "unix",
    "unix_time",
    "posix_time",
    "sod",
    "millis",
    "time_local",
    "fiducial",
    "fid",
];
const DATES: [&str; 9] =
    ["date", "gps_date", "gpsdate", "utc_date", "date_utc", "yyyymmdd", "datum", "day_date", "local_date"];
/// The day of a spreadsheet's and of MATLAB's count on which 1970 begins.
const SPREADSHEET_1970: f64 = 25_569.0;
const MATLAB_1970: f64 = 719_529.0;

/// A column that can be the times', read.
struct Reading {
    seconds: Vec<f64>,
    form: TimeForm,
    has_day: bool,
    is_clock: bool,
}

/// The times of a table: from the columns asked for, else from those that look most like it, else from the rate.
///
/// # Errors
///
/// When nothing tells the times: with the options that would.
pub fn times(file: &str, table: &SourceTable, asked: &TimeProfile) -> Result<Times, ImportError> {
    let order = asked.date_order.unwrap_or_else(|| date_order(table));
    let candidates = candidates(file, table, asked)?;
    for &at in &candidates {
        if let Some(reading) = read(&table.columns[at], asked.form, order) {
            return Ok(dated(table, asked, at, reading, order));
        }
    }
    if let (Some(&at), false) = (candidates.first(), asked.columns.is_empty()) {
        let name = &table.columns[at].name;
        return Err(ImportError::file(
            file,
            format!("the column \"{name}\" holds no times that this program can read"),
        ));
    }
    by_rate(file, table, asked)
}

fn by_rate(file: &str, table: &SourceTable, asked: &TimeProfile) -> Result<Times, ImportError> {
    let Some(rate_hz) = asked.rate_hz.or(table.facts.rate_hz).filter(|rate| rate.is_finite() && *rate > 0.0) else {
        let names: Vec<&str> = table.columns.iter().take(12).map(|column| column.name.as_str()).collect();
        let what = format!(
            "no column holds the time (there are {}): name it with --time NAME, or give the rows a second with --rate HZ{}",
            names.join(", "),
            if file.to_lowercase().ends_with(".dat") { "; if it is ASEG-GDF2, give its .dfn with it" } else { "" }
        );
        return Err(ImportError::file(file, what));
    };
    let seconds = (0..table.rows).map(|row| row as f64 / rate_hz).collect();
    let profile = TimeProfile { rate_hz: Some(rate_hz), ..TimeProfile::default() };
    Ok(Times { seconds, is_utc: false, is_clock: false, used: Vec::new(), profile })
}

/// The columns that may hold the times, the likeliest first.
fn candidates(file: &str, table: &SourceTable, asked: &TimeProfile) -> Result<Vec<usize>, ImportError> {
    if asked.columns.is_empty() {
        if asked.rate_hz.is_some() {
            return Ok(Vec::new());
        }
        let mut found: Vec<(u32, usize)> =
            table.columns.iter().enumerate().filter_map(|(at, column)| Some((likelihood(column)?, at))).collect();
        found.sort_by_key(|(likelihood, at)| (std::cmp::Reverse(*likelihood), *at));
        return Ok(found.into_iter().map(|(_, at)| at).collect());
    }
    // Of a date and a time of day, the date is found again by its name.
    let at = asked.columns.iter().map(|name| position(table, name).ok_or_else(|| unknown(file, table, name)));
    let mut at: Vec<usize> = at.collect::<Result<_, _>>()?;
    at.sort_by_key(|&at| is_date(&table.columns[at]));
    Ok(at)
}

/// The column of this name, as it is written or in another spelling.
pub(super) fn position(table: &SourceTable, name: &str) -> Option<usize> {
    let exact = table.columns.iter().position(|column| column.name == name);
    exact.or_else(|| table.columns.iter().position(|column| normalised(&column.name) == normalised(name)))
}

/// There is no such column.
pub(super) fn unknown(file: &str, table: &SourceTable, name: &str) -> ImportError {
    let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    ImportError::file(file, format!("has no column \"{name}\"; it has {}", names.join(", ")))
}

fn likelihood(column: &SourceColumn) -> Option<u32> {
    if matches!(column.values, Values::Times(_)) {
        return Some(500);
    }
    let name = normalised(&column.name);
    if column.name == "time_s" {
        return Some(1000);
    }
    let stem = units::suffix(&name).and_then(|_| name.rsplit_once('_')).map_or(name.as_str(), |(stem, _)| stem);
    let is_text = matches!(column.values, Values::Text(_));
    let by_name = TIMES.iter().position(|known| *known == name || *known == stem).map(|at| 100 - at as u32);
    match (by_name, is_text) {
        // Text with dates and times in it is a clock's, whatever its name.
        (Some(likelihood), true) => Some(likelihood + 200),
        (None, true) => Some(20).filter(|_| !is_date(column)),
        (by_name, false) => by_name.or_else(|| name.contains("time").then_some(5)),
    }
}

fn is_date(column: &SourceColumn) -> bool {
    DATES.contains(&normalised(&column.name).as_str())
}

/// Which of day and month stands first: what the dates themselves say; with points the day does.
fn date_order(table: &SourceTable) -> DateOrder {
    let mut order = None;
    for column in &table.columns {
        let Values::Text(texts) = &column.values else { continue };
        for text in texts.iter().step_by((texts.len() / 1000).max(1)) {
            let day_first = stamp::parse(text, DateOrder::Dmy).is_some_and(|stamp| stamp.day.is_some());
            let month_first = stamp::parse(text, DateOrder::Mdy).is_some_and(|stamp| stamp.day.is_some());
            match (day_first, month_first) {
                (true, false) => return DateOrder::Dmy,
                (false, true) => return DateOrder::Mdy,
                (true, true) if text.contains('/') => order = order.or(Some(DateOrder::Mdy)),
                _ => {}
            }
        }
    }
    order.unwrap_or(DateOrder::Dmy)
}

/// What a column says, if it can be times: most rows have one, and they go on.
fn read(column: &SourceColumn, asked: Option<TimeForm>, order: DateOrder) -> Option<Reading> {
    let reading = match &column.values {
        Values::Times(seconds) => {
            let has_day = seconds.iter().any(|second| second.abs() >= 10.0 * DAY_S);
            Reading { seconds: seconds.clone(), form: TimeForm::Stamps, has_day, is_clock: true }
        }
        Values::Text(texts) => stamps(texts, order)?,
        Values::Numbers(numbers) => {
            let form = asked.or_else(|| form(column, numbers))?;
            from_numbers(numbers, form)
        }
    };
    goes_on(&reading.seconds).then_some(reading)
}

fn stamps(texts: &[std::sync::Arc<str>], order: DateOrder) -> Option<Reading> {
    let stamps: Vec<_> = texts.iter().map(|text| stamp::parse(text, order)).collect();
    let read = stamps.iter().flatten().filter(|stamp| stamp.second.is_some()).count();
    if read * 2 < texts.iter().filter(|text| !text.is_empty()).count().max(1) {
        return None;
    }
    let has_day = stamps.iter().flatten().any(|stamp| stamp.day.is_some());
    let seconds = stamps
        .into_iter()
        .map(|stamp| {
            let stamp = stamp.filter(|stamp| stamp.second.is_some() && stamp.day.is_some() == has_day);
            stamp.map_or(f64::NAN, |stamp| stamp.day.unwrap_or(0.0) * DAY_S + stamp.second.unwrap_or(f64::NAN))
        })
        .collect();
    Some(Reading { seconds, form: TimeForm::Stamps, has_day, is_clock: true })
}

fn from_numbers(numbers: &[f64], form: TimeForm) -> Reading {
    let scaled = |factor: f64| numbers.iter().map(|number| number * factor).collect::<Vec<f64>>();
    let seconds = match form {
        TimeForm::Seconds | TimeForm::Stamps => numbers.to_vec(),
        TimeForm::Milliseconds => numbers.iter().map(|number| number / 1e3).collect(),
        TimeForm::Microseconds => numbers.iter().map(|number| number / 1e6).collect(),
        TimeForm::Nanoseconds => scaled(1e-9),
        TimeForm::Days => {
            let first = numbers.iter().copied().find(|number| number.is_finite()).unwrap_or_default();
            let origin = if first > MATLAB_1970 { MATLAB_1970 } else { SPREADSHEET_1970 };
            numbers.iter().map(|number| (number - origin) * DAY_S).collect()
        }
        TimeForm::ClockDigits => numbers.iter().map(|&number| clock_digits(number)).collect(),
    };
    let first = seconds.iter().copied().find(|second| second.is_finite()).unwrap_or_default();
    let has_day = (3e8..4e9).contains(&first);
    let is_clock = matches!(form, TimeForm::Days | TimeForm::ClockDigits);
    Reading { seconds, form, has_day, is_clock }
}

/// 101036.4 is 10:10:36.4.
fn clock_digits(number: f64) -> f64 {
    let (hours, minutes) = ((number / 1e4).floor(), (number / 1e2).floor() % 1e2);
    // The seconds have the digits of the source, not those of a remainder.
    hours * 3600.0 + minutes * 60.0 + ((number - hours * 1e4 - minutes * 1e2) * 1e6).round() / 1e6
}

/// What numbers of a column of times count: by the unit that is told, else by their size and their steps.
fn form(column: &SourceColumn, numbers: &[f64]) -> Option<TimeForm> {
    let told = column.unit.as_deref().and_then(units::of).or_else(|| units::suffix(&column.name));
    if let Some(unit) = told.filter(|unit| unit.dimension == Dimension::Time) {
        return match unit.factor {
            1.0 => Some(TimeForm::Seconds),
            1e-3 => Some(TimeForm::Milliseconds),
            1e-6 => Some(TimeForm::Microseconds),
            1e-9 => Some(TimeForm::Nanoseconds),
            86_400.0 => Some(TimeForm::Days),
            _ => None,
        };
    }
    if told.is_some_and(|unit| unit.dimension != Dimension::Number) {
        return None;
    }
    let first = numbers.iter().copied().find(|number| number.is_finite())?;
    if is_clock_digits(numbers) {
        return Some(TimeForm::ClockDigits);
    }
    let step = median_step(numbers)?;
    Some(match first {
        _ if first > 1e17 => TimeForm::Nanoseconds,
        _ if first > 1e14 => TimeForm::Microseconds,
        _ if first > 1e11 => TimeForm::Milliseconds,
        _ if step < 1e-3 && (20_000.0..800_000.0).contains(&first) => TimeForm::Days,
        _ if step <= 2.0 => TimeForm::Seconds,
        _ if step <= 1000.0 => TimeForm::Milliseconds,
        _ => TimeForm::Microseconds,
    })
}

/// Seconds and minutes below 60 throughout, and either no second of a day or jumps from 59 to 100.
fn is_clock_digits(numbers: &[f64]) -> bool {
    let there = || numbers.iter().copied().filter(|number| number.is_finite());
    let fits = there().all(|n| (0.0..240_000.0).contains(&n) && n % 100.0 < 60.0 && (n / 100.0).floor() % 100.0 < 60.0);
    let beyond = there().any(|number| number > DAY_S);
    let jumps = numbers.windows(2).filter(|pair| (40.0..=42.0).contains(&(pair[1] - pair[0]))).count();
    fits && there().any(|number| number >= 100.0) && (beyond || jumps > 0)
}

/// The median of the steps forward.
fn median_step(numbers: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> =
        numbers.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| step.is_finite() && *step > 0.0).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Whether values can be times: most are there, most steps do not go back, and they come to more than one.
fn goes_on(seconds: &[f64]) -> bool {
    let there: Vec<f64> = seconds.iter().copied().filter(|second| second.is_finite()).collect();
    let back = there.windows(2).filter(|pair| pair[1] < pair[0]).count();
    let forward = there.windows(2).filter(|pair| pair[1] > pair[0]).count();
    there.len() * 2 > seconds.len() && forward > 0 && back * 5 <= forward
}

/// The times with their date, where one is told.
fn dated(table: &SourceTable, asked: &TimeProfile, at: usize, reading: Reading, order: DateOrder) -> Times {
    let Reading { mut seconds, form, has_day, is_clock } = reading;
    let column = &table.columns[at];
    let mut used = vec![at];
    let mut is_utc = has_day;
    let of_a_day =
        seconds.iter().filter(|second| second.is_finite()).all(|second| (-DAY_S..2.0 * DAY_S).contains(second));
    let is_of_a_day =
        is_clock || ["tt", "utc", "sod", "time_utc", "utc_time"].contains(&normalised(&column.name).as_str());
    if !has_day && of_a_day && is_of_a_day {
        if let Some((date_at, days)) = days_of(table, order) {
            seconds.iter_mut().zip(&days).for_each(|(second, day)| *second += day * DAY_S);
            used.push(date_at);
            is_utc = true;
        } else if let Some(day) = first_day(asked, &table.facts) {
            seconds.iter_mut().for_each(|second| *second += day * DAY_S);
            is_utc = true;
        }
    }
    let names = used.iter().rev().map(|&at| table.columns[at].name.clone()).collect();
    let has_order = form == TimeForm::Stamps && matches!(column.values, Values::Text(_));
    let profile = TimeProfile {
        columns: names,
        form: Some(form),
        date_order: has_order.then_some(order),
        date: asked.date.clone(),
        rate_hz: None,
    };
    Times { seconds, is_utc, is_clock: is_clock || (is_utc && used.len() > 1), used, profile }
}

fn first_day(asked: &TimeProfile, facts: &Facts) -> Option<f64> {
    let asked = asked.date.as_deref().and_then(|date| stamp::parse(date, DateOrder::Ymd)).and_then(|stamp| stamp.day);
    asked.or_else(|| facts.date.and_then(|(year, month, day)| days_since_1970(year, month, day)))
}

/// The day of each row, from a column of dates or from year and day of the year.
fn days_of(table: &SourceTable, order: DateOrder) -> Option<(usize, Vec<f64>)> {
    let dated = table.columns.iter().enumerate().filter(|(_, column)| is_date(column)).find_map(|(at, column)| {
        let days: Vec<f64> = match &column.values {
            Values::Text(texts) => texts.iter().map(|text| day_of_text(text, order)).collect(),
            Values::Numbers(numbers) => numbers.iter().map(|&number| day_of_digits(number)).collect(),
            Values::Times(seconds) => seconds.iter().map(|second| (second / DAY_S).floor()).collect(),
        };
        let there = days.iter().filter(|day| day.is_finite()).count();
        (there * 2 > days.len()).then_some((at, days))
    });
    dated.or_else(|| by_day_of_year(table))
}

fn day_of_text(text: &str, order: DateOrder) -> f64 {
    stamp::parse(text, order).and_then(|stamp| stamp.day).unwrap_or(f64::NAN)
}

/// 20261122
fn day_of_digits(number: f64) -> f64 {
    let digits = number as i64;
    let is_date = number.fract() == 0.0 && (19_000_101..=21_991_231).contains(&digits);
    let parts = (digits / 10_000, digits / 100 % 100, digits % 100);
    let day = is_date.then(|| days_since_1970(parts.0 as i16, parts.1 as i8, parts.2 as i8)).flatten();
    day.unwrap_or(f64::NAN)
}

fn by_day_of_year(table: &SourceTable) -> Option<(usize, Vec<f64>)> {
    let named = |names: &[&str]| {
        table
            .columns
            .iter()
            .position(|column| names.contains(&normalised(&column.name).as_str()) && column.as_numbers().is_some())
    };
    let (year_at, day_at) = (named(&["year"])?, named(&["doy", "day_of_year", "julian_day"])?);
    let (years, days) = (table.columns[year_at].as_numbers()?, table.columns[day_at].as_numbers()?);
    let day = |(year, day): (&f64, &f64)| {
        let is_day = (1900.0..2200.0).contains(year) && (1.0..367.0).contains(day);
        let first = is_day.then(|| days_since_1970(*year as i16, 1, 1)).flatten();
        first.map_or(f64::NAN, |first| first + day.floor() - 1.0)
    };
    Some((day_at, years.iter().zip(days).map(day).collect()))
}

//! The times of a table's rows: which columns tell them, and how.

mod candidates;
mod dates;
mod milliseconds;
mod numbers;
mod reading;

use self::candidates::candidates;
use self::dates::{date_order, days_of};
use self::reading::{Reading, read};
use super::names::normalised;
use crate::error::ImportError;
use crate::profile::{TimeForm, TimeProfile};
use crate::source::{Facts, SourceColumn, SourceTable, Values};
use crate::stamp::{self, DAY_S, DateOrder, days_since_1970};

/// The times of all rows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Times {
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

/// Names of columns of times of a day, be they numbers.
const OF_A_DAY: [&str; 5] = ["tt", "utc", "sod", "time_utc", "utc_time"];

/// The times of a table: from the columns asked for, else from those that look most like it, else from the rate.
///
/// # Errors
///
/// When nothing tells the times: with the options that would.
pub(crate) fn times(file: &str, table: &SourceTable, asked: &TimeProfile) -> Result<Times, ImportError> {
    let first_day = first_day(asked, &table.facts)?;
    let order = asked.date_order.unwrap_or_else(|| date_order(table));
    let candidates = candidates(file, table, asked)?;
    for &at in &candidates {
        if let Some(reading) = read(&table.columns[at], asked.form, order) {
            return Ok(dated(table, asked, (at, order), first_day, reading));
        }
    }
    if let (Some(&at), false) = (candidates.first(), asked.columns.is_empty()) {
        let name = &table.columns[at].name;
        let what = format!(
            "the column \"{name}\" holds no times that this program can read: name another with --time NAME, or give the rows \
             a second with --rate HZ"
        );
        return Err(ImportError::file(file, what));
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

/// The times with their date, where one is told.
fn dated(
    table: &SourceTable,
    asked: &TimeProfile,
    (at, order): (usize, DateOrder),
    first_day: Option<f64>,
    mut reading: Reading,
) -> Times {
    milliseconds::add(table, &mut reading.seconds);
    let mut used = vec![at];
    let mut is_utc = reading.has_day;
    if is_of_a_day(&table.columns[at], &reading) {
        if let Some((date_at, days)) = days_of(table, order) {
            reading.seconds.iter_mut().zip(&days).for_each(|(second, day)| *second += day * DAY_S);
            used.push(date_at);
            is_utc = true;
        } else if let Some(day) = first_day {
            reading.seconds.iter_mut().for_each(|second| *second += day * DAY_S);
            is_utc = true;
        }
    }
    let is_text = matches!(table.columns[at].values, Values::Text(_));
    let profile = TimeProfile {
        columns: used.iter().rev().map(|&at| table.columns[at].name.clone()).collect(),
        form: Some(reading.form),
        date_order: Some(order).filter(|_| reading.form == TimeForm::Stamps && is_text),
        date: asked.date.clone(),
        rate_hz: None,
    };
    let is_clock = reading.is_clock || used.len() > 1;
    Times { seconds: reading.seconds, is_utc, is_clock, used, profile }
}

/// Whether times lack the day that they are of.
fn is_of_a_day(column: &SourceColumn, reading: &Reading) -> bool {
    let is_clock = reading.is_clock || OF_A_DAY.contains(&normalised(&column.name).as_str());
    let mut there = reading.seconds.iter().filter(|second| second.is_finite());
    is_clock && !reading.has_day && there.all(|second| (-DAY_S..2.0 * DAY_S).contains(second))
}

/// The day of the first row, as it is asked for or as the file tells it.
fn first_day(asked: &TimeProfile, facts: &Facts) -> Result<Option<f64>, ImportError> {
    let Some(date) = &asked.date else {
        return Ok(facts.date.and_then(|(year, month, day)| days_since_1970(year, month, day)));
    };
    let day = stamp::parse(date, DateOrder::Ymd).and_then(|stamp| stamp.day);
    let wrong = || ImportError::Usage(format!("\"{date}\" is no date: give year, month and day, as in 2026-11-22"));
    day.map(Some).ok_or_else(wrong)
}

#[cfg(test)]
mod tests;

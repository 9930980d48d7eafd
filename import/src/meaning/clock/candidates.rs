//! The columns that may hold the times.

use super::super::columns::{position, unknown};
use super::super::names::{normalised, stem};
use super::dates::{is_date, is_day};
use crate::error::ImportError;
use crate::profile::TimeProfile;
use crate::source::{SourceColumn, SourceTable, Values};

/// Names of columns of times, the likelier first.
const TIMES: [&str; 34] = [
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
    "hhmmss",
    "hh_mm_ss",
];

/// The columns that may hold the times, the likeliest first.
pub(super) fn candidates(file: &str, table: &SourceTable, asked: &TimeProfile) -> Result<Vec<usize>, ImportError> {
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
    at.sort_by_key(|&at| is_day(&table.columns[at]));
    Ok(at)
}

fn likelihood(column: &SourceColumn) -> Option<u32> {
    if matches!(column.values, Values::Times(_)) {
        // Of two such columns the date is that of the other.
        return Some(if is_date(column) { 400 } else { 500 });
    }
    let name = normalised(&column.name);
    if column.name == "time_s" {
        return Some(1000);
    }
    let stem = stem(&name);
    let is_text = matches!(column.values, Values::Text(_));
    let by_name = TIMES.iter().position(|known| *known == name || *known == stem).map(|at| 100 - at as u32);
    match (by_name, is_text) {
        // Text with dates and times in it is a clock's, whatever its name.
        (Some(likelihood), true) => Some(likelihood + 200),
        (None, true) => Some(if is_date(column) { 10 } else { 20 }),
        (by_name, false) => by_name.or_else(|| name.contains("time").then_some(5)),
    }
}

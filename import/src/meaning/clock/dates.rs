//! The dates of a table: which of day and month stands first, and the day of each row.

use super::super::names::normalised;
use crate::source::{SourceColumn, SourceTable, Values};
use crate::stamp::{self, DAY_S, DateOrder, days_since_1970};

/// Names of columns of dates that do not say so in a word of their own.
const DATES: [&str; 4] = ["gpsdate", "yyyymmdd", "ddmmyyyy", "datum"];
const DAYS_OF_THE_YEAR: [&str; 3] = ["doy", "day_of_year", "julian_day"];
/// What titles such as `mm/dd/yyyy` are made of.
const PARTS: [&str; 6] = ["yyyy", "yy", "mm", "mmm", "dd", "d"];

/// Whether a column is one of dates by its name: `Reading_Date`, `mm/dd/yyyy`.
pub(super) fn is_date(column: &SourceColumn) -> bool {
    let name = normalised(&column.name);
    let has = |word: &str| name.split('_').any(|token| token == word);
    DATES.contains(&name.as_str()) || (has("date") && !has("time")) || order_of_title(&name).is_some()
}

/// Whether a column tells days, of dates or of the year.
pub(super) fn is_day(column: &SourceColumn) -> bool {
    is_date(column) || DAYS_OF_THE_YEAR.contains(&normalised(&column.name).as_str())
}

/// Of the title `mm/dd/yyyy` and its like.
fn order_of_title(name: &str) -> Option<DateOrder> {
    let parts: Vec<&str> = name.split('_').collect();
    match parts.as_slice() {
        [first, second, third] if [first, second, third].iter().all(|part| PARTS.contains(part)) => {
            match first.chars().next()? {
                'y' => Some(DateOrder::Ymd),
                'd' => Some(DateOrder::Dmy),
                _ => Some(DateOrder::Mdy),
            }
        }
        _ => None,
    }
}

/// Which of day and month stands first: what the dates themselves or the title say; with points the day does.
pub(super) fn date_order(table: &SourceTable) -> DateOrder {
    let mut order = table.columns.iter().find_map(|column| order_of_title(&normalised(&column.name)));
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

/// The day of each row, from a column of dates or from year and day of the year.
pub(super) fn days_of(table: &SourceTable, order: DateOrder) -> Option<(usize, Vec<f64>)> {
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
    let (year_at, day_at) = (named(&["year"])?, named(&DAYS_OF_THE_YEAR)?);
    let (years, days) = (table.columns[year_at].as_numbers()?, table.columns[day_at].as_numbers()?);
    let day = |(year, day): (&f64, &f64)| {
        let is_day = (1900.0..2200.0).contains(year) && (1.0..367.0).contains(day);
        let first = is_day.then(|| days_since_1970(*year as i16, 1, 1)).flatten();
        first.map_or(f64::NAN, |first| first + day.floor() - 1.0)
    };
    Some((day_at, years.iter().zip(days).map(day).collect()))
}

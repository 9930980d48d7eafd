//! What a column says when it is read as times.

use std::sync::Arc;

use super::numbers::{self, form};
use crate::profile::TimeForm;
use crate::source::{SourceColumn, Values};
use crate::stamp::{self, DAY_S, DateOrder};

/// A column that can be the times', read.
pub(super) struct Reading {
    pub(super) seconds: Vec<f64>,
    pub(super) form: TimeForm,
    pub(super) has_day: bool,
    pub(super) is_clock: bool,
}

/// What a column says, if it can be times: most rows have one, and they go on.
pub(super) fn read(column: &SourceColumn, asked: Option<TimeForm>, order: DateOrder) -> Option<Reading> {
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

fn from_numbers(values: &[f64], form: TimeForm) -> Reading {
    let seconds = numbers::seconds(values, form);
    let first = seconds.iter().copied().find(|second| second.is_finite()).unwrap_or_default();
    let is_clock = matches!(form, TimeForm::Days | TimeForm::ClockDigits);
    Reading { seconds, form, has_day: (3e8..4e9).contains(&first), is_clock }
}

fn stamps(texts: &[Arc<str>], order: DateOrder) -> Option<Reading> {
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

/// Whether values can be times: most are there, most steps do not go back, and they come to more than one.
fn goes_on(seconds: &[f64]) -> bool {
    let there: Vec<f64> = seconds.iter().copied().filter(|second| second.is_finite()).collect();
    let back = there.windows(2).filter(|pair| pair[1] < pair[0]).count();
    let forward = there.windows(2).filter(|pair| pair[1] > pair[0]).count();
    there.len() * 2 > seconds.len() && forward > 0 && back * 5 <= forward
}

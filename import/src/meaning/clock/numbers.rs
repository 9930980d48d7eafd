//! Times that are numbers: seconds, their parts, days, the digits of a clock.

use super::super::columns::told_unit;
use crate::profile::TimeForm;
use crate::source::SourceColumn;
use crate::stamp::DAY_S;
use crate::statistics::median_step;
use crate::units::{self, Dimension, Unit};

/// The day of a spreadsheet's and of MATLAB's count on which 1970 begins.
const SPREADSHEET_1970: f64 = 25_569.0;
const MATLAB_1970: f64 = 719_529.0;

/// Seconds of numbers of this form.
pub(super) fn seconds(numbers: &[f64], form: TimeForm) -> Vec<f64> {
    let divided = |by: f64| numbers.iter().map(|number| number / by).collect();
    match form {
        TimeForm::Seconds | TimeForm::Stamps => numbers.to_vec(),
        TimeForm::Milliseconds => divided(1e3),
        TimeForm::Microseconds => divided(1e6),
        TimeForm::Nanoseconds => divided(1e9),
        TimeForm::Days => {
            let first = numbers.iter().copied().find(|number| number.is_finite()).unwrap_or_default();
            let origin = if first > MATLAB_1970 { MATLAB_1970 } else { SPREADSHEET_1970 };
            numbers.iter().map(|number| (number - origin) * DAY_S).collect()
        }
        TimeForm::ClockDigits => numbers.iter().map(|&number| clock_digits(number)).collect(),
    }
}

/// 101036.4 is 10:10:36.4.
fn clock_digits(number: f64) -> f64 {
    let (hours, minutes) = ((number / 1e4).floor(), (number / 1e2).floor() % 1e2);
    // The seconds have the digits of the source, not those of a remainder.
    hours * 3600.0 + minutes * 60.0 + ((number - hours * 1e4 - minutes * 1e2) * 1e6).round() / 1e6
}

/// What numbers of a column of times count: by the unit that is told, else by their size and their steps.
pub(super) fn form(column: &SourceColumn, numbers: &[f64]) -> Option<TimeForm> {
    // A column may be named by its unit: `seconds`. One letter is a name.
    let by_name = || units::of(&column.name).filter(|_| column.name.len() > 1);
    let by_name = || by_name().filter(|unit| unit.dimension == Dimension::Time);
    match told_unit(column).or_else(by_name) {
        Some(unit) if unit.dimension == Dimension::Time => in_unit(unit),
        Some(unit) if unit.dimension != Dimension::Number => None,
        Some(_) | None if is_clock_digits(numbers) => Some(TimeForm::ClockDigits),
        Some(_) | None => by_size(numbers),
    }
}

fn in_unit(unit: Unit) -> Option<TimeForm> {
    match unit.factor {
        1.0 => Some(TimeForm::Seconds),
        1e-3 => Some(TimeForm::Milliseconds),
        1e-6 => Some(TimeForm::Microseconds),
        1e-9 => Some(TimeForm::Nanoseconds),
        86_400.0 => Some(TimeForm::Days),
        _ => None,
    }
}

/// Since 1970 by what they are, else by their steps: a magnetometer reads once in a few seconds to a thousand times a second.
fn by_size(numbers: &[f64]) -> Option<TimeForm> {
    let first = numbers.iter().copied().find(|number| number.is_finite())?;
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

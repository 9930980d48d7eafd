//! Whether a value is in its range.

use std::ops::RangeInclusive;

use crate::message::number;

/// The error names the key, the value and the range.
pub(super) fn within(key: &str, value: f64, range: RangeInclusive<f64>) -> Result<(), String> {
    if range.contains(&value) {
        return Ok(());
    }
    let (value, low, high) = (number(value), number(*range.start()), number(*range.end()));
    Err(format!("{key}: {value} is outside {low} to {high}"))
}

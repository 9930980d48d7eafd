//! What the values of a column are.

use csv::StringRecord;
use towmag_recording::{Column, ColumnKind, load_of};

use crate::error::quoted;
use crate::table::Values;

/// The flag of a result beside that of a recording; either marks a row, which may then hold anything.
const VALID: &str = "valid";

/// A value that is not what its column says.
pub(super) struct Wrong {
    /// Which row.
    pub(super) row: usize,
    /// What is wrong with it.
    pub(super) what: String,
}

/// Which rows are marked as not valid.
pub(super) fn marked(names: &[String], rows: &[StringRecord]) -> Vec<bool> {
    let is_flag = |name: &str| name == Column::ScalarValid.name() || name == VALID;
    let flags: Vec<usize> = (0..names.len()).filter(|&at| is_flag(&names[at])).collect();
    rows.iter().map(|row| flags.iter().any(|&at| row.get(at).and_then(flag) == Some(false))).collect()
}

/// The values of the column at this position.
pub(super) fn values(name: &str, rows: &[StringRecord], at: usize, is_marked: &[bool]) -> Result<Values, Wrong> {
    let texts = || rows.iter().map(|row| row.get(at).unwrap_or_default());
    match kind(name) {
        Some(ColumnKind::Number) => {
            let parsed = texts().map(number);
            Ok(Values::Number(usable(parsed, is_marked, |row| not_a_number(&rows[row][at]))?))
        }
        Some(ColumnKind::Flag) => {
            let parsed = texts().map(|text| if text.is_empty() { Some(None) } else { flag(text).map(Some) });
            let what = |row: usize| format!("{} is neither 0 nor 1", quoted(&rows[row][at]));
            Ok(Values::Flag(usable(parsed, is_marked, what)?))
        }
        Some(ColumnKind::Label) => Ok(labels(texts())),
        // Nobody has said what it is: numbers, if it holds some and nothing else.
        None => Ok(match texts().map(number).collect::<Option<Vec<f64>>>() {
            Some(numbers) if numbers.iter().any(|number| !number.is_nan()) => Values::Number(numbers),
            _ => labels(texts()),
        }),
    }
}

fn kind(name: &str) -> Option<ColumnKind> {
    let known = Column::named(name).map(|column| column.spec().kind);
    let load = load_of(name).map(|_| ColumnKind::Number);
    known.or(load).or((name == VALID).then_some(ColumnKind::Flag))
}

/// All values; the one that is none is missing where the row is marked, and wrong elsewhere.
fn usable<T: Missing>(
    parsed: impl Iterator<Item = Option<T>>,
    is_marked: &[bool],
    what: impl Fn(usize) -> String,
) -> Result<Vec<T>, Wrong> {
    let value = |(row, value): (usize, Option<T>)| match value {
        Some(value) => Ok(value),
        None if is_marked[row] => Ok(T::MISSING),
        None => Err(Wrong { row, what: what(row) }),
    };
    parsed.enumerate().map(value).collect()
}

trait Missing {
    const MISSING: Self;
}

impl Missing for f64 {
    const MISSING: Self = f64::NAN;
}

impl Missing for Option<bool> {
    const MISSING: Self = None;
}

fn not_a_number(text: &str) -> String {
    let kind = if text.parse::<f64>().is_ok() { "finite number" } else { "number" };
    format!("{} is not a {kind}", quoted(text))
}

/// Not a number where empty; `None` for what is no finite number.
fn number(text: &str) -> Option<f64> {
    if text.is_empty() {
        return Some(f64::NAN);
    }
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

fn flag(text: &str) -> Option<bool> {
    match number(text)? {
        0.0 => Some(false),
        1.0 => Some(true),
        _ => None,
    }
}

fn labels<'a>(texts: impl Iterator<Item = &'a str>) -> Values {
    Values::Label(texts.map(|text| Some(text.to_string()).filter(|text| !text.is_empty())).collect())
}

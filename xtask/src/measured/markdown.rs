//! Tables and numbers, as the page writes them.

use anyhow::{Context, Result};
use serde_json::Value;

/// A table; cells are separated in every line as `| a | b |`.
pub(super) struct Table(String);

impl Table {
    pub(super) fn new(columns: &[&str]) -> Self {
        let mut table = Self(String::new());
        table.row(columns);
        table.0 += &format!("|{}\n", "---|".repeat(columns.len()));
        table
    }

    pub(super) fn row<T: AsRef<str>>(&mut self, cells: &[T]) {
        let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
        self.0 += &format!("| {} |\n", cells.join(" | "));
    }

    pub(super) fn into_text(self) -> String {
        self.0
    }
}

/// Three significant digits or the whole number: `12.1`, `0.0431`, `4,230`.
pub(super) fn three_digits(value: f64) -> String {
    if value.abs() >= 1000.0 {
        return thousands(value);
    }
    let magnitude = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    format!("{value:.*}", usize::try_from(2 - magnitude).unwrap_or_default())
}

/// Three significant digits of a large number, grouped: `960,000`.
pub(super) fn thousands(value: f64) -> String {
    let unit = 10_f64.powi((value.abs().max(1.0).log10().floor() as i32 - 2).max(0));
    grouped((value / unit).round() * unit)
}

/// A whole number, grouped.
pub(super) fn grouped(value: f64) -> String {
    let digits = format!("{:.0}", value.abs());
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    if value < 0.0 { format!("-{text}") } else { text }
}

/// A number of a result.
pub(super) fn number(value: &Value, key: &str) -> Result<f64> {
    value[key].as_f64().with_context(|| format!("no number `{key}` in {value}"))
}

/// A word of a result.
pub(super) fn word<'a>(value: &'a Value, key: &str) -> Result<&'a str> {
    value[key].as_str().with_context(|| format!("no text `{key}` in {value}"))
}

/// A list of a result.
pub(super) fn list<'a>(value: &'a Value, key: &str) -> Result<&'a Vec<Value>> {
    value[key].as_array().with_context(|| format!("no list `{key}` in {value}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.0, 0.04312, 1.4083, 12.06, 998.9, 4230.4, 959_700.0].map(three_digits);
        assert_eq!(shown, ["0.00", "0.0431", "1.41", "12.1", "999", "4,230", "960,000"]);
        assert_eq!([162_411.0, -1_000.0, 12.0].map(grouped), ["162,411", "-1,000", "12"]);
    }

    #[test]
    fn a_table_has_a_line_below_its_head() {
        let mut table = Table::new(&["a", "b"]);
        table.row(&["1", "2"]);
        assert_eq!(table.into_text(), "| a | b |\n|---|---|\n| 1 | 2 |\n");
    }
}

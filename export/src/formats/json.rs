//! A row as JSON.

use serde_json::Value;

use crate::table::{Table, Values};

/// A value of a column; null where it is missing.
pub(super) fn value(values: &Values, row: usize) -> Value {
    match values {
        // What is not a number is null.
        Values::Number(numbers) => numbers[row].into(),
        Values::Flag(flags) => flags[row].into(),
        Values::Label(labels) => labels[row].as_deref().into(),
    }
}

/// All values of a row by the names of their columns.
pub(super) fn row(table: &Table, row: usize) -> impl Iterator<Item = (String, Value)> {
    table.columns.iter().map(move |column| (column.name.clone(), value(&column.values, row)))
}

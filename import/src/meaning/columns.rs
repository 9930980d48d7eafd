//! Columns of a table by their names, and what the file tells of them.

use super::names::normalised;
use crate::error::ImportError;
use crate::source::{SourceColumn, SourceTable};
use crate::units::{self, Unit};

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

/// The unit that a file tells of a column, beside its name or in it.
pub(super) fn told_unit(source: &SourceColumn) -> Option<Unit> {
    source.unit.as_deref().and_then(units::of).or_else(|| units::suffix(&source.name))
}

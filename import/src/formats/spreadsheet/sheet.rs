//! A sheet as its file has it: cells at places.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::super::memory::{Budget, TooLarge};

/// Columns beyond are a stray cell, not a recording.
const WIDEST: u32 = 1024;

/// What stands in a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum Cell {
    #[default]
    Empty,
    Number(f64),
    Text(Arc<str>),
    /// A date, with or without a time: seconds since 1970.
    Date(f64),
    /// A time of day, or how long something took: seconds.
    Time(f64),
}

/// A sheet of a workbook.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sheet {
    pub(super) name: String,
    /// Rows that hold something, by their number from 0.
    pub(super) rows: BTreeMap<u32, Vec<Cell>>,
}

/// Why a workbook cannot be read.
#[derive(Debug, thiserror::Error)]
pub(super) enum Fault {
    #[error("is cut or damaged, or locked with a password ({0}): open it in a spreadsheet program and save it again")]
    Damaged(String),
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    #[error("is a binary workbook: save it as .xlsx")]
    Binary,
}

impl Fault {
    /// Of what a library says.
    pub(super) fn damaged(error: impl std::fmt::Display) -> Self {
        Self::Damaged(error.to_string())
    }
}

impl Sheet {
    /// Of this name, without cells.
    pub(super) fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), rows: BTreeMap::new() }
    }

    /// Puts a cell in its place.
    pub(super) fn put(&mut self, row: u32, column: u32, cell: Cell, budget: &mut Budget) -> Result<(), TooLarge> {
        if cell == Cell::Empty || column >= WIDEST {
            return Ok(());
        }
        let (row, column) = (self.rows.entry(row).or_default(), column as usize);
        if row.len() <= column {
            budget.take(column + 1 - row.len(), size_of::<Cell>())?;
            row.resize(column + 1, Cell::Empty);
        }
        row[column] = cell;
        Ok(())
    }
}

impl Cell {
    /// A text without blanks around it; nothing if nothing is left.
    pub(super) fn text(text: &str) -> Self {
        match text.trim() {
            "" => Self::Empty,
            text => Self::Text(text.into()),
        }
    }

    /// Numbers, dates and times.
    pub(super) fn is_value(&self) -> bool {
        matches!(self, Self::Number(_) | Self::Date(_) | Self::Time(_))
    }

    /// Its text, if it is one.
    pub(super) fn as_text(&self) -> Option<&Arc<str>> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }
}

//! A column that grows by a cell at a time.

use std::collections::HashSet;
use std::sync::Arc;

use super::cell::{is_missing, number, parse_number};
use super::signs::Decimal;
use crate::source::{SourceColumn, Values};

/// Texts that come again are held once, up to so many: labels come again and again, stamps never do.
const MOST_SHARED: usize = 1000;

/// What stands for "missing" besides an empty cell and its many names.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Missing {
    /// Nothing.
    Nothing,
    /// One number.
    Value(f64),
    /// The numbers for which this holds; the number to tell of them.
    Where(fn(f64) -> bool, f64),
}

/// A column that grows.
#[derive(Debug)]
pub(crate) struct Column {
    name: String,
    unit: Option<String>,
    missing: Missing,
    cells: Cells,
}

#[derive(Debug)]
enum Cells {
    Numbers(Vec<f64>),
    Text(Vec<Arc<str>>),
}

/// What a cell was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pushed {
    /// A value, a text, or nothing.
    Good,
    /// A mark that stands for "missing".
    Mark,
    /// No number where all else is numbers.
    Bad,
}

/// Texts that are held once.
#[derive(Debug, Default)]
pub(crate) struct Words(HashSet<Arc<str>>);

impl Missing {
    fn is(self, value: f64) -> bool {
        match self {
            Self::Nothing => false,
            Self::Value(dummy) => value == dummy,
            Self::Where(is_dummy, _) => is_dummy(value),
        }
    }

    fn told(self) -> Option<f64> {
        match self {
            Self::Nothing => None,
            Self::Value(dummy) | Self::Where(_, dummy) => Some(dummy),
        }
    }
}

impl Words {
    /// This text, as it is there already if it is.
    pub(crate) fn shared(&mut self, text: &str) -> Arc<str> {
        if let Some(known) = self.0.get(text) {
            return known.clone();
        }
        let new: Arc<str> = text.into();
        if self.0.len() < MOST_SHARED {
            self.0.insert(new.clone());
        }
        new
    }
}

impl Column {
    /// Without cells.
    pub(crate) fn new(name: impl Into<String>, unit: Option<&str>, missing: Missing, is_text: bool) -> Self {
        let cells = if is_text { Cells::Text(Vec::new()) } else { Cells::Numbers(Vec::new()) };
        Self { name: name.into(), unit: unit.filter(|unit| !unit.is_empty()).map(str::to_string), missing, cells }
    }

    /// Whether it holds numbers.
    #[inline]
    pub(super) fn is_numbers(&self) -> bool {
        matches!(self.cells, Cells::Numbers(_))
    }

    /// A cell without blanks around it.
    #[inline]
    pub(super) fn push(&mut self, cell: &str, decimal: Decimal, words: &mut Words) -> Pushed {
        match &mut self.cells {
            Cells::Numbers(numbers) => {
                let number = parse_number(cell, decimal);
                numbers.push(number.filter(|number| !self.missing.is(*number)).unwrap_or(f64::NAN));
                match number {
                    None if cell.is_empty() => Pushed::Good,
                    None if is_missing(cell) => Pushed::Mark,
                    None => Pushed::Bad,
                    Some(_) => Pushed::Good,
                }
            }
            Cells::Text(texts) => {
                let is_dummy = || number(cell).is_some_and(|number| self.missing.is(number));
                let is_there = !is_missing(cell) && (matches!(self.missing, Missing::Nothing) || !is_dummy());
                texts.push(words.shared(if is_there { cell } else { "" }));
                Pushed::Good
            }
        }
    }

    /// With all of its cells.
    pub(super) fn finished(self) -> SourceColumn {
        let (values, dummy) = match self.cells {
            Cells::Numbers(mut numbers) => {
                numbers.shrink_to_fit();
                (Values::Numbers(numbers), self.missing.told())
            }
            Cells::Text(mut texts) => {
                texts.shrink_to_fit();
                (Values::Text(texts), None)
            }
        };
        SourceColumn { name: self.name, unit: self.unit, values, dummy }
    }
}

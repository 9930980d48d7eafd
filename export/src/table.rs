//! A file of ours as typed columns.

use towmag_recording::Column;

use crate::error::ExportError;

/// All columns of a recording or a result, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The file as the user named it.
    pub file: String,
    /// Its columns: at least one, all with as many values.
    pub columns: Vec<TableColumn>,
    /// Where each row stands in the file, from 1.
    pub lines: Vec<u64>,
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct TableColumn {
    /// As in the header.
    pub name: String,
    /// Unit of its numbers; empty where there is none, or none is known.
    pub unit: &'static str,
    /// A value a row.
    pub values: Values,
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Finite numbers; not a number where missing.
    Number(Vec<f64>),
    /// Flags.
    Flag(Vec<Option<bool>>),
    /// Text that is not empty.
    Label(Vec<Option<String>>),
}

impl Table {
    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// The numbers of a column.
    pub(crate) fn numbers(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|column| column.name == name).and_then(|column| match &column.values {
            Values::Number(numbers) => Some(numbers.as_slice()),
            Values::Flag(_) | Values::Label(_) => None,
        })
    }

    /// The labels of the lines, if there is such a column.
    pub(crate) fn line_labels(&self) -> Option<&[Option<String>]> {
        let line = self.columns.iter().find(|column| column.name == Column::Line.name())?;
        match &line.values {
            Values::Label(labels) => Some(labels),
            Values::Number(_) | Values::Flag(_) => None,
        }
    }

    /// The name without the folders, for what is written into a file.
    pub(crate) fn file_name(&self) -> &str {
        self.file.rsplit(['/', '\\']).next().unwrap_or(&self.file)
    }

    /// A row and a column are at fault.
    pub(crate) fn at(&self, row: usize, column: &str, what: impl Into<String>) -> ExportError {
        let (file, line) = (self.file.clone(), self.lines[row]);
        ExportError::At { file, line, column: Some(column.into()), what: what.into() }
    }

    /// The table as a whole is at fault.
    pub(crate) fn lacks(&self, what: impl Into<String>) -> ExportError {
        ExportError::File { file: self.file.clone(), what: what.into() }
    }
}

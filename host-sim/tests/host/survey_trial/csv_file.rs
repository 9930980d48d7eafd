//! Columns of a CSV file.

use std::collections::HashMap;
use std::path::Path;

/// A table as text.
pub(crate) struct CsvFile {
    header: HashMap<String, usize>,
    rows: Vec<csv::StringRecord>,
}

impl CsvFile {
    pub(crate) fn read(path: &Path) -> Self {
        let mut reader = csv::Reader::from_path(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let header = reader.headers().unwrap().iter().enumerate().map(|(k, name)| (name.to_string(), k)).collect();
        Self { header, rows: reader.records().map(Result::unwrap).collect() }
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn text(&self, name: &str) -> Vec<&str> {
        let at = *self.header.get(name).unwrap_or_else(|| panic!("no column {name}"));
        self.rows.iter().map(|row| &row[at]).collect()
    }

    /// Not a number where a field is empty; anything else that is no number ends the trial.
    pub(crate) fn numbers(&self, name: &str) -> Vec<f64> {
        let number = |text: &str| text.parse().unwrap_or_else(|_| panic!("{name}: {text:?} is no number"));
        self.text(name).into_iter().map(|text| if text.is_empty() { f64::NAN } else { number(text) }).collect()
    }
}

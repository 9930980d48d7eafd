//! Where the table of a sheet begins: names, units, first row of values.

use super::sheet::{Cell, Sheet};
use crate::units;

/// What is known of a table before its values.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Header {
    pub(super) names: Vec<String>,
    pub(super) units: Vec<String>,
    /// Number of the first row with values.
    pub(super) first_row: u32,
}

/// The first row that is mostly values, with the names right above it; none if there is no such row.
pub(super) fn find(sheet: &Sheet) -> Option<Header> {
    let rows: Vec<(u32, &[Cell])> = sheet.rows.iter().map(|(number, row)| (*number, row.as_slice())).collect();
    let first = (0..rows.len()).find(|index| begins(&rows[*index..]))?;
    let width = filled(rows[first].1);
    let is_header = |row: &[Cell]| texts(row) * 2 > filled(row) && texts(row) * 2 >= width;
    let above: Vec<&[Cell]> = rows[..first].iter().rev().map(|row| row.1).take_while(|row| is_header(row)).collect();
    let (names, units) = match above.as_slice() {
        [units, names, ..] if are_units(units) => (words(names), words(units)),
        [names, ..] => (words(names), Vec::new()),
        [] => (Vec::new(), Vec::new()),
    };
    Some(Header { names, units, first_row: rows[first].0 })
}

/// A row of values with another soon below it. A single value in a wide sheet is a remark.
fn begins(rows: &[(u32, &[Cell])]) -> bool {
    let is_data = |row: &[Cell]| values(row) * 2 >= filled(row) && values(row) > 0;
    let width = rows.iter().skip(1).take(3).find(|row| is_data(row.1)).map(|row| values(row.1));
    is_data(rows[0].1) && width.is_some_and(|width| width == 1 || values(rows[0].1) > 1)
}

fn values(row: &[Cell]) -> usize {
    row.iter().filter(|cell| cell.is_value()).count()
}

fn texts(row: &[Cell]) -> usize {
    row.iter().filter(|cell| cell.as_text().is_some()).count()
}

fn filled(row: &[Cell]) -> usize {
    row.iter().filter(|cell| **cell != Cell::Empty).count()
}

/// Brackets around them do not count.
fn bare(text: &str) -> &str {
    text.trim_matches(['(', ')', '[', ']', ' '])
}

fn are_units(row: &[Cell]) -> bool {
    let known = |cell: &&Cell| cell.as_text().is_some_and(|text| units::is_unit(text));
    row.iter().filter(known).count() * 2 > texts(row)
}

fn words(row: &[Cell]) -> Vec<String> {
    row.iter().map(|cell| cell.as_text().map(|text| text.to_string()).unwrap_or_default()).collect()
}

impl Header {
    /// Unit of a column, as the row of units has it.
    pub(super) fn unit(&self, column: usize) -> Option<String> {
        self.units.get(column).map(|unit| bare(unit).to_owned()).filter(|unit| !unit.is_empty() && unit != "-")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(rows: &[&[&str]]) -> Sheet {
        let cell = |text: &&str| text.parse().map_or_else(|_| Cell::text(text), Cell::Number);
        let rows = rows.iter().enumerate().map(|(number, row)| (number as u32, row.iter().map(cell).collect()));
        Sheet { name: "a".into(), rows: rows.collect() }
    }

    #[test]
    fn names_stand_above_values_and_units_between_them() {
        let rows: [&[&str]; 5] = [&["Towed body 3"], &["t", "mag"], &["[s]", "nT"], &["1", "2"], &["2", "3"]];
        let header = find(&sheet(&rows)).unwrap();
        assert_eq!((header.names.join(" "), header.first_row), ("t mag".into(), 3));
        assert_eq!([header.unit(0), header.unit(1), header.unit(2)], [Some("s".into()), Some("nT".into()), None]);
    }

    #[test]
    fn a_remark_of_two_words_is_not_a_row_of_units() {
        let header = find(&sheet(&[&["raw", "raw"], &["time", "mag"], &["1", "2"], &["2", "3"]])).unwrap();
        assert_eq!((header.names.join(" "), header.units.len()), ("time mag".into(), 0));
    }

    #[test]
    fn values_alone_have_no_names_and_words_alone_are_no_table() {
        assert_eq!(find(&sheet(&[&["1", "2"], &["2", "3"]])), Some(Header::default()));
        assert_eq!(find(&sheet(&[&["what", "which"], &["body", "3"], &["lake", "K"]])), None);
    }
}

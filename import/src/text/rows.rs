//! Columns that grow by a row of cells at a time.

use super::cell::{is_missing, parse_number};
use super::column::{Column, Pushed, Words};
use super::fields::trimmed;
use super::lines::Line;
use super::signs::Decimal;
use super::tally::Tally;
use crate::source::{FindingKind, Note, SourceTable};

/// No table of readings has more columns; it bounds what names and empty columns cost.
pub(crate) const LARGEST_COLUMNS: usize = 4096;

/// How many rows tell whether a column holds text.
const ROWS_TO_JUDGE: usize = 1000;

/// Columns of the same length.
#[derive(Debug)]
pub(crate) struct Rows {
    columns: Vec<Column>,
    decimal: Decimal,
    places: Vec<u32>,
    words: Words,
    bad: Tally,
    missing: Tally,
    left_out: Tally,
    longer: Tally,
    /// The line within which the file ends, and what became of it.
    cut: Option<(u32, &'static str)>,
}

impl Rows {
    /// Of numbers with a decimal point.
    pub(crate) fn new(columns: Vec<Column>) -> Self {
        Self::with_decimal(columns, Decimal::Point)
    }

    /// Of numbers with this sign before their decimals.
    pub(super) fn with_decimal(columns: Vec<Column>, decimal: Decimal) -> Self {
        let (places, words, cut) = (Vec::new(), Words::default(), None);
        let [bad, missing, left_out, longer] = std::array::from_fn(|_| Tally::default());
        Self { columns, decimal, places, words, bad, missing, left_out, longer, cut }
    }

    /// How many columns it has.
    pub(super) fn width(&self) -> usize {
        self.columns.len()
    }

    /// Whether at least one column of numbers has one in these cells: they are neither a title nor a header that comes again.
    pub(super) fn has_number<'a>(&self, cells: impl Iterator<Item = &'a str>) -> bool {
        let is_number = |cell: &str| parse_number(cell, self.decimal).is_some();
        self.columns.iter().zip(cells).any(|(column, cell)| column.is_numbers() && is_number(cell))
    }

    /// A row; cells that it lacks are missing, those that no column is for are left out.
    pub(crate) fn push<'a>(&mut self, line: u32, mut cells: impl Iterator<Item = &'a str>) {
        self.places.push(line);
        for column in &mut self.columns {
            let cell = trimmed(cells.next().unwrap_or(""));
            match column.push(cell, self.decimal, &mut self.words) {
                Pushed::Good => {}
                Pushed::Mark => self.missing.add_cell(line, cell),
                Pushed::Bad => self.bad.add_cell(line, cell),
            }
        }
        if cells.any(|cell| !cell.is_empty()) {
            self.longer.add(line);
        }
    }

    /// A line that cannot be a row: cut off where it is the file's last and has no end, or else of another shape.
    pub(crate) fn leave_out(&mut self, line: Line<'_>) {
        if line.is_ended {
            self.left_out.add(line.number);
        } else {
            self.cut = Some((line.number, ", which is left out"));
        }
    }

    /// A line of another shape that may be the last one.
    pub(super) fn skip(&mut self, line: u32) {
        self.left_out.add(line);
    }

    /// The row that was pushed last has lost its end.
    pub(super) fn set_cut(&mut self, line: u32) {
        self.cut = Some((line, ": what is cut counts as missing"));
    }

    /// The table; `wanted` says what a line of another shape lacks.
    pub(crate) fn finish(self, wanted: &str) -> SourceTable {
        SourceTable {
            rows: self.places.len(),
            notes: self.notes(wanted),
            columns: self.columns.into_iter().map(Column::finished).collect(),
            places: self.places,
            ..SourceTable::default()
        }
    }

    fn notes(&self, wanted: &str) -> Vec<Note> {
        let (one, several) = ("cell is no number and counts as missing", "cells are no numbers and count as missing");
        let bad = self.bad.note(FindingKind::Dummies, one, several);
        let mark = "a mark that stands for \"missing\"";
        let (one, several) = (format!("cell holds {mark}"), format!("cells hold {mark}"));
        let missing = self.missing.note(FindingKind::Dummies, &one, &several);
        let (one, several) =
            ("row has more cells than there are columns", "rows have more cells than there are columns");
        let longer = self.longer.note(FindingKind::Delimiter, one, several);
        let (one, several) =
            (format!("line without {wanted} is left out"), format!("lines without {wanted} are left out"));
        let left_out = self.left_out.note(FindingKind::Missing, &one, &several);
        let cut = self.cut.map(|(line, what)| Note {
            kind: FindingKind::Truncated,
            text: format!("the file ends within line {line}{what}"),
        });
        [bad, missing, longer, left_out, cut].into_iter().flatten().collect()
    }
}

/// Which columns hold text: those with more words than numbers in the first rows.
pub(crate) fn are_text<'a, R: IntoIterator<Item = &'a str>>(
    rows: impl Iterator<Item = R>,
    columns: usize,
    decimal: Decimal,
) -> Vec<bool> {
    let mut surplus = vec![0_i32; columns];
    for row in rows.take(ROWS_TO_JUDGE) {
        for (surplus, cell) in surplus.iter_mut().zip(row).filter(|(_, cell)| !is_missing(cell.trim())) {
            *surplus += if parse_number(cell, decimal).is_none() { 1 } else { -1 };
        }
    }
    surplus.into_iter().map(|surplus| surplus > 0).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::column::Missing;
    use super::*;
    use crate::source::Values;

    fn line(number: u32, is_ended: bool) -> Line<'static> {
        Line { number, offset: 0, text: "", is_ended }
    }

    #[test]
    fn cells_are_numbers_missing_or_bad() {
        let missing = Missing::Where(|value| value > 1e31, 1e32);
        let mut rows =
            Rows::new(vec![Column::new("a", Some("nT"), missing, false), Column::new("b", None, missing, true)]);
        for (number, row) in (3..).zip(["1 x", "* x", "1e32 *", "one 5"]) {
            rows.push(number, row.split(' '));
        }
        rows.push(7, ["2"].into_iter());
        let table = rows.finish("both");
        let numbers = table.columns[0].as_numbers().unwrap();
        assert_eq!(format!("{numbers:?}"), "[1.0, NaN, NaN, NaN, 2.0]");
        assert_eq!((table.columns[0].dummy, table.columns[1].dummy), (Some(1e32), None));
        assert_eq!(table.columns[1].values, Values::Text(["x", "x", "", "5", ""].map(Arc::from).to_vec()));
        assert_eq!((table.rows, &table.places[..]), (5, &[3, 4, 5, 6, 7][..]));
        let [note, missing] = &table.notes[..] else { panic!("{:?}", table.notes) };
        assert_eq!(missing.text, "1 cell holds a mark that stands for \"missing\": \"*\" in line 4");
        assert_eq!(
            (note.kind, &note.text[..]),
            (FindingKind::Dummies, "1 cell is no number and counts as missing: \"one\" in line 6")
        );
    }

    #[test]
    fn lines_that_are_no_rows_are_told() {
        let mut rows = Rows::new(Vec::new());
        rows.leave_out(line(4, true));
        rows.leave_out(line(6, true));
        rows.leave_out(line(9, false));
        let notes: Vec<_> = rows.finish("2 fields").notes.into_iter().map(|note| (note.kind, note.text)).collect();
        let left_out = "2 lines without 2 fields are left out: first in line 4".to_string();
        let cut = "the file ends within line 9, which is left out".to_string();
        assert_eq!(notes, [(FindingKind::Missing, left_out), (FindingKind::Truncated, cut)]);
    }

    #[test]
    fn columns_with_more_words_than_numbers_are_text() {
        let rows = ["1 a 1", "2 b x", "* c 3"].map(|row| row.split(' '));
        assert_eq!(are_text(rows.into_iter(), 4, Decimal::Point), [false, true, false, false]);
    }
}

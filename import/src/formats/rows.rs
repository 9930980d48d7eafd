//! Columns that grow by a row of cells at a time.

use std::collections::HashSet;
use std::sync::Arc;

use super::text::{Line, number};
use crate::source::{FindingKind, Note, SourceColumn, SourceTable, Values};

/// No format of records has more; it bounds what names and empty columns cost.
pub(super) const LARGEST_COLUMNS: usize = 4096;

/// How many rows tell whether a column holds text.
const ROWS_TO_JUDGE: usize = 1000;

/// What stands for "missing" besides an empty cell and `*`.
#[derive(Clone, Copy, Debug)]
pub(super) enum Missing {
    /// Nothing.
    Nothing,
    /// One number.
    Value(f64),
    /// The numbers for which this holds; the number to tell of them.
    Where(fn(f64) -> bool, f64),
}

/// How often something was met, and on which line first.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    count: usize,
    first: u32,
}

/// A column that grows.
#[derive(Debug)]
pub(super) struct Column {
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

/// Columns of the same length.
#[derive(Debug)]
pub(super) struct Rows {
    columns: Vec<Column>,
    places: Vec<u32>,
    words: Words,
    bad: Tally,
    missing: Tally,
    left_out: Tally,
    cut: Option<u32>,
}

/// Texts that are held once.
#[derive(Debug, Default)]
pub(super) struct Words(HashSet<Arc<str>>);

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

impl Tally {
    pub(super) fn add(&mut self, line: u32) {
        if self.count == 0 {
            self.first = line;
        }
        self.count += 1;
    }

    pub(super) fn count(self) -> usize {
        self.count
    }

    /// A sentence from what one is and what several are, if there was any: `3 cells are no numbers ...: first in line 7`.
    pub(super) fn note(self, kind: FindingKind, one: &str, several: &str) -> Option<Note> {
        let what = if self.count == 1 { one } else { several };
        let where_ = if self.count == 1 { "in line" } else { "first in line" };
        let text = format!("{} {what}: {where_} {}", self.count, self.first);
        (self.count > 0).then_some(Note { kind, text })
    }
}

impl Words {
    pub(super) fn shared(&mut self, text: &str) -> Arc<str> {
        if let Some(known) = self.0.get(text) {
            return known.clone();
        }
        let new: Arc<str> = text.into();
        self.0.insert(new.clone());
        new
    }
}

impl Column {
    pub(super) fn new(name: impl Into<String>, unit: Option<&str>, missing: Missing, is_text: bool) -> Self {
        let cells = if is_text { Cells::Text(Vec::new()) } else { Cells::Numbers(Vec::new()) };
        Self { name: name.into(), unit: unit.filter(|unit| !unit.is_empty()).map(str::to_string), missing, cells }
    }

    fn push(&mut self, cell: &str, words: &mut Words) -> bool {
        let value = number(cell);
        let is_missing = is_blank(cell) || value.is_some_and(|value| self.missing.is(value));
        match &mut self.cells {
            Cells::Numbers(numbers) => numbers.push(value.filter(|_| !is_missing).unwrap_or(f64::NAN)),
            Cells::Text(texts) => {
                texts.push(words.shared(if is_missing { "" } else { cell }));
                return true;
            }
        }
        is_missing || value.is_some()
    }

    fn finished(self) -> SourceColumn {
        let values = match self.cells {
            Cells::Numbers(mut numbers) => {
                numbers.shrink_to_fit();
                Values::Numbers(numbers)
            }
            Cells::Text(mut texts) => {
                texts.shrink_to_fit();
                Values::Text(texts)
            }
        };
        let dummy = if matches!(values, Values::Numbers(_)) { self.missing.told() } else { None };
        SourceColumn { name: self.name, unit: self.unit, values, dummy }
    }
}

impl Rows {
    pub(super) fn new(columns: Vec<Column>) -> Self {
        let (places, words, cut) = (Vec::new(), Words::default(), None);
        let [bad, missing, left_out] = [Tally::default(); 3];
        Self { columns, places, words, bad, missing, left_out, cut }
    }

    /// A row; cells that it lacks are missing.
    pub(super) fn push<'a>(&mut self, line: u32, mut cells: impl Iterator<Item = &'a str>) {
        self.places.push(line);
        for column in &mut self.columns {
            let cell = cells.next().unwrap_or("").trim();
            if !column.push(cell, &mut self.words) {
                self.bad.add(line);
            } else if cell == "*" {
                self.missing.add(line);
            }
        }
    }

    /// A line that cannot be a row: cut off where it is the file's last and has no end, or else of another shape.
    pub(super) fn leave_out(&mut self, line: Line<'_>) {
        if line.is_ended {
            self.left_out.add(line.number);
        } else {
            self.cut = Some(line.number);
        }
    }

    /// The table; `wanted` says what a line of another shape lacks.
    pub(super) fn finish(self, wanted: &str) -> SourceTable {
        let cells = "no number and counts as missing";
        let bad = self.bad.note(
            FindingKind::Dummies,
            &format!("cell is {cells}"),
            "cells are no numbers and count as missing",
        );
        let missing = self.missing.note(FindingKind::Dummies, "cell is missing (*)", "cells are missing (*)");
        let one = format!("line without {wanted} is left out");
        let left_out = self.left_out.note(FindingKind::Missing, &one, &format!("lines without {wanted} are left out"));
        let cut = self.cut.map(|line| Note {
            kind: FindingKind::Truncated,
            text: format!("the file ends within line {line}, which is left out"),
        });
        SourceTable {
            rows: self.places.len(),
            columns: self.columns.into_iter().map(Column::finished).collect(),
            places: self.places,
            notes: [bad, missing, left_out, cut].into_iter().flatten().collect(),
            ..SourceTable::default()
        }
    }
}

/// Which columns hold text: those with more words than numbers in the first rows.
pub(super) fn are_text<'a, R: Iterator<Item = &'a str>>(rows: impl Iterator<Item = R>, columns: usize) -> Vec<bool> {
    let mut surplus = vec![0_i32; columns];
    for row in rows.take(ROWS_TO_JUDGE) {
        for (surplus, cell) in surplus.iter_mut().zip(row).filter(|(_, cell)| !is_blank(cell)) {
            *surplus += if number(cell).is_none() { 1 } else { -1 };
        }
    }
    surplus.into_iter().map(|surplus| surplus > 0).collect()
}

/// Whether a line without an end lost characters: fields, or decimals that the last field of the row before has.
pub(super) fn is_cut(line: Line<'_>, fields: usize, wanted: usize, last: &str, last_before: &str) -> bool {
    let decimals = |field: &str| field.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    !line.is_ended && (fields < wanted || decimals(last) < decimals(last_before))
}

fn is_blank(cell: &str) -> bool {
    matches!(cell.trim(), "" | "*" | "nan" | "NaN" | "NAN")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(number: u32, is_ended: bool) -> Line<'static> {
        Line { number, text: "", is_ended }
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
        assert_eq!(missing.text, "2 cells are missing (*): first in line 4");
        assert_eq!(
            (note.kind, &note.text[..]),
            (FindingKind::Dummies, "1 cell is no number and counts as missing: in line 6")
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
    fn a_cut_line_lacks_fields_or_decimals() {
        assert!(is_cut(line(2, false), 1, 2, "5", "5"));
        assert!(is_cut(line(2, false), 2, 2, "5.1", "5.12"));
        assert!(!is_cut(line(2, false), 2, 2, "5.12", "5.1"));
        assert!(!is_cut(line(2, true), 1, 2, "5", "5"));
    }

    #[test]
    fn columns_with_more_words_than_numbers_are_text() {
        let rows = ["1 a 1", "2 b x", "* c 3"].map(|row| row.split(' '));
        assert_eq!(are_text(rows.into_iter(), 4), [false, true, false, false]);
    }
}

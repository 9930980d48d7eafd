//! Geosoft XYZ: rows of numbers under the lines that they belong to.
//! <https://help.seequent.com/Oasismontaj/2024.2/Content/ss/glossary/xyz_data.htm>

use std::sync::Arc;

use super::civil;
use super::format::{Input, SourceFormat};
use super::geosoft_record::{Record, is_row, record};
use crate::error::ImportError;
use crate::source::{FindingKind, Note, Source, SourceColumn, SourceTable, Values};
use crate::text::{
    Column, Decimal, Fields, LARGEST_COLUMNS, Line, Missing, Rows, Words, are_text, decoded, is_cut, lines,
    loose_fields, name_and_unit,
};
use crate::units;

/// Geosoft XYZ.
#[derive(Debug)]
pub(super) struct GeosoftXyz;

/// What the comments say of the columns; no units where none says them.
struct Names<'a> {
    names: Vec<&'a str>,
    units: Vec<&'a str>,
}

/// What the rows after a record belong to, and what they did.
#[derive(Default)]
struct Labels {
    words: Words,
    current: [Arc<str>; 3],
    columns: [Vec<Arc<str>>; 3],
    is_given: [bool; 3],
}

const LABELS: [&str; 3] = ["line", "flight", "date"];

impl SourceFormat for GeosoftXyz {
    fn name(&self) -> &'static str {
        "Geosoft XYZ"
    }

    /// By a line's, flight's or date's record before rows; nothing but comments may stand before those.
    fn recognises(&self, first: &[u8]) -> bool {
        let text = decoded(first);
        let mut has_label = false;
        for line in lines(&text) {
            match record(line.text) {
                Record::Line(_) | Record::Flight(_) | Record::Date(_) => has_label = true,
                Record::Row(row) if has_label || !is_row(row) => return has_label && is_row(row),
                Record::Row(_) | Record::Blank | Record::Comment(_) => {}
            }
        }
        false
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let text = decoded(input.bytes);
        let lacks_rows =
            || ImportError::file(input.file, "a Geosoft XYZ file without rows: export it again, with its data");
        let width = first_width(&text).ok_or_else(lacks_rows)?;
        if width > LARGEST_COLUMNS {
            return Err(ImportError::file(
                input.file,
                format!("rows of {width} fields: {LARGEST_COLUMNS} are the most"),
            ));
        }
        let names = names(&text, width);
        let mut rows = Rows::new(columns(names.as_ref(), &are_text(rows_of(&text), width, Decimal::Point)));
        let mut labels = Labels::default();
        fill(&text, width, &mut rows, &mut labels);
        let mut table = rows.finish(&format!("the {width} fields of the first"));
        labels.add_to(&mut table);
        if names.is_none() {
            let text =
                format!("no comment before the data names its {width} columns: they are column_1 to column_{width}");
            table.notes.push(Note { kind: FindingKind::Missing, text });
        }
        Ok(Source { file: input.file.into(), format: self.name(), tables: vec![table] })
    }
}

impl Labels {
    fn set(&mut self, which: usize, text: &str) {
        if let (Some(current), Some(is_given)) = (self.current.get_mut(which), self.is_given.get_mut(which)) {
            *current = self.words.shared(text);
            *is_given = true;
        }
    }

    fn push(&mut self) {
        for (column, current) in self.columns.iter_mut().zip(&self.current) {
            column.push(current.clone());
        }
    }

    /// The columns that a record gave, before those of the rows; and the date of the first row.
    fn add_to(self, table: &mut SourceTable) {
        let given = LABELS.into_iter().zip(self.columns).zip(self.is_given).filter(|(_, is_given)| *is_given);
        let mut columns: Vec<_> = given.map(|((name, texts), _)| labels_column(name, texts)).collect();
        let date = columns.iter().find(|column| column.name == "date");
        if let Some(Values::Text(dates)) = date.map(|column| &column.values) {
            table.facts.date = dates.first().and_then(|date| civil::date(date));
        }
        columns.append(&mut table.columns);
        table.columns = columns;
    }
}

fn labels_column(name: &str, mut texts: Vec<Arc<str>>) -> SourceColumn {
    texts.shrink_to_fit();
    SourceColumn { name: name.into(), unit: None, values: Values::Text(texts), dummy: None }
}

/// `-1e32` and `1e32` of its databases, which single precision does not keep exactly.
fn is_dummy(value: f64) -> bool {
    value.abs() >= 1e31
}

fn columns(names: Option<&Names<'_>>, are_text: &[bool]) -> Vec<Column> {
    let missing = Missing::Where(is_dummy, -1e32);
    let column = |(index, is_text): (usize, &bool)| match names.and_then(|names| names.names.get(index)) {
        Some(field) => {
            let (name, unit) = name_and_unit(field);
            let unit = unit.as_deref().or(names.and_then(|names| names.units.get(index).copied()));
            Column::new(name, unit, missing, *is_text)
        }
        None => Column::new(format!("column_{}", index + 1), None, missing, *is_text),
    };
    are_text.iter().enumerate().map(column).collect()
}

fn rows_of(text: &str) -> impl Iterator<Item = Fields<'_>> {
    lines(text).filter_map(|line| match record(line.text) {
        Record::Row(row) => Some(loose_fields(row)),
        _ => None,
    })
}

/// How many fields the first row has.
fn first_width(text: &str) -> Option<usize> {
    rows_of(text).next().map(Iterator::count)
}

/// The last comment before the first row that has a name for each of its fields, and that of units after it.
fn names(text: &str, width: usize) -> Option<Names<'_>> {
    let before = lines(text).map(|line| record(line.text)).take_while(|record| !matches!(record, Record::Row(_)));
    let comments = before.filter_map(|record| match record {
        Record::Comment(comment) => Some(loose_fields(comment)).filter(|fields| fields.clone().count() == width),
        _ => None,
    });
    let comments: Vec<Vec<&str>> = comments.map(Iterator::collect).collect();
    let at = comments.iter().rposition(|comment| comment.iter().all(has_letter) && !are_units(comment))?;
    let units = comments.get(at + 1).filter(|comment| are_units(comment)).cloned().unwrap_or_default();
    let units = units.into_iter().map(bare).collect();
    comments.get(at).map(|names| Names { names: names.clone(), units })
}

fn has_letter(field: &&str) -> bool {
    field.contains(char::is_alphabetic)
}

/// Without brackets; nothing for a `-`.
fn bare(unit: &str) -> &str {
    unit.trim_matches(['[', ']', '(', ')', '-'])
}

fn are_units(fields: &[&str]) -> bool {
    fields.iter().map(|field| bare(field)).all(|field| field.is_empty() || units::is_unit(field))
        && fields.iter().any(has_letter)
}

fn fill(text: &str, width: usize, rows: &mut Rows, labels: &mut Labels) {
    let mut last_before = "";
    for line in lines(text) {
        match record(line.text) {
            Record::Line(label) => labels.set(0, &label),
            Record::Flight(flight) => labels.set(1, flight),
            Record::Date(date) => labels.set(2, date),
            Record::Row(row) => {
                if let Some(last) = row_end(line, row, width, last_before) {
                    rows.push(line.number, loose_fields(row));
                    labels.push();
                    last_before = last;
                } else {
                    rows.leave_out(line);
                }
            }
            Record::Blank | Record::Comment(_) => {}
        }
    }
}

/// The last field of a row that is whole.
fn row_end<'a>(line: Line<'_>, row: &'a str, width: usize, last_before: &str) -> Option<&'a str> {
    let (count, last) = loose_fields(row).fold((0, ""), |(count, _), field| (count + 1, field));
    (count == width && !is_cut(line.is_ended, count, width, last, last_before)).then_some(last)
}

#[cfg(test)]
#[path = "geosoft_xyz_tests.rs"]
mod tests;

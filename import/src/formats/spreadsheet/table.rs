//! A sheet as a table: columns that have a type each.

use std::sync::Arc;

use super::header::{self, Header};
use super::sheet::{Cell, Sheet};
use crate::source::{Facts, FindingKind, Note, SourceColumn, SourceTable, Values};
use crate::text::{Decimal, is_missing, name_and_unit, parse_number};

/// Beginnings of names that a column of times may have.
const TIMES: [&str; 8] = ["time", "date", "utc", "gps_time", "timestamp", "sec", "zeit", "datum"];

/// The table that a sheet holds, if it does.
pub(super) fn of(sheet: Sheet) -> Option<SourceTable> {
    let header = header::find(&sheet)?;
    let rows: Vec<(u32, Vec<Cell>)> = sheet.rows.into_iter().filter(|(row, _)| *row >= header.first_row).collect();
    let width = rows.iter().map(|(_, row)| row.len()).max().unwrap_or(0);
    let mut notes = Vec::new();
    let columns = (0..width).filter_map(|index| column(&rows, index, &header, &mut notes)).collect();
    let places = rows.iter().map(|(row, _)| row + 1).collect();
    Some(SourceTable { name: sheet.name, rows: rows.len(), columns, places, facts: Facts::default(), notes })
}

/// Whether a column of it is times, by type or by name.
pub(super) fn has_times(table: &SourceTable) -> bool {
    table.columns.iter().any(|column| {
        let name = column.name.to_lowercase();
        matches!(column.values, Values::Times(_)) || TIMES.iter().any(|start| name.starts_with(start))
    })
}

/// A column; none if nothing stands in it.
fn column(rows: &[(u32, Vec<Cell>)], index: usize, header: &Header, notes: &mut Vec<Note>) -> Option<SourceColumn> {
    let title = header.names.get(index).map(String::as_str).unwrap_or_default();
    let cells = || rows.iter().map(|(_, row)| row.get(index).unwrap_or(&Cell::Empty));
    if title.is_empty() && cells().all(|cell| *cell == Cell::Empty) {
        return None;
    }
    let (name, in_brackets) = name_and_unit(title);
    let values = if cells().any(|cell| matches!(cell, Cell::Date(_) | Cell::Time(_))) {
        Values::Times(cells().map(time).collect())
    } else {
        numbers(cells().cloned(), &name, notes).unwrap_or_else(|| Values::Text(cells().map(text).collect()))
    };
    Some(SourceColumn { name, unit: header.unit(index).or(in_brackets), values, dummy: None })
}

fn time(cell: &Cell) -> f64 {
    match cell {
        Cell::Date(seconds) | Cell::Time(seconds) => *seconds,
        Cell::Empty | Cell::Number(_) | Cell::Text(_) => f64::NAN,
    }
}

fn text(cell: &Cell) -> Arc<str> {
    match cell {
        Cell::Text(text) => text.clone(),
        Cell::Number(number) => number.to_string().into(),
        Cell::Empty | Cell::Date(_) | Cell::Time(_) => "".into(),
    }
}

/// A number in a cell of text; a comma stands before its decimals rather than between its thousands.
fn written_number(text: &str) -> Option<f64> {
    let by_comma = text.contains(',').then(|| parse_number(text, Decimal::Comma)).flatten();
    by_comma.or_else(|| parse_number(text, Decimal::Point))
}

/// Numbers where all texts are numbers too, as some programs write them, or stand for a missing one.
fn numbers(cells: impl Iterator<Item = Cell>, name: &str, notes: &mut Vec<Note>) -> Option<Values> {
    let (mut numbers, mut missing) = (Vec::new(), 0);
    for cell in cells {
        numbers.push(match &cell {
            Cell::Number(number) => *number,
            Cell::Text(text) if is_missing(text) => {
                missing += 1;
                f64::NAN
            }
            Cell::Text(text) => written_number(text)?,
            Cell::Empty | Cell::Date(_) | Cell::Time(_) => f64::NAN,
        });
    }
    if missing > 0 {
        let text = format!("{missing} cells of \"{name}\" hold a mark that stands for a missing value");
        notes.push(Note { kind: FindingKind::Dummies, text });
    }
    Some(Values::Numbers(numbers))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_texts_have_points_or_commas() {
        let written = ["1,5", "51.384", "51,384.25", "51.384,25", "leg 1"].map(written_number);
        assert_eq!(written, [Some(1.5), Some(51.384), Some(51384.25), Some(51384.25), None]);
    }

    #[test]
    fn each_column_gets_its_type_and_rows_keep_their_places() {
        let rows = [
            (2, vec![Cell::text("time"), Cell::text("mag (nT)"), Cell::text("line"), Cell::text("x")]),
            (4, vec![Cell::Date(10.0), Cell::Number(5.0), Cell::text("L1"), Cell::text("1,5")]),
            (5, vec![Cell::Date(11.0), Cell::text("*"), Cell::text("L1")]),
            (9, vec![Cell::Empty, Cell::Number(6.0), Cell::Number(7.0), Cell::Number(2.0)]),
        ];
        let table = of(Sheet { name: "a".into(), rows: rows.into_iter().collect() }).unwrap();
        assert!(has_times(&table));
        assert_eq!(table.places, [5, 6, 10]);
        let Values::Times(times) = &table.columns[0].values else { panic!("no times") };
        assert!(times[..2] == [10.0, 11.0] && times[2].is_nan());
        assert_eq!((table.columns[1].name.as_str(), table.columns[1].unit.as_deref()), ("mag", Some("nT")));
        let mag = table.columns[1].as_numbers().unwrap();
        assert!(mag[0] == 5.0 && mag[1].is_nan() && mag[2] == 6.0);
        assert_eq!(table.columns[2].values, Values::Text(["L1", "L1", "7"].map(Arc::from).to_vec()));
        assert_eq!(table.columns[3].as_numbers().unwrap()[0], 1.5);
        assert_eq!(table.notes.len(), 1);
    }
}

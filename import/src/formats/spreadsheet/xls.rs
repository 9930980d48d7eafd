//! Workbooks of 1997 to 2003: "Excel Binary File Format (.xls) Structure", Microsoft [MS-XLS].
//!
//! `calamine` makes room for as many cells as the file claims, and a table as large as its two most distant cells make it.
//! So the records of the file are looked through first.

use std::io::{Cursor, Read as _};

use calamine::{Data, Range, Reader as _, Xls};

use super::super::memory::Budget;
use super::sheet::{Cell, Fault, Sheet};
use super::times;

/// Compound files of Microsoft begin with it.
const SIGNATURE: &[u8] = &[0xd0, 0xcf, 0x11, 0xe0, 0xa1, 0xb1, 0x1a, 0xe1];
/// Records of cells, all of which begin with row and column: formula, number, labels, errors, blanks, several at a time.
const CELLS: [u16; 11] = [0x0006, 0x00bd, 0x00be, 0x00d6, 0x00fd, 0x0201, 0x0203, 0x0204, 0x0205, 0x027e, 0x0406];
const DIMENSIONS: u16 = 0x0200;
/// Bytes that `calamine` takes for a cell, with its place.
const CELL_BYTES: usize = size_of::<calamine::Cell<Data>>();

/// Any compound file.
pub(super) fn recognises(first: &[u8]) -> bool {
    first.starts_with(SIGNATURE)
}

/// All of its sheets.
pub(super) fn sheets(bytes: &[u8], budget: &mut Budget) -> Result<Vec<Sheet>, Fault> {
    check(&workbook(bytes, budget)?, budget)?;
    // The last resort: `calamine` 0.38 reads fields of records in some ninety places without a look at how long the record
    // is, and so panics on damaged ones (found by random changes). All that it made is dropped then. The panic's own message is
    // still printed: a library must not exchange the hook of the whole program.
    let opened = std::panic::catch_unwind(|| open(bytes));
    let (is_from_1904, ranges) = opened.map_err(|_| Fault::damaged("a record is too short"))??;
    let mut sheets = Vec::new();
    for (name, range) in ranges {
        let (first_row, first_column) = range.start().unwrap_or_default();
        let mut sheet = Sheet::new(name);
        for (row, column, value) in range.used_cells() {
            let place = (first_row + row as u32, first_column + column as u32);
            sheet.put(place.0, place.1, cell(value, is_from_1904), budget)?;
        }
        sheets.push(sheet);
    }
    Ok(sheets)
}

/// A sheet as `calamine` gives it, with its name.
type Named = (String, Range<Data>);

/// Whether its calendar starts with 1904, and its sheets.
fn open(bytes: &[u8]) -> Result<(bool, Vec<Named>), Fault> {
    let mut book: Xls<_> = Xls::new(Cursor::new(bytes)).map_err(Fault::damaged)?;
    let names = book.sheet_names();
    let named = |name: String| Ok((name.clone(), book.worksheet_range(&name).map_err(Fault::damaged)?));
    let ranges = names.into_iter().map(named).collect::<Result<_, Fault>>()?;
    Ok((book.has_1904_epoch(), ranges))
}

fn cell(value: &Data, is_from_1904: bool) -> Cell {
    match value {
        Data::Int(number) => Cell::Number(*number as f64),
        Data::Float(number) => Cell::Number(*number),
        Data::Bool(flag) => Cell::Number(f64::from(u8::from(*flag))),
        Data::String(text) => Cell::text(text),
        Data::DateTime(moment) => times::from_serial(moment.as_f64(), moment.is_duration(), is_from_1904),
        Data::DateTimeIso(text) => times::from_iso_date(text).unwrap_or_else(|| Cell::text(text)),
        Data::DurationIso(text) => times::from_iso_duration(text).unwrap_or_else(|| Cell::text(text)),
        Data::Error(_) | Data::Empty => Cell::Empty,
    }
}

/// The stream of records.
fn workbook(bytes: &[u8], budget: &mut Budget) -> Result<Vec<u8>, Fault> {
    let mut file = cfb::CompoundFile::open(Cursor::new(bytes)).map_err(Fault::damaged)?;
    let name = ["/Workbook", "/Book"].into_iter().find(|name| file.is_stream(name));
    let name = name.ok_or_else(|| Fault::damaged("it holds no workbook"))?;
    let mut records = Vec::new();
    let stream = file.open_stream(name).map_err(Fault::damaged)?;
    stream.take(budget.left() as u64 + 1).read_to_end(&mut records).map_err(Fault::damaged)?;
    budget.take(records.len(), 1)?;
    Ok(records)
}

/// That neither the size that a sheet claims nor the place of a cell asks for more than the file warrants.
fn check(mut records: &[u8], budget: &mut Budget) -> Result<(), Fault> {
    let word = |bytes: &[u8], place: usize| {
        bytes.get(place..place + 2).map_or(0, |bytes| usize::from(u16::from_le_bytes([bytes[0], bytes[1]])))
    };
    let (mut rows, mut columns) = (0, 0);
    while records.len() >= 4 {
        let (kind, length) = (word(records, 0) as u16, word(records, 2));
        let Some(data) = records.get(4..4 + length) else {
            return Err(Fault::damaged("a record ends behind the file"));
        };
        records = &records[4 + length..];
        if CELLS.contains(&kind) {
            rows = rows.max(word(data, 0) + 1);
            columns = columns.max(word(data, 2) + 1);
        } else if kind == DIMENSIONS {
            let (rows, columns) = dimensions(data).ok_or_else(|| Fault::damaged("the size of a sheet"))?;
            budget.take(rows.saturating_mul(columns), CELL_BYTES)?;
        }
    }
    Ok(budget.clone().take(rows * columns, CELL_BYTES)?)
}

/// Rows and columns that a sheet claims; none if its ends are in the wrong order.
fn dimensions(data: &[u8]) -> Option<(usize, usize)> {
    let word = |place: usize| Some(usize::from(u16::from_le_bytes(data.get(place..place + 2)?.try_into().ok()?)));
    let long = |place: usize| Some(u32::from_le_bytes(data.get(place..place + 4)?.try_into().ok()?) as usize);
    let (rows, columns) = match data.len() {
        10 => ((word(0)?, word(2)?), (word(4)?, word(6)?)),
        _ => ((long(0)?, long(4)?), (word(8)?, word(10)?)),
    };
    // Ends stand one behind the last; an empty sheet has zeros.
    Some((rows.1.checked_sub(rows.0)? + 1, columns.1.checked_sub(columns.0)? + 1))
}

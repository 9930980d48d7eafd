//! Workbooks in Office Open XML. Cells come one by one: a table of all places, as the library also makes it, would be as
//! large as the two most distant cells make it.

use std::io::Cursor;

use calamine::{DataRef, Reader as _, SheetType, Xlsx};

use super::super::memory::Budget;
use super::sheet::{Cell, Fault, Sheet};
use super::times;

/// An archive with the parts of such a workbook.
pub(super) fn recognises(first: &[u8]) -> bool {
    let has = |word: &[u8]| first.windows(word.len()).any(|bytes| bytes == word);
    first.starts_with(b"PK\x03\x04") && (has(b"[Content_Types].xml") || has(b"xl/"))
}

/// All of its sheets.
pub(super) fn sheets(bytes: &[u8], budget: &mut Budget) -> Result<Vec<Sheet>, Fault> {
    if bytes.windows(15).any(|name| name == b"xl/workbook.bin") {
        return Err(Fault::Binary);
    }
    let mut book: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(Fault::damaged)?;
    let is_from_1904 = book.has_1904_epoch();
    let names = book.sheets_metadata().iter().filter(|sheet| sheet.typ == SheetType::WorkSheet);
    let names: Vec<String> = names.map(|sheet| sheet.name.clone()).collect();
    names.into_iter().map(|name| sheet(&mut book, name, is_from_1904, budget)).collect()
}

fn sheet(
    book: &mut Xlsx<Cursor<&[u8]>>,
    name: String,
    is_from_1904: bool,
    budget: &mut Budget,
) -> Result<Sheet, Fault> {
    let mut cells = book.worksheet_cells_reader(&name).map_err(Fault::damaged)?;
    let mut sheet = Sheet::new(name);
    while let Some(found) = cells.next_cell().map_err(Fault::damaged)? {
        let (row, column) = found.get_position();
        sheet.put(row, column, cell(found.get_value(), is_from_1904), budget)?;
    }
    Ok(sheet)
}

fn cell(value: &DataRef<'_>, is_from_1904: bool) -> Cell {
    match value {
        DataRef::Int(number) => Cell::Number(*number as f64),
        DataRef::Float(number) => Cell::Number(*number),
        DataRef::Bool(flag) => Cell::Number(f64::from(u8::from(*flag))),
        DataRef::String(text) => Cell::text(text),
        DataRef::SharedString(text) => Cell::text(text),
        DataRef::DateTime(moment) => times::from_serial(moment.as_f64(), moment.is_duration(), is_from_1904),
        DataRef::DateTimeIso(text) => times::from_iso_date(text).unwrap_or_else(|| Cell::text(text)),
        DataRef::DurationIso(text) => times::from_iso_duration(text).unwrap_or_else(|| Cell::text(text)),
        // `#DIV/0!` and its like: a value that is missing.
        DataRef::Error(_) | DataRef::Empty => Cell::Empty,
    }
}

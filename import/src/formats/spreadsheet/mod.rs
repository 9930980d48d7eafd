//! Spreadsheets: xlsx and ods (archives of XML), and xls of 1997 to 2003.

mod archive;
mod header;
mod ods;
mod places;
mod sheet;
mod table;
mod times;
mod xls;
mod xlsx;

use self::sheet::{Fault, Sheet};
use super::format::{Input, SourceFormat};
use super::memory::Budget;
use crate::error::ImportError;
use crate::source::{FindingKind, Note, Source, SourceTable};

/// Reader of workbooks.
pub(super) struct Spreadsheet;

impl SourceFormat for Spreadsheet {
    fn name(&self) -> &'static str {
        "spreadsheet"
    }

    fn recognises(&self, first: &[u8]) -> bool {
        xls::recognises(first) || ods::recognises(first) || xlsx::recognises(first)
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let (format, sheets) = read(input.bytes).map_err(|fault| ImportError::file(input.file, fault.to_string()))?;
        let tables = tables(input, sheets)?;
        Ok(Source { file: input.file.into(), format, tables })
    }
}

fn read(bytes: &[u8]) -> Result<(&'static str, Vec<Sheet>), Fault> {
    let mut budget = Budget::of(bytes.len());
    if xls::recognises(bytes) {
        return Ok(("xls", xls::sheets(bytes, &mut budget)?));
    }
    archive::check(bytes, &mut budget)?;
    // The cells are made beside what they are made of.
    let mut budget = Budget::of(bytes.len());
    if ods::recognises(bytes) {
        Ok(("ods", ods::sheets(bytes, &mut budget)?))
    } else {
        Ok(("xlsx", xlsx::sheets(bytes, &mut budget)?))
    }
}

/// The sheet that was asked for; else all that have times of their own; else the longest.
fn tables(input: &Input<'_>, sheets: Vec<Sheet>) -> Result<Vec<SourceTable>, ImportError> {
    let names = sheets.iter().map(|sheet| format!("\"{}\"", sheet.name)).collect::<Vec<_>>().join(", ");
    let count = sheets.len();
    if let Some(wanted) = input.part {
        let sheet = sheets.into_iter().find(|sheet| sheet.name == wanted);
        let sheet =
            sheet.ok_or_else(|| ImportError::file(input.file, format!("has no sheet \"{wanted}\"; it has {names}")))?;
        let none = || ImportError::file(input.file, format!("the sheet \"{wanted}\" holds no table of numbers"));
        return Ok(vec![table::of(sheet).ok_or_else(none)?]);
    }
    let (mut taken, others): (Vec<_>, Vec<_>) = sheets.into_iter().filter_map(table::of).partition(table::has_times);
    if taken.is_empty() {
        taken.extend(others.into_iter().reduce(|longest, next| if next.rows > longest.rows { next } else { longest }));
    }
    let given = taken.iter().map(|table| format!("\"{}\"", table.name)).collect::<Vec<_>>().join(", ");
    let Some(first) = taken.first_mut() else {
        return Err(ImportError::file(input.file, format!("no sheet holds a table of numbers: {names}")));
    };
    if given != names && count > 1 {
        first.notes.push(Note { kind: FindingKind::Choice, text: format!("of the sheets {names} took {given}") });
    }
    Ok(taken)
}

#[cfg(test)]
mod tests;

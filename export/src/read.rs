//! A CSV file of ours, read as typed columns.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use csv::{ErrorKind, StringRecord};

use crate::error::{ExportError, quoted};
use crate::table::{Table, TableColumn};
use crate::units::unit_of;

mod cells;

/// The tables of a result folder, the one that holds most first.
const TABLES: [&str; 3] = ["compensated.csv", "levelled.csv", "recording.csv"];

/// The table that is meant: the file itself, or that of a result folder.
///
/// # Errors
///
/// When a folder holds none.
pub fn find(path: &Path) -> Result<PathBuf, ExportError> {
    if !path.is_dir() {
        return Ok(path.into());
    }
    let what = || format!("holds none of {}: name the file that is to be exported", TABLES.join(", "));
    let found = TABLES.iter().map(|name| path.join(name)).find(|table| table.is_file());
    found.ok_or_else(|| ExportError::File { file: path.display().to_string(), what: what() })
}

/// Read a file.
///
/// # Errors
///
/// When it cannot be read, or is no table of ours.
pub fn read(path: &Path) -> Result<Table, ExportError> {
    let file = path.display().to_string();
    match File::open(path) {
        Ok(input) => read_from(&file, input),
        Err(source) => Err(ExportError::Io { file, source }),
    }
}

/// Read a table; `file` is what messages call it.
///
/// # Errors
///
/// As [`read`].
pub fn read_from(file: &str, input: impl Read) -> Result<Table, ExportError> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(input);
    let header = reader.headers().map_err(|error| bad(file, &[], error))?;
    let names = names(file, header)?;
    let mut rows: Vec<StringRecord> = Vec::new();
    for row in reader.into_records() {
        rows.push(row.map_err(|error| bad(file, &names, error))?);
    }
    if rows.is_empty() {
        return Err(ExportError::File { file: file.into(), what: "has no rows".into() });
    }
    let lines: Vec<u64> = rows.iter().map(|row| row.position().map_or(0, csv::Position::line)).collect();
    let is_marked = cells::marked(&names, &rows);
    let column = |(at, name): (usize, &String)| match cells::values(name, &rows, at, &is_marked) {
        Ok(values) => Ok(TableColumn { name: name.clone(), unit: unit_of(name), values }),
        Err(wrong) => {
            let (file, line, what) = (file.into(), lines[wrong.row], wrong.what);
            Err(ExportError::At { file, line, column: Some(name.clone()), what })
        }
    };
    let columns = names.iter().enumerate().map(column).collect::<Result<_, _>>()?;
    Ok(Table { file: file.into(), columns, lines })
}

fn names(file: &str, header: &StringRecord) -> Result<Vec<String>, ExportError> {
    // Spreadsheets put a byte order mark in front.
    let names: Vec<String> = header.iter().map(|name| name.trim_start_matches('\u{feff}').to_string()).collect();
    let at = |column: Option<&String>, what: String| {
        Err(ExportError::At { file: file.into(), line: 1, column: column.cloned(), what })
    };
    if names.is_empty() {
        return at(None, "has no columns".into());
    }
    for (index, name) in names.iter().enumerate() {
        if name.is_empty() {
            return at(None, format!("column {} has no name", index + 1));
        }
        if names[..index].contains(name) {
            return at(Some(name), "is there twice: rename or remove one of the two columns".into());
        }
    }
    Ok(names)
}

fn bad(file: &str, names: &[String], error: csv::Error) -> ExportError {
    let line = error.position().map_or(1, csv::Position::line);
    let at = |column: Option<String>, what: String| ExportError::At { file: file.into(), line, column, what };
    match error.into_kind() {
        ErrorKind::Io(source) => ExportError::Io { file: file.into(), source },
        ErrorKind::UnequalLengths { expected_len, len, .. } => {
            at(None, format!("has {len} fields where the header has {expected_len}"))
        }
        ErrorKind::Utf8 { err, .. } => at(names.get(err.field()).cloned(), "is not UTF-8".into()),
        other => at(None, quoted(&format!("{other:?}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Values;

    fn refused(csv: &[u8]) -> String {
        read_from("rec.csv", csv).unwrap_err().to_string()
    }

    #[test]
    fn columns_are_typed() {
        let csv = "\u{feff}time_s, line,scalar_valid,adaptation,count,note\n0.1,7,1,learning,3,\n0.2,,0,resting,,x\n";
        let table = read_from("rec.csv", csv.as_bytes()).unwrap();
        let Values::Number(time_s) = &table.columns[0].values else { panic!("{table:?}") };
        assert_eq!((time_s.as_slice(), table.columns[0].unit), (&[0.1, 0.2][..], "s"));
        let text = |text: &str| Some(text.to_string());
        assert_eq!(table.columns[1].values, Values::Label(vec![text("7"), None]));
        assert_eq!(table.columns[2].values, Values::Flag(vec![Some(true), Some(false)]));
        assert_eq!(table.columns[3].values, Values::Label(vec![text("learning"), text("resting")]));
        assert!(matches!(&table.columns[4].values, Values::Number(count) if count[0] == 3.0 && count[1].is_nan()));
        assert_eq!(table.columns[5].values, Values::Label(vec![None, text("x")]));
        assert_eq!(table.lines, [2, 3]);
    }

    #[test]
    fn bad_input_is_placed() {
        let cases: [(&[u8], &str); 9] = [
            (b"time_s,scalar_nT\n0.1,5o123.4\n", "rec.csv:2: scalar_nT: \"5o123.4\" is not a number"),
            (b"time_s,scalar_nT\n0.1,1\n0.2,inf\n", "rec.csv:3: scalar_nT: \"inf\" is not a finite number"),
            (b"time_s,scalar_valid\n0.1,2\n", "rec.csv:2: scalar_valid: \"2\" is neither 0 nor 1"),
            (b"time_s,scalar_nT\n0.1\n", "rec.csv:2: has 1 fields where the header has 2"),
            (b"time_s,note\n0.1,\xff\n", "rec.csv:2: note: is not UTF-8"),
            (b"time_s,a,a\n", "rec.csv:1: a: is there twice: rename or remove one of the two columns"),
            (b"time_s,,a\n", "rec.csv:1: column 2 has no name"),
            (b"time_s,a\n", "rec.csv: has no rows"),
            (b"", "rec.csv:1: has no columns"),
        ];
        for (csv, message) in cases {
            assert_eq!(refused(csv), message);
        }
    }

    #[test]
    fn a_row_that_is_marked_may_hold_anything() {
        let csv = b"time_s,scalar_nT,scalar_valid\n0.1,xx,0\n0.2,5,1\n";
        let table = read_from("rec.csv", csv.as_slice()).unwrap();
        assert!(matches!(&table.columns[1].values, Values::Number(nt) if nt[0].is_nan() && nt[1] == 5.0));
    }
}

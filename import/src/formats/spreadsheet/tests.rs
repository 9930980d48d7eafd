//! Against workbooks that openpyxl, odfpy and xlwt wrote.

use super::*;
use crate::source::Values;

macro_rules! corpus {
    ($name:literal) => {
        include_bytes!(concat!("../../../tests/corpus/", $name)).as_slice()
    };
}

fn read(bytes: &[u8], part: Option<&str>) -> Result<Source, ImportError> {
    assert!(Spreadsheet.recognises(&bytes[..bytes.len().min(65_536)]));
    Spreadsheet.read(&Input { file: "f", bytes, companions: &[], part })
}

fn numbers<'a>(table: &'a SourceTable, name: &str) -> &'a [f64] {
    let column = table.columns.iter().find(|column| column.name == name);
    column.and_then(|column| column.as_numbers()).unwrap_or_else(|| panic!("no column {name}"))
}

/// A column of the truth.
fn truth(name: &str, rows: usize) -> Vec<f64> {
    let mut lines = csv::Reader::from_reader(corpus!("truth.csv"));
    let index = lines.headers().unwrap().iter().position(|header| header == name).unwrap();
    lines.records().take(rows).map(|line| line.unwrap()[index].parse().unwrap()).collect()
}

#[test]
fn of_two_sheets_the_one_with_values_is_taken() {
    let source = read(corpus!("two_sheets.xlsx"), None).unwrap();
    assert_eq!((source.format, source.tables.len()), ("xlsx", 1));
    let table = &source.tables[0];
    assert_eq!(table.notes[0].text, "of the sheets \"About\", \"Tow\" took \"Tow\"");
    for (ours, theirs) in [("time", "time_s"), ("scalar", "scalar_nT"), ("flux_z", "flux_z_nT")] {
        assert_eq!(numbers(table, ours), truth(theirs, 150));
    }
    assert_eq!(read(corpus!("two_sheets.xlsx"), Some("Tow")).unwrap().tables[0].columns, table.columns);
    let refusal = read(corpus!("two_sheets.xlsx"), Some("Toe")).unwrap_err().to_string();
    assert_eq!(refusal, "f: has no sheet \"Toe\"; it has \"About\", \"Tow\"");
    assert!(read(corpus!("two_sheets.xlsx"), Some("About")).is_err());
}

#[test]
fn dates_are_seconds_and_units_stand_below_the_names() {
    let table = read(corpus!("units_row.xlsx"), None).unwrap().tables.remove(0);
    let unit = |index: usize| table.columns[index].unit.as_deref().unwrap_or_default();
    assert_eq!([0, 1, 4, 5].map(unit), ["UTC", "nT", "nT", "m"]);
    let Values::Times(times) = &table.columns[0].values else { panic!("no times") };
    for (time, expected) in times.iter().zip(truth("utc_s", 150)) {
        assert!((time - expected).abs() < 1e-6, "{time} is not {expected}");
    }
    let scalar = numbers(&table, "Scalar");
    assert!(scalar[7].is_nan());
    assert_eq!(scalar[8..], truth("scalar_nT", 150)[8..]);
    assert_eq!((table.places[0], table.rows), (5, 150));
}

#[test]
fn ods_and_xls_give_the_same_as_xlsx() {
    let ods = read(corpus!("tow.ods"), None).unwrap();
    let xls = read(corpus!("tow.xls"), None).unwrap();
    assert_eq!([ods.format, xls.format], ["ods", "xls"]);
    assert_eq!(numbers(&ods.tables[0], "time"), truth("time_s", 150));
    for name in ["scalar", "flux_x", "flux_y", "flux_z"] {
        assert_eq!(numbers(&ods.tables[0], name), truth(&format!("{name}_nT"), 150));
        assert_eq!(numbers(&xls.tables[0], name), truth(&format!("{name}_nT"), 100));
    }
    let Values::Times(times) = &xls.tables[0].columns[0].values else { panic!("no times") };
    for (time, expected) in times.iter().zip(truth("time_s", 100)) {
        assert!((time - 36_000.0 - expected).abs() < 1e-6, "{time}");
    }
}

#[test]
fn a_cut_workbook_and_a_bomb_are_refused() {
    let refusal = |bytes| read(bytes, None).unwrap_err().to_string();
    assert!(refusal(corpus!("cut.xlsx")).contains("cut or damaged"));
    assert!(refusal(corpus!("damaged_tow.ods")).contains("damaged"));
    assert!(refusal(corpus!("damaged_tow.xls")).contains("damaged"));
    assert!(refusal(corpus!("bomb.xlsx")).contains("larger than the 16000000 bytes"));
}

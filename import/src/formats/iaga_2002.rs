//! IAGA-2002: an observatory's or variometer's field at regular times.
//! <https://www.ngdc.noaa.gov/IAGA/vdat/IAGA2002/iaga2002format.html>

use super::civil;
use super::format::{Input, SourceFormat};
use super::iaga_header::{Header, header, is_first};
use crate::error::ImportError;
use crate::source::{Clock, FindingKind, Note, Source, SourceColumn, SourceTable, Values};
use crate::text::{Column, Line, Missing, Rows, decoded, is_cut, lines};

/// IAGA-2002.
#[derive(Debug)]
pub(super) struct Iaga2002;

impl SourceFormat for Iaga2002 {
    fn name(&self) -> &'static str {
        "IAGA-2002"
    }

    fn recognises(&self, first: &[u8]) -> bool {
        lines(&decoded(first)).next().is_some_and(|line| is_first(line.text))
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let text = decoded(input.bytes);
        let mut lines = lines(&text);
        let no_columns =
            || ImportError::file(input.file, "the header of IAGA-2002 lacks its line `DATE TIME DOY`: cut off?");
        let header = header(&mut lines).ok_or_else(no_columns)?;
        let table = table(header, lines);
        if table.rows == 0 {
            return Err(ImportError::file(input.file, "a header of IAGA-2002 without rows: was it downloaded whole?"));
        }
        Ok(Source { file: input.file.into(), format: self.name(), tables: vec![table] })
    }
}

fn table<'a>(mut header: Header, lines: impl Iterator<Item = Line<'a>>) -> SourceTable {
    let width = header.components.len() + 3;
    let mut rows = Rows::new(header.components.iter().map(|name| column(name)).collect());
    let mut times = Vec::new();
    let mut last_before = "";
    for line in lines.filter(|line| !line.text.trim().is_empty()) {
        let mut fields = line.text.split_ascii_whitespace();
        let time = time(fields.next(), fields.next());
        let (count, last) = line.text.split_ascii_whitespace().fold((0, ""), |(count, _), field| (count + 1, field));
        match time.filter(|_| count == width && !is_cut(line.is_ended, count, width, last, last_before)) {
            Some(time) => {
                times.push(time);
                rows.push(line.number, fields.skip(1));
                last_before = last;
            }
            None => rows.leave_out(line),
        }
    }
    times.shrink_to_fit();
    let mut table = rows.finish("a time and a value of each component");
    table.facts.date = times.first().and_then(|time| civil::day_of(*time));
    table.facts.clock = Clock::Utc;
    table.facts.position_deg = header.position_deg;
    table.facts.instrument = header.station;
    table.notes.append(&mut header.notes);
    table.notes.extend(empty(&table));
    let time = SourceColumn { name: "time".into(), unit: Some("s".into()), values: Values::Times(times), dummy: None };
    table.columns.insert(0, time);
    table
}

/// Declination and inclination are in minutes of arc, all else in nanotesla. `NUL` fills a place.
fn column(name: &str) -> Column {
    let unit = match name {
        "D" | "I" => Some("arcmin"),
        "NUL" => None,
        _ => Some("nT"),
    };
    Column::new(name, unit, Missing::Where(is_dummy, 99_999.0), false)
}

/// 99999.00 where a value is missing, 88888.00 where a component is not observed; more nines or decimals with them.
fn is_dummy(value: f64) -> bool {
    value >= 99_999.0 || (88_888.0..88_889.0).contains(&value)
}

fn time(date: Option<&str>, clock: Option<&str>) -> Option<f64> {
    Some(civil::midnight_s(civil::date(date?)?)? + civil::clock(clock?)?)
}

/// The components that have no value at all.
fn empty(table: &SourceTable) -> Option<Note> {
    let is_empty = |column: &&SourceColumn| column.as_numbers().is_some_and(|values| values.iter().all(|v| v.is_nan()));
    let names: Vec<_> = table.columns.iter().filter(is_empty).map(|column| &column.name[..]).collect();
    let text = format!("{} without a value: 99999.00 throughout", names.join(", "));
    (!names.is_empty() && table.rows > 0).then_some(Note { kind: FindingKind::Missing, text })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "\
\x20Format                 IAGA-2002                                    |
 Station Name           Boulder                                      |
 IAGA CODE              BOU                                          |
 Geodetic Latitude      40.137                                       |
 Geodetic Longitude     -105.2                                       |
DATE       TIME         DOY     BOUH      BOUD      BOUZ      BOUF   |
2014-11-01 00:00:00.000 305     20873.75     -9.99  47477.30  99999.00
2014-11-01 00:01:00.000 305     88888.00    -10.00  999999.0  99999.00
2014-11-01 00:02:60.500 305     20873.94     xx     47477.21  99999.00
2014-11-31 00:03:00.000 305     20874.00    -10.02  47477.18  99999.00
2014-11-01 00:04:00.000 305     20874.00    -10.02  47477.18
2014-11-01 00:05:00.000 305     20874.00    -10.02  47477.18  52397.3";

    fn read(text: &str) -> Result<Source, ImportError> {
        Iaga2002.read(&Input { file: "bou.min", bytes: text.as_bytes(), companions: &[], part: None })
    }

    #[test]
    fn rows_have_times_and_components() {
        let table = read(FILE).unwrap().tables.remove(0);
        let columns: Vec<_> = table.columns.iter().map(|c| (&c.name[..], c.unit.as_deref().unwrap_or(""))).collect();
        assert_eq!(columns, [("time", "s"), ("H", "nT"), ("D", "arcmin"), ("Z", "nT"), ("F", "nT")]);
        // date -u -d '2014-11-01' +%s
        let start = 1_414_800_000.0;
        assert_eq!(table.columns[0].values, Values::Times(vec![start, start + 60.0, start + 180.5]));
        let numbers = |column: usize| format!("{:?}", table.columns[column].as_numbers().unwrap());
        assert_eq!(numbers(1), "[20873.75, NaN, 20873.94]");
        assert_eq!(numbers(2), "[-9.99, -10.0, NaN]");
        assert_eq!(numbers(3), "[47477.3, NaN, 47477.21]");
        assert_eq!(numbers(4), "[NaN, NaN, NaN]");
        assert_eq!(table.columns[1].dummy, Some(99_999.0));
        assert_eq!(table.places, [7, 8, 9]);
    }

    #[test]
    fn what_was_put_right_is_told() {
        let table = read(FILE).unwrap().tables.remove(0);
        let notes: Vec<_> = table.notes.iter().map(|note| (note.kind, &note.text[..])).collect();
        let wanted = [
            (FindingKind::Dummies, "1 cell is no number and counts as missing: \"xx\" in line 9"),
            (
                FindingKind::Missing,
                "2 lines without a time and a value of each component are left out: first in line 10",
            ),
            (FindingKind::Truncated, "the file ends within line 12, which is left out"),
            (FindingKind::Missing, "F without a value: 99999.00 throughout"),
        ];
        assert_eq!(notes, wanted);
        assert_eq!(table.facts.position_deg, Some((40.137, -105.2)));
        assert_eq!((table.facts.clock, table.facts.date), (Clock::Utc, Some((2014, 11, 1))));
        assert_eq!(table.facts.instrument.as_deref(), Some("Boulder"));
    }

    #[test]
    fn it_is_known_by_its_first_line() {
        assert!(Iaga2002.recognises(FILE.as_bytes()));
        assert!(!Iaga2002.recognises(b"Format,IAGA-2002\n"));
        assert!(!Iaga2002.recognises(b""));
    }

    #[test]
    fn without_columns_or_rows_it_is_refused() {
        let start = FILE.split_inclusive('\n').collect::<Vec<_>>();
        assert!(read(&start[..5].concat()).unwrap_err().to_string().contains("DATE TIME DOY"));
        assert!(read(&start[..6].concat()).unwrap_err().to_string().contains("without rows"));
    }
}

//! Positions that RTKLIB computed: a header of `%` lines, the last of which names the columns.
//! RTKLIB 2.4.2 manual, appendix B.1 <https://www.rtklib.com/prog/manual_2.4.2.pdf>

use super::civil;
use super::format::{Input, SourceFormat};
use super::rtklib_header::{DEGREES_IN_THREE, Header, header};
use crate::error::ImportError;
use crate::source::{Clock, Source, SourceColumn, SourceTable, Values};
use crate::text::{Column, LARGEST_COLUMNS, Line, Missing, Rows, decoded, is_cut, lines, loose_fields};

/// RTKLIB's positions.
#[derive(Debug)]
pub(super) struct RtklibPos;

impl SourceFormat for RtklibPos {
    fn name(&self) -> &'static str {
        "RTKLIB positions"
    }

    fn recognises(&self, first: &[u8]) -> bool {
        first.starts_with(b"%") && lines(&decoded(first)).any(|line| header(line.text).is_some())
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let text = decoded(input.bytes);
        let no_columns = || {
            ImportError::file(
                input.file,
                "no line `%  GPST ...` or `%  UTC ...` names the columns: write it with headers",
            )
        };
        let header = lines(&text).find_map(|line| header(line.text)).ok_or_else(no_columns)?;
        if header.columns.len() > LARGEST_COLUMNS {
            return Err(ImportError::file(input.file, format!("more than {LARGEST_COLUMNS} columns")));
        }
        let table = table(&header, lines(&text));
        if table.rows == 0 {
            return Err(ImportError::file(input.file, "RTKLIB found no position: a header without rows"));
        }
        Ok(Source { file: input.file.into(), format: self.name(), tables: vec![table] })
    }
}

fn table<'a>(header: &Header, lines: impl Iterator<Item = Line<'a>>) -> SourceTable {
    let mut rows = Rows::new(header.columns.iter().map(|(name, unit)| column(name, unit.as_deref())).collect());
    let mut times = Vec::new();
    let mut last_before = "";
    for line in lines.filter(|line| !line.text.starts_with('%') && !line.text.trim().is_empty()) {
        let fields: Vec<&str> = loose_fields(line.text).collect();
        let last = fields.last().copied().unwrap_or("");
        let is_whole =
            fields.len() == header.width() && !is_cut(line.is_ended, fields.len(), header.width(), last, last_before);
        let time = match fields[..] {
            [first, second, ..] if is_whole => header.system.utc_s(first, second),
            _ => None,
        };
        if let Some(time) = time {
            times.push(time);
            rows.push(line.number, header.cells(&fields).iter().map(|cell| &**cell));
            last_before = last;
        } else {
            rows.leave_out(line);
        }
    }
    finished(header, rows, times)
}

fn finished(header: &Header, rows: Rows, mut times: Vec<f64>) -> SourceTable {
    times.shrink_to_fit();
    let mut table = rows.finish("a time and the fields of the header");
    table.facts.clock = Clock::Utc;
    table.facts.date = times.first().and_then(|time| civil::day_of(*time));
    table.notes.extend(times.first().and_then(|time| header.note(*time)));
    let time = SourceColumn { name: "time".into(), unit: Some("s".into()), values: Values::Times(times), dummy: None };
    table.columns.insert(0, time);
    table
}

fn column(name: &str, unit: Option<&str>) -> Column {
    let unit = if unit == Some(DEGREES_IN_THREE) { Some("deg") } else { unit };
    Column::new(name, unit, Missing::Nothing, false)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GPS: &str = "\
% program   : RTKPOST ver.2.4.2
% obs start : 2023/06/24 20:22:50.4 GPST (week2267 591770.4s)
%
%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns
2023/06/24 20:22:50.402   61.078688979 -139.139222332  1889.6183   2  10
2023/06/24 20:22:50.602   61.078683010 -139.139216019  1888.4367   x  10
2023/06/24 20:22:50.802   61.078683010 -139.139216019  1888.4367   2
2023/06/24 20:22:51.002   61.078683010 -139.139216019  18";

    fn read(text: &str) -> SourceTable {
        assert!(RtklibPos.recognises(text.as_bytes()));
        let input = Input { file: "a.pos", bytes: text.as_bytes(), companions: &[], part: None };
        RtklibPos.read(&input).unwrap().tables.remove(0)
    }

    fn times(table: &SourceTable) -> &[f64] {
        let Values::Times(times) = &table.columns[0].values else { panic!("{:?}", table.columns[0]) };
        times
    }

    #[test]
    fn gps_time_becomes_utc_and_that_is_told() {
        let table = read(GPS);
        assert!((times(&table)[0] - 1_687_638_152.402).abs() < 1e-6);
        let notes: Vec<_> = table.notes.iter().map(|note| &note.text[..]).collect();
        let wanted = [
            "1 cell is no number and counts as missing: \"x\" in line 6",
            "1 line without a time and the fields of the header is left out: in line 7",
            "the file ends within line 8, which is left out",
            "times are GPS time, 18 s ahead of UTC: given in UTC",
        ];
        assert_eq!(notes, wanted);
        assert_eq!((table.facts.clock, table.facts.date), (Clock::Utc, Some((2023, 6, 24))));
    }

    #[test]
    fn columns_are_those_of_the_header() {
        let table = read(GPS);
        let columns: Vec<_> = table.columns.iter().map(|c| (&c.name[..], c.unit.as_deref().unwrap_or(""))).collect();
        let wanted = [("time", "s"), ("latitude", "deg"), ("longitude", "deg"), ("height", "m"), ("Q", ""), ("ns", "")];
        assert_eq!(columns, wanted);
        assert_eq!(table.columns[1].as_numbers().unwrap(), [61.078_688_979, 61.078_683_010]);
        assert_eq!(format!("{:?}", table.columns[4].as_numbers().unwrap()), "[2.0, NaN]");
    }

    #[test]
    fn angles_may_have_three_fields_and_times_weeks() {
        let text =
            "%  GPST , latitude(d'\"), longitude(d'\"), height(m), Q\n2267,591770.402,61,04,43.5,-139,08,00.0,12.5,1\n";
        let table = read(text);
        let [lat, lon] = [1, 2].map(|column: usize| table.columns[column].as_numbers().unwrap()[0]);
        assert!((lat - (61.0 + 4.0 / 60.0 + 43.5 / 3600.0)).abs() < 1e-12 && (lon + 139.0 + 8.0 / 60.0).abs() < 1e-12);
        assert_eq!(table.columns[1].unit.as_deref(), Some("deg"));
        assert!((times(&table)[0] - 1_687_638_152.402).abs() < 1e-6);
    }

    #[test]
    fn utc_stays_utc() {
        let table = read("%  UTC latitude(deg) longitude(deg)\n2023/06/24 20:22:32 61 -139\n");
        assert_eq!((times(&table)[0], table.notes.len()), (1_687_638_152.0, 0));
    }

    #[test]
    fn it_is_known_by_its_columns() {
        for text in [
            "",
            "% matlab\nx = 1;\n",
            "%  GPST  a b\n",
            "GPST latitude(deg)\n",
            "% obs start : 2023 GPST latitude(deg)\n",
        ] {
            assert!(!RtklibPos.recognises(text.as_bytes()), "{text:?}");
        }
        let input = Input { file: "a.pos", bytes: b"%  UTC latitude(deg)\n", companions: &[], part: None };
        assert!(RtklibPos.read(&input).unwrap_err().to_string().contains("no position"));
    }
}

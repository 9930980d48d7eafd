//! MGD77T: tracks of ships and aircraft in archives, with tabs between the fields.
//! <https://www.ngdc.noaa.gov/mgg/dat/geodas/docs/mgd77.pdf>

use super::civil;
use super::format::{Input, SourceFormat};
use crate::error::ImportError;
use crate::source::{Clock, Source, SourceColumn, SourceTable, Values};
use crate::text::{Column, Decimal, LARGEST_COLUMNS, Line, Missing, Rows, are_text, decoded, lines, number};

/// MGD77T.
#[derive(Debug)]
pub(super) struct Mgd77t;

/// The fields that the time is made of.
const OF_TIME: [&str; 3] = ["TIMEZONE", "DATE", "TIME"];

/// Units of the fields, and whether a field is a name whatever it looks like.
const UNITS: [(&str, &str); 12] = [
    ("LAT", "deg"),
    ("LON", "deg"),
    ("BAT_TTIME", "s"),
    ("CORR_DEPTH", "m"),
    ("MAG_TOT", "nT"),
    ("MAG_TOT2", "nT"),
    ("MAG_RES", "nT"),
    ("MAG_DICORR", "nT"),
    ("MAG_SDEPTH", "m"),
    ("GRA_OBS", "mGal"),
    ("EOTVOS", "mGal"),
    ("FREEAIR", "mGal"),
];

const NAMES: [&str; 3] = ["SURVEY_ID", "LINEID", "POINTID"];

impl SourceFormat for Mgd77t {
    fn name(&self) -> &'static str {
        "MGD77T"
    }

    fn recognises(&self, first: &[u8]) -> bool {
        let text = decoded(first);
        let Some(header) = lines(&text).next() else { return false };
        let has = |name: &str| header.text.split('\t').any(|field| field.trim() == name);
        ["SURVEY_ID", "DATE", "TIME", "LAT", "LON"].into_iter().all(has)
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let text = decoded(input.bytes);
        let mut lines = lines(&text).filter(|line| !line.text.trim().is_empty());
        let names: Vec<&str> =
            lines.next().map(|line| line.text.split('\t').map(str::trim).collect()).unwrap_or_default();
        if names.len() > LARGEST_COLUMNS {
            let what = format!("a header of {} fields: {LARGEST_COLUMNS} are the most", names.len());
            return Err(ImportError::at(input.file, 1, what));
        }
        let table = table(&names, lines);
        if table.rows == 0 {
            return Err(ImportError::file(input.file, "a header of MGD77T without rows: was it downloaded whole?"));
        }
        Ok(Source { file: input.file.into(), format: self.name(), tables: vec![table] })
    }
}

fn table<'a>(names: &[&str], lines: impl Iterator<Item = Line<'a>> + Clone) -> SourceTable {
    let carried: Vec<usize> = (0..names.len()).filter(|index| !names.get(*index).is_some_and(is_of_time)).collect();
    let are_text = are_text(lines.clone().map(|line| line.text.split('\t')), names.len(), Decimal::Point);
    let is_text = |name: &str, index: usize| NAMES.contains(&name) || are_text.get(index).copied().unwrap_or(false);
    let named = carried.iter().filter_map(|index| names.get(*index).map(|name| (*index, *name)));
    let mut rows = Rows::new(named.map(|(index, name)| column(name, is_text(name, index))).collect());
    let of_time = OF_TIME.map(|wanted| names.iter().position(|name| *name == wanted));
    let mut times = Vec::new();
    for line in lines {
        let fields: Vec<&str> = line.text.split('\t').collect();
        if is_whole(line, fields.len(), names.len()) {
            let field = |index: Option<usize>| fields.get(index?).copied();
            times.push(time(of_time.map(field)).unwrap_or(f64::NAN));
            rows.push(line.number, carried.iter().map(|index| fields.get(*index).copied().unwrap_or("")));
        } else {
            rows.leave_out(line);
        }
    }
    finished(rows, times)
}

fn finished(rows: Rows, mut times: Vec<f64>) -> SourceTable {
    times.shrink_to_fit();
    let mut table = rows.finish("the fields that the header names");
    table.facts.date = times.iter().find(|time| time.is_finite()).and_then(|time| civil::day_of(*time));
    table.facts.clock = Clock::Utc;
    let time = SourceColumn { name: "time".into(), unit: Some("s".into()), values: Values::Times(times), dummy: None };
    table.columns.insert(0, time);
    table
}

fn is_of_time(name: &&str) -> bool {
    OF_TIME.contains(name)
}

/// Empty fields at the end of a line may be left away, but not half of them; and nothing on a line that was cut.
fn is_whole(line: Line<'_>, fields: usize, wanted: usize) -> bool {
    fields <= wanted && fields >= if line.is_ended { wanted.div_ceil(2) } else { wanted }
}

fn column(name: &str, is_text: bool) -> Column {
    let unit = UNITS.iter().find(|(field, _)| *field == name).map(|(_, unit)| *unit);
    Column::new(name, unit, Missing::Nothing, is_text)
}

/// UTC from the hours that bring the record's time there, YYYYMMDD, and hours and minutes as 2359.6667.
fn time([zone, date, clock]: [Option<&str>; 3]) -> Option<f64> {
    let midnight_s = civil::midnight_s(civil::date(date?)?)?;
    let hours_and_minutes = civil::unsigned(clock?.trim())?;
    let hour = (hours_and_minutes / 100.0).floor();
    let clock_s = civil::second_of_day(hour, hours_and_minutes - 100.0 * hour, 0.0)?;
    let zone_h = zone.and_then(number).filter(|hours| hours.abs() <= 14.0).unwrap_or(0.0);
    // The minutes have a few decimals: what rounding leaves below a millisecond is none of the ship's.
    Some(midnight_s + (clock_s * 1000.0).round() / 1000.0 + zone_h * 3600.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::FindingKind;

    const HEADER: &str = "SURVEY_ID\tTIMEZONE\tDATE\tTIME\tLAT\tLON\tPOS_TYPE\tMAG_TOT\tMAG_SDEPTH\tLINEID\n";

    fn read(rows: &str) -> SourceTable {
        let text = format!("{HEADER}{rows}");
        assert!(Mgd77t.recognises(text.as_bytes()));
        let input = Input { file: "ew.m77t", bytes: text.as_bytes(), companions: &[], part: None };
        Mgd77t.read(&input).unwrap().tables.remove(0)
    }

    #[test]
    fn date_hours_and_minutes_make_the_time() {
        let rows = "EW1\t-2\t20200928\t1337.5\t10.5\t-20.25\t1\t45012.3\t12\t7\n\
            EW1\t0\t20200928\t0005.005\t\t\t1\t\t\t\nEW1\t0\t\t1337\t1\t2\t1\t45000\t12\t7\nEW1\t0\t20200928\t1360\t1\t2\n";
        let table = read(rows);
        let Values::Times(times) = &table.columns[0].values else { panic!("{:?}", table.columns[0]) };
        let day = 1_601_251_200.0;
        assert_eq!(times[..2], [day + (11.0 * 60.0 + 37.5) * 60.0, day + 300.3]);
        assert!(times[2].is_nan() && times[3].is_nan());
        assert_eq!((table.facts.date, table.facts.clock), (Some((2020, 9, 28)), Clock::Utc));
    }

    #[test]
    fn fields_have_the_units_of_the_format() {
        let table =
            read("7\t0\t20200928\t1337\t10.5\t-20.25\t1\t45012.3\t12\t5\n7\t0\t20200928\t1338\t1x\t2\t\t\t\t\n");
        let columns: Vec<_> = table.columns.iter().map(|c| (&c.name[..], c.unit.as_deref().unwrap_or(""))).collect();
        let wanted = [
            ("time", "s"),
            ("SURVEY_ID", ""),
            ("LAT", "deg"),
            ("LON", "deg"),
            ("POS_TYPE", ""),
            ("MAG_TOT", "nT"),
            ("MAG_SDEPTH", "m"),
            ("LINEID", ""),
        ];
        assert_eq!(columns, wanted);
        assert_eq!(format!("{:?}", table.columns[5].as_numbers().unwrap()), "[45012.3, NaN]");
        assert!(matches!(&table.columns[1].values, Values::Text(ids) if ids.iter().all(|id| &**id == "7")));
        assert_eq!(table.notes[0].text, "1 cell is no number and counts as missing: \"1x\" in line 3");
    }

    #[test]
    fn a_cut_last_line_is_left_out() {
        let row = "7\t0\t20200928\t1337\t10.5\t-20.25\t1\t45012.3\t12\t5\n";
        let table = read(&format!("{row}7\t0\n{row}7\t0\t20200928\t1338\t10.5\t-20.25\t1"));
        assert_eq!((table.rows, &table.places[..]), (2, &[2, 4][..]));
        assert_eq!([table.notes[0].kind, table.notes[1].kind], [FindingKind::Missing, FindingKind::Truncated]);
    }

    #[test]
    fn it_is_known_by_its_header() {
        assert!(!Mgd77t.recognises(HEADER.replace('\t', ",").as_bytes()));
        assert!(!Mgd77t.recognises(b"SURVEY_ID\tDATE\n"));
        let input = Input { file: "ew.m77t", bytes: HEADER.as_bytes(), companions: &[], part: None };
        assert!(Mgd77t.read(&input).unwrap_err().to_string().starts_with("ew.m77t: a header of MGD77T without rows"));
    }
}

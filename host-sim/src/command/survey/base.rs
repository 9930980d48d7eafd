//! A base station's file: a table with a time and a total field, or IAGA-2002.

use std::path::Path;

use towmag_import::compressed::expand;
use towmag_import::formats::{FORMATS, Input};
use towmag_import::read_text;
use towmag_import::source::{SourceColumn, SourceTable, Values};
use towmag_recording::FIELD_RANGE_NT;
use towmag_survey::Tow;
use towmag_survey::navigation::{BaseStation, BaseTimes};

use super::warnings::left_out as readings_left_out;
use crate::error::HostError;
use crate::recording::RecordingError;

/// What a column of the total field is called, in the order in which they are taken; large or small letters.
const FIELD: [&str; 8] = ["base_nt", "scalar_nt", "f", "s", "field_nt", "total_field_nt", "total_field", "mag"];
/// Components that make a total field: northern and eastern, or horizontal, with the vertical one.
const COMPONENTS: [&[&str]; 2] = [&["x", "y", "z"], &["h", "z"]];

/// Put the base station's field into all recordings. Returns what the reader must know of it.
pub(super) fn join(path: &Path, tows: &mut [Tow]) -> Result<Option<String>, HostError> {
    let (station, left_out) = read(path)?.without_outliers();
    for tow in tows {
        tow.base_nt = Some(station.join(tow)?);
    }
    let name = path.file_name().unwrap_or(path.as_os_str()).display();
    Ok((left_out > 0).then(|| readings_left_out(&name.to_string(), left_out)))
}

fn read(path: &Path) -> Result<BaseStation, HostError> {
    let file = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|source| RecordingError::Io { path: file.clone(), source })?;
    let (bytes, _) = expand(&file, bytes)?;
    let source = match FORMATS.iter().find(|format| format.recognises(&bytes)) {
        Some(format) => format.read(&Input { file: &file, bytes: &bytes, companions: &[], part: None })?,
        None => read_text(&file, &bytes)?,
    };
    let table = source.tables.into_iter().max_by_key(|table| table.rows).unwrap_or_default();
    let refused = |what: &str| HostError::Usage(format!("{file}: {what}"));
    let times = times(&table).ok_or_else(|| {
        refused("a base station needs its times in utc_s (seconds since 1970) or in time_s, or IAGA-2002")
    })?;
    let mut field_nt =
        field_nt(&table).ok_or_else(|| refused("a base station needs its total field, nT, in base_nT or scalar_nT"))?;
    field_nt.iter_mut().filter(|field| !FIELD_RANGE_NT.contains(field)).for_each(|field| *field = f64::NAN);
    if field_nt.iter().all(|field| field.is_nan()) {
        return Err(refused("no total field of the base station is within 1000 to 100000 nT: is it in nT?"));
    }
    Ok(sorted(times, field_nt))
}

fn named<'a>(table: &'a SourceTable, name: &str) -> Option<&'a SourceColumn> {
    table.columns.iter().find(|column| column.name.eq_ignore_ascii_case(name))
}

/// Points in time are UTC; a column of numbers says what it is by its name.
fn times(table: &SourceTable) -> Option<BaseTimes> {
    let points = table.columns.iter().find_map(|column| match &column.values {
        Values::Times(times) => Some(times.clone()),
        Values::Numbers(_) | Values::Text(_) => None,
    });
    let numbers = |name| named(table, name).and_then(SourceColumn::as_numbers).map(<[f64]>::to_vec);
    points.or_else(|| numbers("utc_s")).map(BaseTimes::Utc).or_else(|| numbers("time_s").map(BaseTimes::Recording))
}

fn field_nt(table: &SourceTable) -> Option<Vec<f64>> {
    let numbers = |name: &&str| {
        let values = named(table, name)?.as_numbers()?;
        values.iter().any(|value| value.is_finite()).then_some(values)
    };
    let total = FIELD.iter().find_map(numbers).map(<[f64]>::to_vec);
    total.or_else(|| {
        let components = COMPONENTS.iter().find_map(|names| names.iter().map(numbers).collect::<Option<Vec<_>>>())?;
        let square = |row: usize| components.iter().map(|component| component[row] * component[row]).sum::<f64>();
        Some((0..table.rows).map(|row| square(row).sqrt()).collect())
    })
}

/// In the order of time: files of several days may be in any.
fn sorted(times: BaseTimes, field_nt: Vec<f64>) -> BaseStation {
    let of = |times: Vec<f64>| -> (Vec<f64>, Vec<f64>) {
        let mut rows: Vec<(f64, f64)> =
            times.into_iter().zip(field_nt).filter(|(time_s, _)| time_s.is_finite()).collect();
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        rows.into_iter().unzip()
    };
    match times {
        BaseTimes::Utc(times) => {
            let (times, field_nt) = of(times);
            BaseStation { times: BaseTimes::Utc(times), field_nt }
        }
        BaseTimes::Recording(times) => {
            let (times, field_nt) = of(times);
            BaseStation { times: BaseTimes::Recording(times), field_nt }
        }
    }
}

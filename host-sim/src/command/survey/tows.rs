//! Recordings as a survey takes them.

use towmag_recording::Column;
use towmag_survey::Tow;

use super::diagnosed::Diagnosed;
use crate::error::HostError;
use crate::recording::{BadRows, ColumnValues, Input, Table};

/// Recordings that have been read once, and can be read again.
#[derive(Default)]
pub(super) struct Read {
    pub(super) inputs: Vec<Input>,
    pub(super) tows: Vec<Tow>,
    /// Of each recording.
    pub(super) bad_rows: Vec<BadRows>,
    /// What a diagnosis named in each.
    pub(super) diagnosed: Vec<Diagnosed>,
    /// What the reader must know of files beside them, a sentence each.
    pub(super) notes: Vec<String>,
}

/// Read all recordings.
pub(super) fn read(recordings: Vec<Input>) -> Result<Read, HostError> {
    let mut read = Read::default();
    for recording in recordings {
        let input = recording.ready()?;
        let table = Table::read(&mut *input.open()?)?;
        read.tows.push(tow(&input, &table));
        read.bad_rows.push(table.bad_rows().clone());
        read.diagnosed.push(Diagnosed::default());
        read.inputs.push(input);
    }
    Ok(read)
}

fn tow(input: &Input, table: &Table) -> Tow {
    let numbers = |column: Column| table.numbers(column).map(<[f64]>::to_vec);
    let required = |column: Column| numbers(column).unwrap_or_else(|| vec![f64::NAN; table.len()]);
    let [x, y, z] = Column::FLUX.map(required);
    let line = table.column(Column::Line).and_then(|line| match &line.values {
        ColumnValues::Labels(labels) => Some(labels.clone()),
        ColumnValues::Numbers(_) | ColumnValues::Flags(_) => None,
    });
    Tow {
        name: input.file_name(),
        time_s: required(Column::Time),
        is_usable: table.usable().to_vec(),
        scalar_nt: required(Column::Scalar),
        scalar_variance_nt2: None,
        flux_nt: (0..table.len()).map(|row| [x[row], y[row], z[row]]).collect(),
        line,
        scalar2_nt: second_scalar(table),
        base_nt: numbers(Column::Base),
        depth_m: numbers(Column::Depth),
        altitude_m: numbers(Column::Altitude),
        heading_deg: numbers(Column::Heading),
        latitude_deg: numbers(Column::Latitude),
        longitude_deg: numbers(Column::Longitude),
        utc_s: numbers(Column::Utc),
        cable_out_m: numbers(Column::CableOut),
        speed_m_per_s: numbers(Column::Speed),
    }
}

/// Without the readings that the sensor itself calls invalid.
fn second_scalar(table: &Table) -> Option<Vec<f64>> {
    let mut readings = table.numbers(Column::Scalar2)?.to_vec();
    if let Some(ColumnValues::Flags(valid)) = table.column(Column::Scalar2Valid).map(|column| &column.values) {
        let invalid = valid.iter().enumerate().filter(|(_, is_valid)| **is_valid == Some(false));
        invalid.for_each(|(row, _)| readings[row] = f64::NAN);
    }
    Some(readings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::CsvReader;

    #[test]
    fn a_second_sensor_that_calls_itself_invalid_is_not_heard() {
        let text = "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT,scalar2_nT,scalar2_valid,line\n\
                    0.0,50000,20000,0,45000,50001,1,a\n0.1,50000,20000,0,45000,7,0,a\n0.2,50000,20000,0,45000,50003,,\n";
        let table = Table::read(&mut CsvReader::from_reader("rec.csv", text.as_bytes()).unwrap()).unwrap();
        let tow = tow(&Input::new("rec.csv", false), &table);
        let second = tow.scalar2_nt.unwrap();
        assert!(second[0] == 50_001.0 && second[1].is_nan() && second[2] == 50_003.0);
        assert_eq!(tow.line.unwrap().iter().map(|line| &**line).collect::<Vec<_>>(), ["a", "a", ""]);
        assert_eq!((tow.name.as_str(), tow.base_nt, tow.is_usable.len()), ("rec.csv", None, 3));
    }
}

//! The trial's own reader of a recording: sensors as numbers, all else as the text that it is.

use csv::{ReaderBuilder, StringRecord, WriterBuilder};

use crate::error::TrialError;
use crate::limits::LEAST_VALID_S;
use crate::world::Readings;

/// Seconds per row.
const EPOCH_S: f64 = 0.1;
/// What the total field can be on Earth, with room to spare, nT.
const RANGE_NT: std::ops::RangeInclusive<f64> = 1_000.0..=100_000.0;
/// Digits after the point that mean something: the shortest text of an `f64` has up to 17.
const MOST_DECIMALS: usize = 9;

/// The sensors' columns, in the order of [`Columns::all`].
const SENSORS: [&str; 4] = ["scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"];

/// A recording that was read.
#[derive(Clone, Debug)]
pub(super) struct RecordedCsv {
    header: StringRecord,
    records: Vec<StringRecord>,
    columns: Columns,
    /// Rows that may be used, in their order.
    usable: Vec<UsableRow>,
    /// Time of the first row that has one, s.
    pub(super) first_time_s: f64,
    /// Rows of the 10 Hz grid from the first row that has a time to the last.
    pub(super) grid_rows: usize,
    /// Decimals that scalar and fluxgate are written with.
    decimals: [usize; 2],
}

/// Where each column is, from 0.
#[derive(Clone, Copy, Debug)]
struct Columns {
    time_s: usize,
    sensors: [usize; 4],
    valid: Option<usize>,
}

/// A row whose readings may be used.
#[derive(Clone, Copy, Debug)]
pub(super) struct UsableRow {
    /// Which record it is.
    record: usize,
    /// Its row on the 10 Hz grid.
    pub(super) place: usize,
    /// Scalar and fluxgate, nT.
    pub(super) readings_nt: [f64; 4],
}

impl RecordedCsv {
    /// Read the text of a CSV file. Rows that lack a reading, are flagged, or hold what no sensor says are carried along.
    pub(super) fn read(name: &str, text: &str) -> Result<Self, TrialError> {
        let mut reader = ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
        let bad = |source| TrialError::Csv { name: name.into(), source };
        let header = reader.headers().map_err(bad)?.clone();
        let columns = Columns::find(name, &header)?;
        let records = reader.records().collect::<Result<Vec<StringRecord>, csv::Error>>().map_err(bad)?;
        let mut read =
            Self { header, records, columns, usable: Vec::new(), first_time_s: 0.0, grid_rows: 0, decimals: [0; 2] };
        read.place();
        let valid_s = EPOCH_S * read.usable.len() as f64;
        if valid_s < LEAST_VALID_S {
            return Err(TrialError::TooShort { name: name.into(), valid_s });
        }
        Ok(read)
    }

    /// Rows that may be used, in their order.
    pub(super) fn usable(&self) -> &[UsableRow] {
        &self.usable
    }

    /// The same file with other readings, one for each row of the grid, in the rows that may be used: as many decimals
    /// as before, and every other field as it is.
    pub(super) fn with_readings(&self, readings: &Readings) -> String {
        let mut writer = WriterBuilder::new().flexible(true).from_writer(Vec::new());
        let mut usable = self.usable.iter().peekable();
        let written = "a vector takes every record";
        writer.write_record(&self.header).expect(written);
        for (number, record) in self.records.iter().enumerate() {
            match usable.next_if(|row| row.record == number) {
                Some(row) => writer.write_record(self.changed(record, readings, row.place)).expect(written),
                None => writer.write_record(record).expect(written),
            }
        }
        String::from_utf8(writer.into_inner().expect(written)).expect("text was put in")
    }

    fn changed(&self, record: &StringRecord, readings: &Readings, place: usize) -> Vec<String> {
        let mut fields: Vec<String> = record.iter().map(str::to_string).collect();
        let [scalar, flux] = self.decimals;
        let [at, components @ ..] = self.columns.sensors;
        fields[at] = format!("{:.scalar$}", readings.scalar_nt[place]);
        for (at, nt) in components.into_iter().zip(readings.flux_nt[place]) {
            fields[at] = format!("{nt:.flux$}");
        }
        fields
    }

    /// Find the rows that may be used, and where on the grid they are.
    fn place(&mut self) {
        let mut times_s: Option<[f64; 2]> = None;
        for (number, record) in self.records.iter().enumerate() {
            let Some(time_s) = value(record, self.columns.time_s) else { continue };
            if times_s.is_some_and(|[_, last_s]| time_s <= last_s) {
                continue;
            }
            let first_s = times_s.map_or(time_s, |[first_s, _]| first_s);
            times_s = Some([first_s, time_s]);
            let place = (10.0 * (time_s - first_s)).round() as usize;
            self.grid_rows = place + 1;
            let Some(readings_nt) = self.columns.readings_nt(record) else { continue };
            self.usable.push(UsableRow { record: number, place, readings_nt });
            let [scalar, flux @ ..] = self.columns.sensors.map(|at| decimals(record.get(at).unwrap_or_default()));
            self.decimals[0] = self.decimals[0].max(scalar);
            self.decimals[1] = flux.into_iter().fold(self.decimals[1], usize::max);
        }
        self.first_time_s = times_s.map_or(0.0, |[first_s, _]| first_s);
    }
}

impl Columns {
    fn find(name: &str, header: &StringRecord) -> Result<Self, TrialError> {
        let position = |wanted: &str| header.iter().position(|column| column.trim() == wanted);
        let required = |column| position(column).ok_or_else(|| TrialError::MissingColumn { name: name.into(), column });
        let [scalar, x, y, z] = SENSORS.map(required);
        Ok(Self { time_s: required("time_s")?, sensors: [scalar?, x?, y?, z?], valid: position("scalar_valid") })
    }

    /// Scalar and fluxgate of a row that may be used.
    fn readings_nt(&self, record: &StringRecord) -> Option<[f64; 4]> {
        let flag = self.valid.and_then(|at| record.get(at)).map_or("", str::trim);
        if !(flag.is_empty() || flag.parse() == Ok(1.0)) {
            return None;
        }
        let [scalar, x, y, z] = self.sensors.map(|at| value(record, at));
        let readings_nt @ [scalar_nt, x, y, z] = [scalar?, x?, y?, z?];
        let is_earthly = |nt: f64| RANGE_NT.contains(&nt);
        (is_earthly(scalar_nt) && is_earthly((x * x + y * y + z * z).sqrt())).then_some(readings_nt)
    }
}

/// A finite number.
fn value(record: &StringRecord, at: usize) -> Option<f64> {
    record.get(at)?.trim().parse().ok().filter(|value: &f64| value.is_finite())
}

/// Digits after the point.
fn decimals(field: &str) -> usize {
    if field.contains(['e', 'E']) {
        return MOST_DECIMALS;
    }
    field.trim().split_once('.').map_or(0, |(_, after)| after.len().min(MOST_DECIMALS))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 62 s at 10 Hz, with `other` in place of some rows.
    fn text(other: &[(usize, &str)]) -> String {
        let row = |k: usize| match other.iter().find(|(row, _)| *row == k) {
            Some((_, row)) => (*row).to_string(),
            None => format!("a,{:.1},1,50000.25,30000.5,-20000,34000.125", 100.0 + 0.1 * k as f64),
        };
        let rows: Vec<String> = (0..620).map(row).collect();
        format!("line, time_s ,scalar_valid,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT\n{}\n", rows.join("\n"))
    }

    fn same(read: &RecordedCsv) -> Readings {
        let mut readings = Readings { scalar_nt: vec![f64::NAN; 620], flux_nt: vec![[f64::NAN; 3]; 620] };
        for UsableRow { place, readings_nt: [scalar, x, y, z], .. } in read.usable() {
            (readings.scalar_nt[*place], readings.flux_nt[*place]) = (*scalar, [*x, *y, *z]);
        }
        readings
    }

    #[test]
    fn rows_that_cannot_be_used_are_carried_along_and_decimals_stay() {
        let other = [
            (1, "a,100.1,0,9.9,30000.5,-20000,34000.125"),
            (2, "\"b, c\",100.2,,,30000.5,-20000,34000.125"),
            (3, "a,,1,50000.25,30000.5,-20000,34000.125"),
            (4, "a,100.4,1,123,30000.5,-20000,34000.125"),
            (5, "a,100.5,1,nan,30000.5,-20000,34000.1234"),
            (6, "a,100.4,1,50000.25,30000.5,-20000,34000.125"),
        ];
        let text = text(&other);
        let read = RecordedCsv::read("rec.csv", &text).unwrap();
        let places: Vec<usize> = read.usable().iter().map(|row| row.place).collect();
        assert_eq!((&places[..3], places.len()), (&[0, 7, 8][..], 614));
        assert_eq!((read.first_time_s, read.grid_rows, read.decimals), (100.0, 620, [2, 3]));
        let back = read.with_readings(&same(&read));
        let as_before = |line: &str| line.replace(",30000.500,-20000.000,", ",30000.5,-20000,");
        assert!(back.lines().zip(text.lines()).all(|(back, before)| as_before(back) == before));
        assert_eq!(back.lines().count(), 621);
    }

    #[test]
    fn only_usable_rows_take_other_readings() {
        let text = text(&[(1, "a,100.1,0,9.9,30000.5,-20000,34000.125")]);
        let read = RecordedCsv::read("rec.csv", &text).unwrap();
        let readings = Readings { scalar_nt: vec![49_999.999; 620], flux_nt: vec![[1.0, -2.0, 3.000_51]; 620] };
        let back = read.with_readings(&readings);
        let lines: Vec<&str> = back.lines().collect();
        assert_eq!(lines[1], "a,100.0,1,50000.00,1.000,-2.000,3.001");
        assert_eq!(lines[2], "a,100.1,0,9.9,30000.5,-20000,34000.125");
    }

    #[test]
    fn what_is_no_recording_is_refused_in_a_line() {
        let error = |text: &str| RecordedCsv::read("rec.csv", text).unwrap_err().to_string();
        assert_eq!(error("time_s,scalar_nT\n"), "rec.csv: the column flux_x_nT is missing");
        let short = text(&[]).lines().take(11).collect::<Vec<&str>>().join("\n");
        assert_eq!(error(&short), "rec.csv: 1.0 s of valid rows, a trial needs at least 60 s");
    }
}

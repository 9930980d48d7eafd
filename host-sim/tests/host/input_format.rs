//! How an input format is added, walked once with a format that the program does not have: a reader, and its place in the
//! list of formats. The format: a mark of eight bytes, then six 32-bit integers a row, which count tenths of a second,
//! picotesla (scalar), hundredths of a nanotesla (fluxgate) and centimetres (depth).

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use host_sim::command;
use host_sim::recording::{
    BadInput, Column, FORMATS, FieldSink, Format, RecordingError, RecordingReader, RecordingRow, Schema, Table,
    TickCounter, open, open_as_one_of,
};
use host_sim::simulator::sample_survey;
use tempfile::TempDir;
use towmag::{Method, Settings};

/// First bytes of a file.
const MARK: &[u8; 8] = b"TENTHS01";

/// A reading that the recorder does not have.
const NONE: i32 = i32::MIN;

/// Columns of a record, each with what its integers count.
const COLUMNS: [(Column, f64); 6] = [
    (Column::Time, 0.1),
    (Column::Scalar, 1e-3),
    (Column::FluxX, 0.01),
    (Column::FluxY, 0.01),
    (Column::FluxZ, 0.01),
    (Column::Depth, 0.01),
];

/// The one line in the list of formats.
const TENTHS: Format =
    Format { is_start: |start| start.starts_with(MARK), open: |path, _| Ok(Box::new(Tenths::open(path)?)) };

/// The reader.
struct Tenths {
    file: String,
    byte_len: u64,
    bytes: BufReader<File>,
    bytes_read: u64,
    schema: Schema,
    ticks: TickCounter,
    rows: u64,
}

impl Tenths {
    fn open(path: &Path) -> Result<Self, RecordingError> {
        let file = path.display().to_string();
        let io = |source| RecordingError::Io { path: file.clone(), source };
        let mut bytes = BufReader::new(File::open(path).map_err(io)?);
        let byte_len = bytes.get_ref().metadata().map_err(io)?.len();
        bytes.read_exact(&mut [0; MARK.len()]).map_err(io)?;
        let schema = Schema::new(COLUMNS.map(|(column, _)| column.name())).map_err(|bad| bad.at(&file, 1))?;
        let (bytes_read, ticks) = (MARK.len() as u64, TickCounter::default());
        Ok(Self { file, byte_len, bytes, bytes_read, schema, ticks, rows: 0 })
    }

    fn bad(&self, what: &str) -> RecordingError {
        BadInput::of_line(what).at(&self.file, self.rows)
    }
}

impl RecordingReader for Tenths {
    fn file(&self) -> &str {
        &self.file
    }

    fn schema(&self) -> &Schema {
        &self.schema
    }

    fn bytes_read(&self) -> u64 {
        self.bytes_read
    }

    fn byte_len(&self) -> Option<u64> {
        Some(self.byte_len)
    }

    fn read_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError> {
        if self.bytes_read == self.byte_len {
            return if self.rows > 0 { Ok(false) } else { Err(self.bad("has no rows")) };
        }
        self.rows += 1;
        row.line_number = self.rows;
        row.clear();
        for (column, unit) in COLUMNS {
            let mut count = [0; 4];
            self.bytes.read_exact(&mut count).map_err(|_| self.bad("is cut in the middle of a row"))?;
            let count = i32::from_le_bytes(count);
            // Divided, so that the values are those of the decimal fraction.
            row.set(column, (count != NONE).then(|| f64::from(count) / (1.0 / unit).round()));
        }
        self.bytes_read += 4 * COLUMNS.len() as u64;
        row.complete(&mut self.ticks).map_err(|bad| bad.at(&self.file, self.rows))?;
        Ok(true)
    }

    fn update_steps(&self, _row: &RecordingRow, steps: &mut [Option<f64>]) {
        steps.iter_mut().zip(COLUMNS).for_each(|(step, (_, unit))| *step = Some(unit));
    }

    fn write_fields(&self, row: &RecordingRow, positions: &[usize], sink: &mut FieldSink<'_>) -> csv::Result<()> {
        for &position in positions {
            let value = row.number(COLUMNS[position].0);
            sink(value.map(|value| value.to_string()).unwrap_or_default().as_bytes())?;
        }
        Ok(())
    }
}

/// A survey in counts; in the third row the fluxgate's third axis is missing.
fn counts() -> Vec<[i32; 6]> {
    let hundredths = |nt: f64| (nt * 100.0).round() as i32;
    let row = |(k, sample): (usize, host_sim::simulator::Sample)| {
        let [x, y, z] = sample.flux_nt.map(hundredths);
        let z = if k == 2 { NONE } else { z };
        [k as i32, (sample.scalar_nt * 1e3).round() as i32, x, y, z, 500 + (k % 7) as i32]
    };
    sample_survey().samples().take(1200).enumerate().map(row).collect()
}

fn saved(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn in_tenths(folder: &TempDir) -> PathBuf {
    let counts = counts().concat().into_iter().flat_map(i32::to_le_bytes);
    saved(folder, "survey.bin", &MARK.iter().copied().chain(counts).collect::<Vec<u8>>())
}

fn in_csv(folder: &TempDir) -> PathBuf {
    let mut text = COLUMNS.map(|(column, _)| column.name()).join(",") + "\n";
    for row in counts() {
        let decimals = |(count, (_, unit)): (i32, (Column, f64))| match count {
            NONE => String::new(),
            _ => format!("{:.*}", (-unit.log10()).round() as usize, f64::from(count) * unit),
        };
        text += &(row.into_iter().zip(COLUMNS).map(decimals).collect::<Vec<_>>().join(",") + "\n");
    }
    saved(folder, "survey.csv", text.as_bytes())
}

fn formats() -> Vec<Format> {
    std::iter::once(TENTHS).chain(FORMATS).collect()
}

#[test]
fn a_file_is_recognised_by_its_first_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for path in [in_tenths(&folder), in_csv(&folder)] {
        let mut reader = open_as_one_of(&formats(), &path).unwrap();
        let mut row = RecordingRow::default();
        assert!(reader.read_row(&mut row).unwrap() && row.is_usable());
        assert_eq!(row.number(Column::Depth), Some(5.0));
    }
    let unknown = open_as_one_of(&[TENTHS], &in_csv(&folder)).err().unwrap().to_string();
    assert!(unknown.ends_with("survey.csv:1: is in no known format of recordings"), "{unknown}");
    assert!(open(&in_tenths(&folder)).is_err(), "not one of this program's own");
}

#[test]
fn its_table_is_that_of_the_same_recording_in_csv() {
    let folder = tempfile::tempdir().unwrap();
    let table = |path: &Path| Table::read(&mut *open_as_one_of(&formats(), path).unwrap()).unwrap();
    let (tenths, csv) = (table(&in_tenths(&folder)), table(&in_csv(&folder)));
    assert_eq!((tenths.len(), tenths.usable()), (1200, csv.usable()));
    assert!(!tenths.usable()[2] && tenths.usable().iter().filter(|usable| **usable).count() == 1199);
    for (column, unit) in COLUMNS {
        let (ours, theirs) = (tenths.numbers(column).unwrap(), csv.numbers(column).unwrap());
        let is_same = |(ours, theirs): (&f64, &f64)| ours == theirs || ours.is_nan() && theirs.is_nan();
        assert!(ours.iter().zip(theirs).all(is_same), "{column:?}");
        assert_eq!(tenths.resolution(column), Some(unit));
        assert!((csv.resolution(column).unwrap() / unit - 1.0).abs() < 1e-12, "{column:?}");
    }
}

#[test]
fn it_is_replayed_as_the_same_recording_in_csv() {
    let folder = tempfile::tempdir().unwrap();
    let settings = Settings { method: Method::SaddlePoint, ..Settings::default() };
    let replayed = |path: &Path| {
        let out = path.with_extension("out");
        let start = command::start_from(None).unwrap();
        let mut reader = open_as_one_of(&formats(), path).unwrap();
        let summary = command::replay_opened(&mut *reader, &start, &out, &settings).unwrap();
        (summary.rows, summary.used_rows, columns(&out.join("compensated.csv")))
    };
    let (ours, theirs) = (replayed(&in_tenths(&folder)), replayed(&in_csv(&folder)));
    assert_eq!((ours.0, ours.1), (1200, theirs.1));
    assert!(ours == theirs, "the same figures in every row");
}

/// All fields, numbers as such: how many zeros end a number is up to each format.
fn columns(path: &Path) -> Vec<Vec<Result<f64, String>>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let value = |field: &str| field.parse().map_err(|_| field.to_string());
    reader.records().map(|row| row.unwrap().iter().map(value).collect()).collect()
}

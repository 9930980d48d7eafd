//! The CSV format: a header row, then one row per 10 Hz epoch.

mod clock;
mod fields;
mod lines;
mod records;
mod tolerance;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use csv::ByteRecord;

use self::fields::{Fields, finite, step_of};
use self::records::Records;
use self::tolerance::Tolerance;
use crate::recording::bad_rows::BadRows;
use crate::recording::error::{BadInput, RecordingError};
use crate::recording::rate_check::RateCheck;
use crate::recording::reader::{FieldSink, Format, RecordingReader};
use crate::recording::row::RecordingRow;
use crate::recording::schema::Schema;
use crate::recording::ticks::TickCounter;
use towmag_recording::Column;

/// CSV has no mark of its own: it takes what no other format does.
pub(super) const FORMAT: Format = Format {
    is_start: |_| true,
    open: |path, name| CsvReader::open_named(path, name).map(|reader| Box::new(reader) as _),
};

/// A recording in CSV that is being read, row by row.
pub struct CsvReader<R: Read> {
    byte_len: Option<u64>,
    records: Records<R>,
    schema: Schema,
    ticks: TickCounter,
    rate: RateCheck,
    /// `None` where the first bad row is the end.
    tolerance: Option<Tolerance>,
    rows: u64,
    ended: bool,
}

impl CsvReader<File> {
    /// Open a file and read its header.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, RecordingError> {
        let path = path.as_ref();
        Self::open_named(path, &path.display().to_string())
    }

    /// The same of a file that messages call `name`.
    fn open_named(path: &Path, name: &str) -> Result<Self, RecordingError> {
        let open = || {
            let file = File::open(path)?;
            let metadata = file.metadata()?;
            Ok((file, metadata.is_file().then_some(metadata.len())))
        };
        let (file, byte_len) = open().map_err(|source| RecordingError::Io { path: name.into(), source })?;
        Ok(Self { byte_len, ..Self::from_reader(name, file)? })
    }
}

impl<R: Read> CsvReader<R> {
    /// Read the header of a recording that comes from anywhere; messages call it `name`. No buffering is needed.
    pub fn from_reader(name: impl Into<String>, reader: R) -> Result<Self, RecordingError> {
        let mut records = Records::new(name.into(), reader);
        let schema = read_schema(&mut records)?;
        Ok(Self {
            byte_len: None,
            records,
            schema,
            ticks: TickCounter::default(),
            rate: RateCheck::default(),
            tolerance: None,
            rows: 0,
            ended: false,
        })
    }

    /// The latest row as it is in the file, field by field.
    pub fn fields(&self) -> &ByteRecord {
        self.records.fields()
    }

    fn read_next_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError> {
        if !self.records.advance()? {
            return self.end();
        }
        self.rows += 1;
        row.line_number = self.records.line();
        match &mut self.tolerance {
            Some(tolerance) => tolerance.read(&mut self.records, &self.schema, &mut self.ticks, row),
            None => self.read_strictly(row)?,
        }
        self.check_rate()?;
        Ok(true)
    }

    fn read_strictly(&mut self, row: &mut RecordingRow) -> Result<(), RecordingError> {
        if self.fields().len() != self.schema.len() {
            let (fields, columns) = (self.fields().len(), self.schema.len());
            return Err(self.records.bad(format!("has {fields} fields where the header has {columns}")));
        }
        let fields = Fields { record: self.records.fields(), schema: &self.schema };
        let set = fields.set_values(row).and_then(|()| row.complete(&mut self.ticks));
        set.map_err(|bad| bad.at(self.records.file(), row.line_number))
    }

    /// By the times as they are written, also of rows that are no good.
    fn check_rate(&mut self) -> Result<(), RecordingError> {
        let [time, ..] = self.schema.required();
        let found = self.fields().get(time).and_then(finite).and_then(|time_s| self.rate.step(time_s));
        found.map_or(Ok(()), |what| Err(self.wrong_rate(&what)))
    }

    #[cold]
    fn wrong_rate(&self, what: &str) -> RecordingError {
        let file = self.records.file();
        let what = format!("{what}: `host-sim import {file} --out REC.csv` resamples");
        BadInput::of(Column::Time.name().as_bytes(), what).at(file, self.records.line())
    }

    /// After the last row: whether the recording as a whole was one.
    fn end(&self) -> Result<bool, RecordingError> {
        if self.rows == 0 {
            return Err(self.records.bad("has no rows, only a header"));
        }
        if let Some(what) = self.rate.verdict() {
            return Err(self.wrong_rate(&what));
        }
        match self.bad_rows().and_then(|bad_rows| bad_rows.refusal(self.records.file())) {
            Some((first, what)) => {
                let (file, line, column) = (self.records.file().into(), first.line, first.column);
                Err(RecordingError::Bad { file, line, column, what })
            }
            None => Ok(false),
        }
    }
}

impl<R: Read> RecordingReader for CsvReader<R> {
    fn file(&self) -> &str {
        self.records.file()
    }

    fn schema(&self) -> &Schema {
        &self.schema
    }

    fn tolerate(&mut self) {
        self.tolerance.get_or_insert_default();
    }

    fn bad_rows(&self) -> Option<&BadRows> {
        self.tolerance.as_ref().map(Tolerance::bad_rows)
    }

    fn bytes_read(&self) -> u64 {
        self.records.bytes()
    }

    /// Size of the file when it was opened, if it is a regular one.
    fn byte_len(&self) -> Option<u64> {
        self.byte_len
    }

    fn read_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError> {
        if self.ended {
            return Ok(false);
        }
        let read = self.read_next_row(row);
        self.ended = !matches!(read, Ok(true));
        read
    }

    /// By the digits that are written: a recorder that writes `50000.10` resolves hundredths.
    fn update_steps(&self, _row: &RecordingRow, steps: &mut [Option<f64>]) {
        for (step, field) in steps.iter_mut().zip(self.fields()) {
            if let Some(written) = step_of(field) {
                *step = Some(step.map_or(written, |step| step.min(written)));
            }
        }
    }

    fn write_fields(&self, _row: &RecordingRow, positions: &[usize], sink: &mut FieldSink<'_>) -> csv::Result<()> {
        // A row that is cut has fewer.
        positions.iter().try_for_each(|&position| sink(self.fields().get(position).unwrap_or_default()))
    }
}

fn read_schema<R: Read>(records: &mut Records<R>) -> Result<Schema, RecordingError> {
    if !records.advance()? {
        return Err(records.bad("is empty: a header row and at least one row of values are expected"));
    }
    // The parser overlooks a byte order mark that arrives in pieces.
    let names = records.fields();
    let first = names.get(0).unwrap_or_default();
    let first = first.strip_prefix(b"\xef\xbb\xbf").unwrap_or(first);
    let names = std::iter::once(first).chain(names.iter().skip(1)).map(<[u8]>::trim_ascii);
    Schema::new(names).map_err(|bad| bad.at(records.file(), records.line()))
}

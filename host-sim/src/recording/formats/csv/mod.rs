//! The CSV format: a header row, then one row per 10 Hz epoch.

mod fields;
mod lines;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use csv::{ByteRecord, Reader, ReaderBuilder};

use self::fields::{Fields, step_of};
use self::lines::{LONGEST_ROW_BYTES, Lines};
use crate::recording::error::{BadInput, RecordingError};
use crate::recording::reader::{FieldSink, Format, RecordingReader};
use crate::recording::row::RecordingRow;
use crate::recording::schema::Schema;
use crate::recording::ticks::TickCounter;

/// CSV has no mark of its own: it takes what no other format does.
pub(super) const FORMAT: Format =
    Format { is_start: |_| true, open: |path| CsvReader::open(path).map(|reader| Box::new(reader) as _) };

/// A recording in CSV that is being read, row by row.
pub struct CsvReader<R: Read> {
    file: String,
    byte_len: Option<u64>,
    reader: Reader<Lines<R>>,
    schema: Schema,
    /// The latest row as it is in the file.
    record: ByteRecord,
    ticks: TickCounter,
    rows: u64,
    ended: bool,
}

impl CsvReader<File> {
    /// Open a file and read its header.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, RecordingError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let open = || {
            let file = File::open(path)?;
            let metadata = file.metadata()?;
            Ok((file, metadata.is_file().then_some(metadata.len())))
        };
        let (file, byte_len) = open().map_err(|source| RecordingError::Io { path: name.clone(), source })?;
        Ok(Self { byte_len, ..Self::from_reader(name, file)? })
    }
}

impl<R: Read> CsvReader<R> {
    /// Read the header of a recording that comes from anywhere; messages call it `name`. No buffering is needed.
    pub fn from_reader(name: impl Into<String>, reader: R) -> Result<Self, RecordingError> {
        let file = name.into();
        // Header and length of rows are checked here, where the line is known.
        let mut builder = ReaderBuilder::new();
        builder.has_headers(false).flexible(true);
        let mut reader = builder.from_reader(Lines::new(reader));
        let schema = read_schema(&file, &mut reader)?;
        Ok(Self {
            file,
            byte_len: None,
            reader,
            schema,
            record: ByteRecord::new(),
            ticks: TickCounter::default(),
            rows: 0,
            ended: false,
        })
    }

    /// The latest row as it is in the file, field by field.
    pub fn fields(&self) -> &ByteRecord {
        &self.record
    }

    fn read_next_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError> {
        if !read_record(&self.file, &mut self.reader, &mut self.record)? {
            return if self.rows > 0 { Ok(false) } else { Err(self.bad("has no rows, only a header")) };
        }
        self.rows += 1;
        row.line_number = self.reader.get_ref().record_line();
        if self.record.len() != self.schema.len() {
            let (fields, columns) = (self.record.len(), self.schema.len());
            return Err(self.bad(format!("has {fields} fields where the header has {columns}")));
        }
        let fields = Fields { record: &self.record, schema: &self.schema };
        let set = fields.set_values(row).and_then(|()| row.complete(&mut self.ticks));
        set.map_err(|bad| bad.at(&self.file, row.line_number))?;
        Ok(true)
    }

    #[cold]
    fn bad(&self, what: impl Into<String>) -> RecordingError {
        bad(&self.file, &self.reader, what)
    }
}

impl<R: Read> RecordingReader for CsvReader<R> {
    fn file(&self) -> &str {
        &self.file
    }

    fn schema(&self) -> &Schema {
        &self.schema
    }

    fn bytes_read(&self) -> u64 {
        self.reader.get_ref().bytes()
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
        for (step, field) in steps.iter_mut().zip(&self.record) {
            if let Some(written) = step_of(field) {
                *step = Some(step.map_or(written, |step| step.min(written)));
            }
        }
    }

    fn write_fields(&self, _row: &RecordingRow, positions: &[usize], sink: &mut FieldSink<'_>) -> csv::Result<()> {
        positions.iter().try_for_each(|&position| sink(&self.record[position]))
    }
}

fn read_schema<R: Read>(file: &str, reader: &mut Reader<Lines<R>>) -> Result<Schema, RecordingError> {
    let mut names = ByteRecord::new();
    if !read_record(file, reader, &mut names)? {
        return Err(bad(file, reader, "is empty: a header row and at least one row of values are expected"));
    }
    // The parser overlooks a byte order mark that arrives in pieces.
    let first = names.get(0).unwrap_or_default();
    let first = first.strip_prefix(b"\xef\xbb\xbf").unwrap_or(first);
    let names = std::iter::once(first).chain(names.iter().skip(1)).map(<[u8]>::trim_ascii);
    Schema::new(names).map_err(|bad| bad.at(file, reader.get_ref().record_line()))
}

/// The next record, as it is. Blank lines are none.
fn read_record<R: Read>(
    file: &str,
    reader: &mut Reader<Lines<R>>,
    record: &mut ByteRecord,
) -> Result<bool, RecordingError> {
    reader.get_mut().start_record();
    let read = reader.read_byte_record(record);
    let lines = reader.get_ref();
    if lines.record_is_too_long() {
        let limit_mib = LONGEST_ROW_BYTES >> 20;
        let what = format!("is longer than {limit_mib} MiB: a line break or a quotation mark is missing");
        return Err(bad(file, reader, what));
    }
    if lines.quotation_is_open() {
        let what = "has a quotation mark without its counterpart, so that no end of the row is found";
        return Err(bad(file, reader, what));
    }
    read.map_err(|error| RecordingError::Io { path: file.into(), source: source_of(error) })
}

#[cold]
fn bad<R: Read>(file: &str, reader: &Reader<Lines<R>>, what: impl Into<String>) -> RecordingError {
    BadInput { column: None, what: what.into() }.at(file, reader.get_ref().record_line())
}

/// The system's own error, whose kind tells a directory from a broken disk.
fn source_of(error: csv::Error) -> std::io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(source) => source,
        kind => std::io::Error::other(format!("{kind:?}")),
    }
}

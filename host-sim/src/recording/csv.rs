//! The CSV format: a header row, then one row per 10 Hz epoch.

use super::clock::Clock;
use super::columns::Columns;
use super::error::{Fault, RecordingError};
use super::lines::{LONGEST_ROW_BYTES, Lines};
use super::row::RecordingRow;
use csv::{ByteRecord, Reader, ReaderBuilder};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// A recording that is being read, row by row.
pub struct Recording<R: Read> {
    file: String,
    byte_len: Option<u64>,
    reader: Reader<Lines<R>>,
    header: ByteRecord,
    columns: Columns,
    clock: Clock,
    rows: u64,
    ended: bool,
}

impl Recording<File> {
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
        let recording = Self::from_reader(name, file)?;
        Ok(Self { byte_len, ..recording })
    }
}

impl<R: Read> Recording<R> {
    /// Read the header of a recording that comes from anywhere; messages call it `name`. No buffering is needed.
    pub fn from_reader(name: impl Into<String>, reader: R) -> Result<Self, RecordingError> {
        // Header and length of rows are checked here, where the line is known.
        let mut builder = ReaderBuilder::new();
        builder.has_headers(false).flexible(true);
        let mut recording = Self {
            file: name.into(),
            byte_len: None,
            reader: builder.from_reader(Lines::new(reader)),
            header: ByteRecord::new(),
            columns: Columns::default(),
            clock: Clock::default(),
            rows: 0,
            ended: false,
        };
        recording.read_header()?;
        Ok(recording)
    }

    /// The names of the columns, trimmed, in the order of the file.
    pub fn header(&self) -> &ByteRecord {
        &self.header
    }

    /// Which column is which.
    pub fn columns(&self) -> &Columns {
        &self.columns
    }

    /// The file as the user named it.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Bytes read so far, up to the end of the last row.
    pub fn bytes_read(&self) -> u64 {
        self.reader.get_ref().bytes()
    }

    /// Size of the file when it was opened, if it is a regular one.
    pub fn byte_len(&self) -> Option<u64> {
        self.byte_len
    }

    /// The next row into `row`. `false` after the last one, when `row` is left without meaning, as after an error.
    /// After an error nothing more is read.
    pub fn read_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError> {
        if self.ended {
            return Ok(false);
        }
        let read = self.read_next_row(row);
        self.ended = !matches!(read, Ok(true));
        read
    }

    fn read_next_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError> {
        if !self.read_record(&mut row.fields)? {
            return if self.rows > 0 { Ok(false) } else { Err(self.bad("has no rows, only a header")) };
        }
        self.rows += 1;
        row.line_number = self.reader.get_ref().record_line();
        if row.fields.len() != self.header.len() {
            let (fields, columns) = (row.fields.len(), self.header.len());
            return Err(self.bad(format!("has {fields} fields where the header has {columns}")));
        }
        row.parse(&self.columns, &self.header).map_err(|fault| self.at_this_line(fault))?;
        let tick = self.clock.step(row.time_s).map_err(|fault| self.at_this_line(fault))?;
        row.epoch.tick = tick.tick;
        row.gap_s = tick.gap_s;
        Ok(true)
    }

    fn read_header(&mut self) -> Result<(), RecordingError> {
        let mut names = ByteRecord::new();
        if !self.read_record(&mut names)? {
            return Err(self.bad("is empty: a header row and at least one row of values are expected"));
        }
        // The parser overlooks a byte order mark that arrives in pieces.
        let first = names.get(0).unwrap_or_default();
        let first = first.strip_prefix(b"\xef\xbb\xbf").unwrap_or(first);
        self.header = std::iter::once(first).chain(names.iter().skip(1)).map(<[u8]>::trim_ascii).collect();
        self.columns = Columns::find(&self.header).map_err(|fault| self.at_this_line(fault))?;
        Ok(())
    }

    /// The next record, as it is. Blank lines are none.
    fn read_record(&mut self, record: &mut ByteRecord) -> Result<bool, RecordingError> {
        self.reader.get_mut().start_record();
        let read = self.reader.read_byte_record(record);
        let lines = self.reader.get_ref();
        if lines.record_is_too_long() {
            let limit_mib = LONGEST_ROW_BYTES >> 20;
            return Err(
                self.bad(format!("is longer than {limit_mib} MiB: a line break or a quotation mark is missing"))
            );
        }
        if lines.quotation_is_open() {
            return Err(self.bad("has a quotation mark without its counterpart, so that no end of the row is found"));
        }
        read.map_err(|error| RecordingError::Io { path: self.file.clone(), source: source_of(error) })
    }

    #[cold]
    fn at_this_line(&self, Fault { column, what }: Fault) -> RecordingError {
        let line = self.reader.get_ref().record_line();
        RecordingError::Bad { file: self.file.clone(), line, column, what }
    }

    #[cold]
    fn bad(&self, what: impl Into<String>) -> RecordingError {
        self.at_this_line(Fault { column: None, what: what.into() })
    }
}

/// The system's own error, whose kind tells a directory from a broken disk.
fn source_of(error: csv::Error) -> std::io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(source) => source,
        kind => std::io::Error::other(format!("{kind:?}")),
    }
}

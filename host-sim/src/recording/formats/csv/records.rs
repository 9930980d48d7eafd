//! The records of a file, each with its line, and the one that comes next.

use std::io::Read;

use csv::{ByteRecord, Reader, ReaderBuilder};

use super::lines::{LONGEST_ROW_BYTES, Lines};
use crate::recording::error::{BadInput, RecordingError};

/// Reads record by record; blank lines are none.
pub(super) struct Records<R: Read> {
    file: String,
    reader: Reader<Lines<R>>,
    latest: Record,
    /// What comes next, if somebody has looked.
    next: Option<Result<bool, RecordingError>>,
    ahead: Record,
}

/// A record as it is.
#[derive(Default)]
struct Record {
    fields: ByteRecord,
    /// Physical line on which it starts, from 1.
    line: u64,
}

impl<R: Read> Records<R> {
    /// Messages call the file `file`. No buffering is needed.
    pub(super) fn new(file: String, reader: R) -> Self {
        // Header and length of rows are checked elsewhere, where the line is known.
        let mut builder = ReaderBuilder::new();
        builder.has_headers(false).flexible(true);
        let reader = builder.from_reader(Lines::new(reader));
        Self { file, reader, latest: Record::default(), next: None, ahead: Record::default() }
    }

    pub(super) fn file(&self) -> &str {
        &self.file
    }

    /// Go to the next record; `false` after the last one.
    pub(super) fn advance(&mut self) -> Result<bool, RecordingError> {
        match self.next.take() {
            Some(next) => {
                std::mem::swap(&mut self.latest, &mut self.ahead);
                next
            }
            None => read(&self.file, &mut self.reader, &mut self.latest),
        }
    }

    /// The record after the latest; `None` at the end, and where nothing can be read.
    pub(super) fn peek(&mut self) -> Option<&ByteRecord> {
        let Self { file, reader, next, ahead, .. } = self;
        let next = next.get_or_insert_with(|| read(file, reader, ahead));
        matches!(next, Ok(true)).then_some(&self.ahead.fields)
    }

    /// The fields of the latest record.
    pub(super) fn fields(&self) -> &ByteRecord {
        &self.latest.fields
    }

    /// The line of the latest record.
    pub(super) fn line(&self) -> u64 {
        self.latest.line
    }

    /// Bytes read so far.
    pub(super) fn bytes(&self) -> u64 {
        self.reader.get_ref().bytes()
    }

    /// Whether the latest bytes end a line.
    pub(super) fn is_line_ended(&self) -> bool {
        self.reader.get_ref().is_line_ended()
    }

    /// Something is wrong with the latest record as a whole.
    #[cold]
    pub(super) fn bad(&self, what: impl Into<String>) -> RecordingError {
        BadInput::of_line(what).at(&self.file, self.line())
    }
}

/// The next record, as it is.
fn read<R: Read>(file: &str, reader: &mut Reader<Lines<R>>, into: &mut Record) -> Result<bool, RecordingError> {
    reader.get_mut().start_record();
    let read = reader.read_byte_record(&mut into.fields);
    let lines = reader.get_ref();
    into.line = lines.record_line();
    if lines.record_is_too_long() {
        let limit_mib = LONGEST_ROW_BYTES >> 20;
        let what = format!("is longer than {limit_mib} MiB: a line break or a quotation mark is missing");
        return Err(BadInput::of_line(what).at(file, into.line));
    }
    if lines.quotation_is_open() {
        let what = "has a quotation mark without its counterpart, so that no end of the row is found";
        return Err(BadInput::of_line(what).at(file, into.line));
    }
    read.map_err(|error| RecordingError::Io { path: file.into(), source: source_of(error) })
}

/// The system's own error, whose kind tells a directory from a broken disk.
fn source_of(error: csv::Error) -> std::io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(source) => source,
        kind => std::io::Error::other(format!("{kind:?}")),
    }
}

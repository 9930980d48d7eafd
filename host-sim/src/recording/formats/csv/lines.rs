//! Hands bytes on line by line, so that a record's physical line is known and its length bounded.

use std::io::{self, BufRead, BufReader, Read};

/// Longest row: a quotation mark left open would otherwise gather the rest of the file in memory.
pub(super) const LONGEST_ROW_BYTES: u64 = 1 << 20;

/// How much is read from the file at a time.
const BUFFER_BYTES: usize = 1 << 17;

/// A [`Read`] that never hands out more than the rest of one line.
///
/// Whoever parses it therefore holds, after a record, no byte of the next but the line feed of a carriage return.
/// The parser's own line count cannot serve: it is that of the place where the previous record ended, before
/// blank lines and before that line feed.
pub(super) struct Lines<R> {
    inner: BufReader<R>,
    /// Line of the last byte handed out.
    line: u64,
    at_line_start: bool,
    bytes: u64,
    record: Record,
}

/// What was handed out since the last [`Lines::start_record`].
#[derive(Clone, Copy, Debug, Default)]
struct Record {
    /// The first line with anything in it.
    first_line: Option<u64>,
    bytes: u64,
    quotation_marks: usize,
}

impl<R: Read> Lines<R> {
    pub(super) fn new(inner: R) -> Self {
        let inner = BufReader::with_capacity(BUFFER_BYTES, inner);
        Self { inner, line: 0, at_line_start: true, bytes: 0, record: Record::default() }
    }

    /// To be called before every record.
    pub(super) fn start_record(&mut self) {
        self.record = Record::default();
    }

    /// Physical line on which the record starts, from 1.
    pub(super) fn record_line(&self) -> u64 {
        self.record.first_line.unwrap_or(self.line).max(1)
    }

    /// Whether the record goes on over several lines because of a quotation mark without its counterpart.
    pub(super) fn quotation_is_open(&self) -> bool {
        self.line > self.record_line() && self.record.quotation_marks % 2 == 1
    }

    pub(super) fn record_is_too_long(&self) -> bool {
        self.record.bytes > LONGEST_ROW_BYTES
    }

    /// Whether the last byte handed out is a line feed.
    pub(super) fn is_line_ended(&self) -> bool {
        self.at_line_start
    }

    /// Bytes handed out so far.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl<R: Read> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.record_is_too_long() {
            return Err(io::Error::other("the row is too long"));
        }
        let available = self.inner.fill_buf()?;
        let available = &available[..available.len().min(buffer.len())];
        let line_feed = memchr::memchr(b'\n', available);
        let piece = &available[..line_feed.map_or(available.len(), |at| at + 1)];
        let length = piece.len();
        buffer[..length].copy_from_slice(piece);

        self.line += u64::from(self.at_line_start && length > 0);
        self.at_line_start = line_feed.is_some() || (self.at_line_start && length == 0);
        if self.record.first_line.is_none() && piece.iter().any(|byte| !b"\r\n".contains(byte)) {
            self.record.first_line = Some(self.line);
        }
        self.record.quotation_marks += memchr::memchr_iter(b'"', piece).count();
        self.record.bytes += length as u64;
        self.bytes += length as u64;
        self.inner.consume(length);
        Ok(length)
    }
}

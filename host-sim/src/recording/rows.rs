//! Recordings of either kind, CSV or device log, as the same rows.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use csv::ByteRecord;

use super::columns::Columns;
use super::csv::Recording;
use super::device_log::DeviceLog;
use super::error::RecordingError;
use super::row::RecordingRow;

/// A recording, whatever it is stored in.
pub trait Rows {
    /// The file as the user named it.
    fn file(&self) -> &str;
    /// The names of the columns.
    fn header(&self) -> &ByteRecord;
    /// Which column is which.
    fn columns(&self) -> &Columns;
    /// Bytes read so far.
    fn bytes_read(&self) -> u64;
    /// Size of all, if it is known.
    fn byte_len(&self) -> Option<u64>;
    /// The next row into `row`; `false` after the last one.
    fn read_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError>;
}

impl<R: Read> Rows for Recording<R> {
    fn file(&self) -> &str {
        self.file()
    }

    fn header(&self) -> &ByteRecord {
        self.header()
    }

    fn columns(&self) -> &Columns {
        self.columns()
    }

    fn bytes_read(&self) -> u64 {
        self.bytes_read()
    }

    fn byte_len(&self) -> Option<u64> {
        self.byte_len()
    }

    fn read_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError> {
        self.read_row(row)
    }
}

/// Open a recording: a device log if it starts as one, else CSV.
pub fn open(path: &Path) -> Result<Box<dyn Rows>, RecordingError> {
    if starts_as_log(path) { Ok(Box::new(DeviceLog::open(path)?)) } else { Ok(Box::new(Recording::open(path)?)) }
}

/// Whether a regular file starts with a sector, or with the first block, of a log. Pipes are not looked into: what is
/// read from one is gone.
pub fn starts_as_log(path: &Path) -> bool {
    let start = || {
        let mut file = File::open(path).ok().filter(|file| file.metadata().is_ok_and(|metadata| metadata.is_file()))?;
        let mut start = [0; 8];
        file.read_exact(&mut start).ok().map(|()| start)
    };
    start().is_some_and(|start| start.starts_with(b"TMLS") || &start == b"TOWMAGLF")
}

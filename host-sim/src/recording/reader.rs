//! What every format of recordings gives: a schema, and typed rows one after the other.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::bad_rows::BadRows;
use super::error::RecordingError;
use super::row::RecordingRow;
use super::schema::Schema;
use super::session_gap::SessionGap;

/// Takes the fields of a row as text, one after the other.
pub type FieldSink<'a> = dyn FnMut(&[u8]) -> csv::Result<()> + 'a;

/// A recording that is being read, whatever it is stored in. It remembers its latest row at most: memory is constant.
pub trait RecordingReader {
    /// The file as the user named it.
    fn file(&self) -> &str;

    /// Its columns.
    fn schema(&self) -> &Schema;

    /// What lies between its sessions, if it has several.
    fn session_gaps(&self) -> &[SessionGap] {
        &[]
    }

    /// From now on rows that are no good are not the end: they are carried through as rows that are not usable, and counted.
    /// A format that cannot hold any does nothing.
    fn tolerate(&mut self) {}

    /// The rows so far that were no good; `None` where the first is the end.
    fn bad_rows(&self) -> Option<&BadRows> {
        None
    }

    /// Bytes read so far.
    fn bytes_read(&self) -> u64;

    /// Size of all, if it is known.
    fn byte_len(&self) -> Option<u64>;

    /// The next row into `row`. `false` after the last one, when `row` is left without meaning, as after an error.
    /// After an error nothing more is read.
    ///
    /// # Errors
    ///
    /// When the bytes cannot be read, or are no recording.
    fn read_row(&mut self, row: &mut RecordingRow) -> Result<bool, RecordingError>;

    /// The smallest step with which each column is written, in its unit and at its position of the schema, as far as the
    /// latest row shows it: `steps` holds what the rows before have shown. Not asked for in a row that is not usable.
    fn update_steps(&self, row: &RecordingRow, steps: &mut [Option<f64>]);

    /// The fields of the latest row at these positions of the schema, as they are written where a recording is passed
    /// through: as they were in the file, if that is text.
    ///
    /// # Errors
    ///
    /// Those of `sink`.
    fn write_fields(&self, row: &RecordingRow, positions: &[usize], sink: &mut FieldSink<'_>) -> csv::Result<()>;
}

/// A recording that is about to be read, or why it cannot be.
pub type Opened = Result<Box<dyn RecordingReader>, RecordingError>;

/// A format that recordings are stored in.
#[derive(Clone, Copy)]
pub struct Format {
    /// Whether a file that starts with these bytes is one: the first 64, or as many as there are. There are none of a
    /// pipe, for what is read from one is gone.
    pub is_start: fn(&[u8]) -> bool,
    /// Open a file; messages call it by the name beside its path.
    pub open: fn(&Path, &str) -> Opened,
}

/// How much of a file its format is recognised by.
const START_BYTES: u64 = 64;

/// The first bytes of a regular file; none of what cannot be read: opening it says why.
pub(super) fn start_of(path: &Path) -> Vec<u8> {
    let mut start = Vec::new();
    let file = File::open(path).ok().filter(|file| file.metadata().is_ok_and(|metadata| metadata.is_file()));
    if file.is_some_and(|file| file.take(START_BYTES).read_to_end(&mut start).is_err()) {
        start.clear();
    }
    start
}

//! Buffered writing whose errors say which file.

use super::error::OutputError;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

/// Buffer between the rows of a table and the system.
const BUFFER_BYTES: usize = 1 << 16;

/// An open file that is not in its place yet, under the name it will have there.
#[derive(Debug)]
pub(super) struct Stream {
    writer: BufWriter<File>,
    shown: PathBuf,
}

impl Stream {
    pub(super) fn new(file: File, shown: PathBuf) -> Self {
        Self { writer: BufWriter::with_capacity(BUFFER_BYTES, file), shown }
    }

    /// All of it on the disk: renaming a file whose bytes are still in memory could leave an empty one after a power cut.
    pub(super) fn finish(self) -> Result<(), OutputError> {
        let Self { writer, shown } = self;
        let file = writer.into_inner().map_err(|error| OutputError::io(&shown)(error.into_error()))?;
        file.sync_all().map_err(OutputError::io(&shown))
    }

    fn named(&self, error: io::Error) -> io::Error {
        io::Error::new(error.kind(), OutputError::io(&self.shown)(error))
    }
}

impl Write for Stream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes).map_err(|error| self.named(error))
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.writer.write_all(bytes).map_err(|error| self.named(error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush().map_err(|error| self.named(error))
    }
}

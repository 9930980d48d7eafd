//! A recording as a command is given it: a file, a compressed file, a pipe or standard input, to be read as often as needed.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use flate2::read::MultiGzDecoder;
use towmag_import::compressed::is_gzip;

use super::error::RecordingError;
use super::formats::open_named;
use super::reader::RecordingReader;
use crate::message::file_name;
use crate::output::Aside;

/// What stands for standard input on the command line.
const STDIN: &str = "-";
/// So many bytes tell a gzip.
const GZIP_MARK_BYTES: u64 = 2;

/// A recording to be read: where it is, and whether its first bad row ends the work.
#[derive(Clone, Debug)]
pub struct Input {
    /// As the user named it.
    name: PathBuf,
    is_strict: bool,
    /// Its bytes, where they had to be copied to be read more than once.
    spool: Option<Arc<Aside>>,
}

impl Input {
    /// A recording by its path, or `-` for standard input; `is_strict` when its first bad row shall end the work.
    pub fn new(path: impl Into<PathBuf>, is_strict: bool) -> Self {
        Self { name: path.into(), is_strict, spool: None }
    }

    /// The same where its bytes can be read more than once: what comes through a pipe, or is compressed, is copied into a
    /// temporary file, which goes when the last clone of this goes.
    ///
    /// # Errors
    ///
    /// When the bytes cannot be read, or the copy cannot be written.
    pub fn ready(self) -> Result<Self, RecordingError> {
        if self.spool.is_some() {
            return Ok(self);
        }
        let spool = self.copied().map_err(|source| RecordingError::Io { path: self.shown(), source })?;
        Ok(Self { spool: spool.map(Arc::new), ..self })
    }

    /// Where its bytes are.
    pub fn path(&self) -> &Path {
        self.spool.as_ref().map_or(&self.name, |spool| spool.path())
    }

    /// The file that the user named, if it is one.
    pub fn named(&self) -> Option<&Path> {
        (!self.is_stdin()).then_some(&self.name)
    }

    /// Whether its first bad row ends the work.
    pub fn is_strict(&self) -> bool {
        self.is_strict
    }

    /// Its name without folders, for what is shown.
    pub fn file_name(&self) -> String {
        if self.is_stdin() { self.shown() } else { file_name(&self.name) }
    }

    /// Its name as the user gave it, for messages.
    pub fn shown(&self) -> String {
        if self.is_stdin() { "standard input".into() } else { self.name.display().to_string() }
    }

    /// Read it from its start.
    ///
    /// # Errors
    ///
    /// When it cannot be read, or is no recording.
    pub fn open(&self) -> Result<Box<dyn RecordingReader>, RecordingError> {
        let mut reader = open_named(self.path(), &self.shown())?;
        if !self.is_strict {
            reader.tolerate();
        }
        Ok(reader)
    }

    fn is_stdin(&self) -> bool {
        self.name.as_os_str() == STDIN
    }

    /// A copy, if the bytes cannot be read as they are.
    fn copied(&self) -> io::Result<Option<Aside>> {
        let mut source: Box<dyn Read> = if self.is_stdin() { Box::new(io::stdin().lock()) } else { self.file()? };
        let mut start = Vec::new();
        let is_pipe = self.is_stdin() || !self.name.metadata()?.is_file();
        source.by_ref().take(GZIP_MARK_BYTES).read_to_end(&mut start)?;
        let is_gzip = is_gzip(&start);
        if !is_pipe && !is_gzip {
            return Ok(None);
        }
        let whole = io::Cursor::new(start).chain(source);
        let (aside, mut file) = Aside::file()?;
        match is_gzip {
            true => io::copy(&mut MultiGzDecoder::new(whole), &mut file).map_err(damaged)?,
            false => io::copy(&mut { whole }, &mut file)?,
        };
        Ok(Some(aside))
    }

    fn file(&self) -> io::Result<Box<dyn Read>> {
        Ok(Box::new(File::open(&self.name)?))
    }
}

/// What the decoder says of bytes that are none of its own.
fn damaged(error: io::Error) -> io::Error {
    use io::ErrorKind::{InvalidData, InvalidInput, UnexpectedEof};
    match error.kind() {
        InvalidData | InvalidInput | UnexpectedEof => {
            io::Error::new(InvalidData, format!("the gzip file is cut or damaged ({error}): copy it again"))
        }
        _ => error,
    }
}

impl<P: AsRef<Path> + ?Sized> From<&P> for Input {
    /// As it is without any option: bad rows are read past.
    fn from(path: &P) -> Self {
        Self::new(path.as_ref(), false)
    }
}

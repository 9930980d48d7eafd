//! What every reader of a format is, and what it is given.

use crate::error::ImportError;
use crate::source::Source;

/// A format that files can have.
///
/// A reader makes no allocation that the size of the file does not warrant: what a file claims of its own sizes is held
/// against its length first, at most [`LARGEST_GROWTH`] times of it are made.
pub trait SourceFormat: Sync {
    /// What it is, in words for the user.
    fn name(&self) -> &'static str;

    /// Whether these are the first bytes of such a file (up to 64 kB, or all of it).
    fn recognises(&self, first: &[u8]) -> bool;

    /// All that the file holds.
    ///
    /// # Errors
    ///
    /// When it is damaged, or lacks a companion: always with what to do.
    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError>;
}

/// A file to be read.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// As the user named it.
    pub file: &'a str,
    /// All of it, decompressed.
    pub bytes: &'a [u8],
    /// Other files that were given with it, as a definition beside its data: names and bytes.
    pub companions: &'a [(String, Vec<u8>)],
    /// The sheet, group or sensor that the user asked for.
    pub part: Option<&'a str>,
}

/// What a reader may make of a file: so many bytes of memory a byte, but 16 MB are always allowed.
pub const LARGEST_GROWTH: usize = 40;

//! The log file on a FAT card: allocated in one piece, then written below the file system.
//!
//! # Why below
//!
//! Every write through a FAT file system may rewrite a block of the table or the directory, and a power cut that tears
//! one of these takes more with it than the last record. So [`Maker`] makes a file of full size, `TOWMAG01.BIN` to
//! `TOWMAG99.BIN`, with as few writes to the file system as there can be, and from then on [`LogFile`] writes whole blocks of
//! its data in place. Size, chain and directory entry stay as they are, and a laptop can open the file at any time.
//!
//! # How the blocks are found
//!
//! A file lies in one piece, and its own first block says where: it is the file that the directory's entry means when it
//! begins where it says, and is as long. The chain in the table is for the laptop; the body mends it if need be. A file that
//! somebody has copied lies elsewhere than its first block says; it is left alone, and a new one is made. Whatever slips
//! through all that meets the writer's own rule, to write over nothing but the marker of this very block of this very file.
//!
//! # How the blocks are marked
//!
//! Markers are written ahead of the log, some at a time, while it goes on: over anything but the file's own sectors. How far
//! that has got is found by bisection after a restart. Behind it the file holds what lay there before it was made: a file
//! that is read within its first minutes may show sectors of a log that was deleted.
//!
//! # Two copies
//!
//! Each sector is written twice: to its place, and to the place half a file further on. So an erase block that turns to
//! garbage around the block that was being written takes no sector that was acknowledged before, as long as it is shorter
//! than half of the file.
//!
//! # First block
//!
//! `"TOWMAGLF", layout version u8, 0 u8, file number u16, nonce u32, blocks of the file u32, 1 u32, first block on the card
//! u32, blocks u32, zeros, crc u32`. Position `p` of the region is block `p + 1` of the file.

mod contents;
mod directory;
mod fat;
mod file;
mod free_run;
mod make;
mod map;
mod open;

pub use contents::{Contents, RootEntry};
pub use file::{LogFile, LogFileError};
pub use make::{Maker, NewFile, Ready};
pub use map::FileMap;

use super::block::BlockBytes;
use embedded_sdmmc::{Block, BlockDevice, BlockIdx};

/// Highest file number.
pub const LAST_FILE: u16 = 99;

/// A card: blocks, and a way to know that they are safe.
pub trait Card: BlockDevice {
    /// Return when everything written so far would survive a power cut.
    fn sync(&self) -> Result<(), Self::Error>;
}

/// Why there is no log file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeError<E> {
    /// The card failed.
    Card(E),
    /// The partition holds no FAT16 or FAT32 that makes sense.
    NoVolume,
    /// All 99 numbers are taken.
    TooManyFiles,
    /// There is no free run of 100 blocks.
    NoSpace,
    /// The root directory has no slot for another file.
    DirectoryFull,
    /// The size is not 100 to 8,388,607 blocks.
    Size(u32),
}

impl<E: core::fmt::Display> core::fmt::Display for VolumeError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Card(error) => write!(f, "card: {error}"),
            Self::NoVolume => write!(f, "the card's file system makes no sense: format it"),
            Self::TooManyFiles => write!(f, "there are {LAST_FILE} log files on the card: move some away"),
            Self::NoSpace => write!(f, "no space for a log file: empty or format the card"),
            Self::DirectoryFull => write!(f, "the card's root directory is full: move some files away"),
            Self::Size(blocks) => write!(f, "log file of {blocks} blocks: choose 100 to 8388607"),
        }
    }
}

impl<E: core::fmt::Debug + core::fmt::Display> core::error::Error for VolumeError<E> {}

impl<E> From<E> for VolumeError<E> {
    fn from(error: E) -> Self {
        Self::Card(error)
    }
}

fn read_block<D: BlockDevice>(card: &D, index: BlockIdx, block: &mut BlockBytes) -> Result<(), D::Error> {
    let mut one = [Block::new()];
    card.read(&mut one, index)?;
    *block = one[0].contents;
    Ok(())
}

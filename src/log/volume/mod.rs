//! The log file on a FAT card: allocated once, then written below the file system.
//!
//! # Why below
//!
//! Every write through a FAT file system may rewrite a FAT sector or a directory block, and a power cut that tears
//! one of these takes more with it than the last record. So [`FileMap::open_or_create`] makes a file of full size,
//! `TOWMAG01.BIN` to `TOWMAG99.BIN`, and from then on [`LogFile`] writes whole blocks of its data in place. Size,
//! chain and directory entry stay as they are, and a laptop can open the file at any time.
//!
//! # How the blocks are found
//!
//! `embedded-sdmmc` fills the file with one marker per block ([`blank_block`](super::blank_block)), but does not tell
//! where the blocks are. So the chain of clusters is walked here, read-only and trusting nothing. The extents that
//! come of it, at most [`MAX_EXTENTS`], go into the file's own first block, which is the last to be written: a file
//! without it was not finished, and is left alone. On later starts the chain is walked again; when it leads elsewhere
//! than the extents say (somebody has copied the file, or the table is torn), the file is left alone too, and a new
//! one is made. Whatever slips through all that meets the writer's own rule, to write over nothing but the marker of
//! this very block of this very file.
//!
//! A new file is only made while both copies of the allocation table agree. When they do not, the power went during
//! a change of the table, and blocks of an earlier log may look free.
//!
//! Filling takes one block write for each 512 bytes. At the bus clock that the board sets, 328 kHz, a write takes 13 ms: an
//! hour for a file of 72 hours. Prepare the card on deck, large enough for the campaign.
//!
//! # First block
//!
//! `"TOWMAGLF", format version u8, 0 u8, file number u16, nonce u32, blocks of the file u32, number of extents u32,
//! extents (first block on the card u32, blocks u32) ..., zeros, crc u32`. Position `p` of the region is block `p + 1`
//! of the file.

mod create;
mod fat;
mod map;

pub use create::{NewFile, VolumeError};
use embedded_sdmmc::{Block, BlockDevice, BlockIdx};
pub use map::{Extent, FileMap, MAX_EXTENTS};

use super::block::{BlockBytes, BlockSink, BlockSource, Region};

/// A card: blocks, and a way to know that they are safe.
pub trait Card: BlockDevice {
    /// Return when everything written so far would survive a power cut.
    fn sync(&self) -> Result<(), Self::Error>;
}

/// What can go wrong with a block of a [`LogFile`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogFileError<E> {
    /// The position is beyond the end of the region.
    OutOfRegion,
    /// The card failed.
    Card(E),
}

impl<E: core::fmt::Display> core::fmt::Display for LogFileError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::OutOfRegion => write!(f, "beyond the end of the log file"),
            Self::Card(error) => write!(f, "card: {error}"),
        }
    }
}

impl<E: core::fmt::Debug + core::fmt::Display> core::error::Error for LogFileError<E> {}

/// The region inside a log file, as the writer sees it.
#[derive(Debug)]
pub struct LogFile<D> {
    card: D,
    map: FileMap,
}

impl<D: Card> LogFile<D> {
    /// The file that `map` describes, on the card that it was opened on.
    pub fn new(card: D, map: FileMap) -> Self {
        Self { card, map }
    }

    /// Where it lies.
    pub fn map(&self) -> &FileMap {
        &self.map
    }

    /// The card itself.
    pub fn into_card(self) -> D {
        self.card
    }

    fn locate(&self, position: u32) -> Result<BlockIdx, LogFileError<D::Error>> {
        self.map.locate(position).map(BlockIdx).ok_or(LogFileError::OutOfRegion)
    }
}

impl<D: Card> BlockSource for LogFile<D> {
    type Error = LogFileError<D::Error>;

    fn blocks(&self) -> u32 {
        self.map.region_blocks()
    }

    fn read(&mut self, position: u32, block: &mut BlockBytes) -> Result<(), Self::Error> {
        let index = self.locate(position)?;
        read_block(&self.card, index, block).map_err(LogFileError::Card)
    }
}

impl<D: Card> BlockSink for LogFile<D> {
    fn region(&self) -> Region {
        self.map.region()
    }

    fn write(&mut self, position: u32, block: &BlockBytes) -> Result<(), Self::Error> {
        let index = self.locate(position)?;
        self.card.write(&[Block { contents: *block }], index).map_err(LogFileError::Card)
    }

    fn sync(&mut self) -> Result<(), Self::Error> {
        self.card.sync().map_err(LogFileError::Card)
    }
}

fn read_block<D: BlockDevice>(card: &D, index: BlockIdx, block: &mut BlockBytes) -> Result<(), D::Error> {
    let mut one = [Block::new()];
    card.read(&mut one, index)?;
    *block = one[0].contents;
    Ok(())
}

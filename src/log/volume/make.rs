//! Making a log file, a step at a time.
//!
//! A file is one run of clusters that were free in both copies of the table. In this order, each before the next:
//!
//! 1. the file's first block, which says what the file is and where it lies;
//! 2. the entry in the directory;
//! 3. its chain in the first copy of the table, then in the second: at any time one copy is whole.
//!
//! The power may go at any of these. Before the entry is there, nothing has become of the file. After it, the next start
//! finds the file and finishes its chain, which is known from the first block; a file whose chain is whole is only looked
//! at. The markers of the blocks are written ahead of the log ([`LogFile`](super::LogFile)). A torn block of the table is
//! put together from its copies by the next search; a torn block of the directory may take entries with it, whose
//! clusters stay in use.

use embedded_sdmmc::{Block, BlockIdx};

use super::super::block::{BLOCK_LEN, CRC, Region};
use super::directory::{Directory, FileEntry};
use super::fat::Volume;
use super::free_run::{Run, Search};
use super::map::FileMap;
use super::{Card, VolumeError, read_block};

/// Fewest blocks that make a file worth having, when the card has no more: some 50 s at 10 Hz.
pub(super) const FEWEST_BLOCKS: u32 = 100;

/// Blocks of the table that one step writes: some 0.03 s of the bus.
const TABLE_BLOCKS_PER_STEP: u32 = 16;

/// The file to make if there is none to go on with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NewFile {
    /// Partition of the card, 0 to 3. Cards come with one, number 0.
    pub partition: usize,
    /// Size in blocks of 512 bytes, 100 to 8,388,607. A day at 10 Hz takes 172,801. When the card has no free run of that
    /// size, the file gets the longest.
    pub blocks: u32,
    /// A number that is seldom the same, to tell this file's blank blocks from those of earlier files.
    pub nonce: u32,
}

#[derive(Clone, Copy, Debug)]
struct Chaining {
    map: FileMap,
    run: Run,
    copy: u8,
    table_block: u32,
}

#[derive(Debug)]
enum Stage {
    Searching { search: Search, new: NewFile, number: u16 },
    Chaining(Chaining),
}

/// A file that is ready for the log.
#[derive(Clone, Copy, Debug)]
pub struct Ready {
    /// Where it lies.
    pub map: FileMap,
    /// It was made just now: nothing in it is of a log.
    pub is_new: bool,
}

/// A file that is being made, or made good.
#[derive(Debug)]
pub struct Maker {
    volume: Volume,
    is_new: bool,
    stage: Stage,
}

impl Maker {
    /// Look at the card for room. Changes nothing on it.
    pub fn new<D: Card>(card: &D, new: NewFile) -> Result<Self, VolumeError<D::Error>> {
        if !(FEWEST_BLOCKS..=u32::MAX / BLOCK_LEN as u32).contains(&new.blocks) {
            return Err(VolumeError::Size(new.blocks));
        }
        let volume = Volume::find(card, new.partition)?.ok_or(VolumeError::NoVolume)?;
        let directory = Directory::read(card, &volume, |_| ())?;
        let number = directory.next_number().ok_or(VolumeError::TooManyFiles)?;
        let search = Search::new(&volume, new.blocks.div_ceil(volume.cluster_blocks()));
        Ok(Self { volume, is_new: true, stage: Stage::Searching { search, new, number } })
    }

    /// A file that [`FileMap::open_newest`] has found: the power may have gone while it was made.
    pub fn of<D: Card>(card: &D, partition: usize, map: FileMap) -> Result<Self, VolumeError<D::Error>> {
        let volume = Volume::find(card, partition)?.ok_or(VolumeError::NoVolume)?;
        let first = volume.cluster_of(map.first_block()).ok_or(VolumeError::NoVolume)?;
        let run = Run { first, clusters: map.file_blocks().div_ceil(volume.cluster_blocks()) };
        let stage = Stage::Chaining(chaining(&volume, map, run, 0));
        Ok(Self { volume, is_new: false, stage })
    }

    /// Go on; the file when it is ready. A step takes less than 0.1 s, unless the card stalls.
    pub fn step<D: Card>(&mut self, card: &D) -> Result<Option<Ready>, VolumeError<D::Error>> {
        match &mut self.stage {
            Stage::Searching { search, new, number } => {
                if let Some(run) = search.step(card, &self.volume)? {
                    let map = name(card, &self.volume, run, *number, *new)?;
                    self.stage = Stage::Chaining(chaining(&self.volume, map, run, 0));
                }
                Ok(None)
            }
            Stage::Chaining(chaining) => {
                let chaining = *chaining;
                let next = match chain(card, &self.volume, chaining) {
                    // The log needs no chain: of a file that is there it is mended if it can be.
                    Err(_) if !self.is_new => None,
                    next => next?,
                };
                let Some(next) = next else { return Ok(Some(Ready { map: chaining.map, is_new: self.is_new })) };
                self.stage = Stage::Chaining(next);
                Ok(None)
            }
        }
    }
}

fn chaining(volume: &Volume, map: FileMap, run: Run, copy: u8) -> Chaining {
    Chaining { map, run, copy, table_block: run.first / volume.entries_per_block() }
}

/// Some blocks of the chain, where they are not as they shall be; what is left to do.
fn chain<D: Card>(card: &D, volume: &Volume, now: Chaining) -> Result<Option<Chaining>, D::Error> {
    let Chaining { map, run, copy, table_block } = now;
    let per_block = volume.entries_per_block();
    let last = run.first + run.clusters.saturating_sub(1);
    let end = (last / per_block + 1).min(table_block + TABLE_BLOCKS_PER_STEP).min(volume.table_blocks());
    for block in table_block..end {
        chain_block(card, volume, run, copy, block)?;
    }
    if end > table_block && end <= last / per_block {
        return Ok(Some(Chaining { table_block: end, ..now }));
    }
    card.sync()?;
    Ok((copy + 1 < volume.tables()).then(|| chaining(volume, map, run, copy + 1)))
}

fn chain_block<D: Card>(card: &D, volume: &Volume, run: Run, copy: u8, block: u32) -> Result<(), D::Error> {
    let per_block = volume.entries_per_block();
    let last = run.first + run.clusters - 1;
    let mut table = [0; BLOCK_LEN];
    volume.read_table(card, copy, block, &mut table)?;
    let before = table;
    for cluster in (block * per_block).max(run.first)..=last.min(block * per_block + per_block - 1) {
        let next = if cluster == last { volume.end_mark() } else { cluster + 1 };
        volume.set_entry(&mut table, cluster % per_block, next);
    }
    if table == before { Ok(()) } else { volume.write_table(card, copy, block, &table) }
}

/// First block and directory entry of a file in this run.
fn name<D: Card>(
    card: &D,
    volume: &Volume,
    run: Run,
    number: u16,
    new: NewFile,
) -> Result<FileMap, VolumeError<D::Error>> {
    let blocks = new.blocks.min(run.clusters.saturating_mul(volume.cluster_blocks()));
    if blocks < FEWEST_BLOCKS {
        return Err(VolumeError::NoSpace);
    }
    let first = volume.first_block(run.first).ok_or(VolumeError::NoSpace)?;
    // With what lies there mixed in: the first block of an earlier file, perhaps, whose blocks must not look like ours.
    let mut before = [0; BLOCK_LEN];
    read_block(card, BlockIdx(first), &mut before)?;
    let nonce = new.nonce ^ CRC.checksum(&before);
    let map = FileMap::new(Region { file_number: number, nonce }, first, blocks);
    card.write(&[Block { contents: map.encode() }], BlockIdx(first))?;
    card.sync()?;
    let directory = Directory::read(card, volume, |_| ())?;
    let size = blocks * BLOCK_LEN as u32;
    directory.add(card, FileEntry { number, first_cluster: run.first, size })?;
    card.sync()?;
    Ok(map)
}

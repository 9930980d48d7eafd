//! Making a log file, a step at a time.
//!
//! A file is one run of clusters that were free in both copies of the table. In this order, each before the next:
//!
//! 1. its chain in the first copy of the table, then in the second: at any time one copy is whole;
//! 2. the file's first block, which says what the file is and where it lies;
//! 3. the entry in the directory.
//!
//! The power may go at any of these. Before the entry is there nothing has become of it but clusters that no file owns;
//! after it the file is good, since the markers of its blocks are written ahead of the log ([`LogFile`](super::LogFile)).
//! A torn block of the table is put together from its copies by the next search; a torn block of the directory may take
//! entries with it, whose clusters stay in use.

use embedded_sdmmc::{Block, BlockIdx};

use super::super::block::{BLOCK_LEN, Region};
use super::directory::{Directory, FileEntry};
use super::fat::Volume;
use super::free_run::{Run, Search};
use super::map::FileMap;
use super::{Card, VolumeError};

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
    /// A random number, to tell this file's blank blocks from those of earlier files.
    pub nonce: u32,
}

#[derive(Debug)]
enum Stage {
    Searching(Search),
    Chaining { run: Run, copy: u8, table_block: u32 },
    Naming(Run),
}

/// A file that is being made.
#[derive(Debug)]
pub struct Maker {
    volume: Volume,
    new: NewFile,
    number: u16,
    stage: Stage,
}

impl Maker {
    /// Look at the card. Changes nothing on it.
    pub fn new<D: Card>(card: &D, new: NewFile) -> Result<Self, VolumeError<D::Error>> {
        if !(FEWEST_BLOCKS..=u32::MAX / BLOCK_LEN as u32).contains(&new.blocks) {
            return Err(VolumeError::Size(new.blocks));
        }
        let volume = Volume::find(card, new.partition)?.ok_or(VolumeError::NoVolume)?;
        let directory = Directory::read(card, &volume, |_| ())?;
        let number = directory.next_number().ok_or(VolumeError::TooManyFiles)?;
        let clusters = new.blocks.div_ceil(volume.cluster_blocks());
        Ok(Self { volume, new, number, stage: Stage::Searching(Search::new(clusters)) })
    }

    /// Go on; the file when it is made. A step takes less than 0.1 s, unless the card stalls.
    pub fn step<D: Card>(&mut self, card: &D) -> Result<Option<FileMap>, VolumeError<D::Error>> {
        match &mut self.stage {
            Stage::Searching(search) => {
                if let Some(run) = search.step(card, &self.volume)? {
                    if self.blocks(run) < FEWEST_BLOCKS {
                        return Err(VolumeError::NoSpace);
                    }
                    self.stage = self.chaining(run, 0);
                }
            }
            &mut Stage::Chaining { run, copy, table_block } => self.stage = self.chain(card, run, copy, table_block)?,
            &mut Stage::Naming(run) => return self.name(card, run).map(Some),
        }
        Ok(None)
    }

    /// Blocks of the file if it gets this run.
    fn blocks(&self, run: Run) -> u32 {
        self.new.blocks.min(run.clusters.saturating_mul(self.volume.cluster_blocks()))
    }

    fn chaining(&self, run: Run, copy: u8) -> Stage {
        Stage::Chaining { run, copy, table_block: run.first / self.volume.entries_per_block() }
    }

    fn chain<D: Card>(&self, card: &D, run: Run, copy: u8, from: u32) -> Result<Stage, D::Error> {
        let per_block = self.volume.entries_per_block();
        let last = run.first + run.clusters - 1;
        let end = (last / per_block + 1).min(from + TABLE_BLOCKS_PER_STEP);
        let mut table = [0; BLOCK_LEN];
        for block in from..end {
            self.volume.read_table(card, copy, block, &mut table)?;
            let first = (block * per_block).max(run.first);
            for cluster in first..=last.min(block * per_block + per_block - 1) {
                let next = if cluster == last { self.volume.end_mark() } else { cluster + 1 };
                self.volume.set_entry(&mut table, cluster % per_block, next);
            }
            self.volume.write_table(card, copy, block, &table)?;
        }
        if end <= last / per_block {
            return Ok(Stage::Chaining { run, copy, table_block: end });
        }
        card.sync()?;
        Ok(if copy + 1 < self.volume.tables() { self.chaining(run, copy + 1) } else { Stage::Naming(run) })
    }

    fn name<D: Card>(&self, card: &D, run: Run) -> Result<FileMap, VolumeError<D::Error>> {
        let blocks = self.blocks(run);
        let first = self.volume.first_block(run.first).ok_or(VolumeError::NoSpace)?;
        let map = FileMap::new(Region { file_number: self.number, nonce: self.new.nonce }, first, blocks);
        card.write(&[Block { contents: map.encode() }], BlockIdx(first))?;
        card.sync()?;
        // Once more: the card may have been elsewhere since.
        let directory = Directory::read(card, &self.volume, |_| ())?;
        let size = blocks * BLOCK_LEN as u32;
        directory.add(card, FileEntry { number: self.number, first_cluster: run.first, size })?;
        card.sync()?;
        Ok(map)
    }
}

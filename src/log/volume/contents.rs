//! What is on a card, for somebody who is asked whether it is the right one. Changes nothing.

use core::ops::Range;

use super::super::block::BLOCK_LEN;
use super::directory::{self, DELETED, ENTRY_LEN, LONG_NAME, NEVER_USED, each_block};
use super::fat::{FIRST_CLUSTER, Volume, u32_at};
use super::{Card, VolumeError};

/// Attribute bits of an entry that is the volume's label, and of a folder.
const LABEL: u8 = 0x08;
const FOLDER: u8 = 0x10;

/// An entry of the root directory, its name as it is stored: eight bytes and three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RootEntry {
    /// The label of the volume.
    Label([u8; 11]),
    /// A file or a folder.
    Item {
        /// Its short name.
        name: [u8; 11],
        /// Whether it is a folder.
        is_folder: bool,
        /// Whether the body takes it for one of its logs.
        is_log: bool,
        /// In bytes; 0 of a folder.
        size: u32,
    },
}

/// The file system in a partition of a card.
#[derive(Clone, Copy, Debug)]
pub struct Contents(Volume);

impl Contents {
    /// Find it.
    pub fn find<D: Card>(card: &D, partition: usize) -> Result<Self, VolumeError<D::Error>> {
        Volume::find(card, partition)?.map(Self).ok_or(VolumeError::NoVolume)
    }

    /// Whether it is FAT32; else it is FAT16.
    pub fn is_fat32(&self) -> bool {
        self.0.is_fat32()
    }

    /// The first block of the card behind it.
    pub fn end(&self) -> u32 {
        self.0.end()
    }

    /// Call `visit` with what is in the root directory, up to its end as a laptop sees it.
    pub fn each_entry<D: Card>(&self, card: &D, mut visit: impl FnMut(RootEntry)) -> Result<(), D::Error> {
        let mut is_over = false;
        each_block(card, &self.0, |_, block| {
            for entry in block.as_chunks::<ENTRY_LEN>().0 {
                is_over |= entry[0] == NEVER_USED;
                if !is_over {
                    decode(entry).into_iter().for_each(&mut visit);
                }
            }
        })
    }

    /// Call `visit` with each run of blocks that belong to no file, in both copies of the table.
    pub fn each_free_run<D: Card>(&self, card: &D, mut visit: impl FnMut(Range<u32>)) -> Result<(), D::Error> {
        let volume = &self.0;
        let mut run = 0..0;
        for block in 0..volume.table_blocks() {
            let table = volume.read_merged(card, block)?;
            let first = block * volume.entries_per_block();
            for at in (0..volume.entries_per_block()).filter(|at| first + at >= FIRST_CLUSTER) {
                let free = volume.first_block(first + at).filter(|_| volume.entry(&table, at) == 0);
                match free {
                    Some(start) if start == run.end => run.end += volume.cluster_blocks(),
                    Some(start) => {
                        let before = core::mem::replace(&mut run, start..start + volume.cluster_blocks());
                        Some(before).filter(|run| !run.is_empty()).into_iter().for_each(&mut visit);
                    }
                    None => {}
                }
            }
        }
        Some(run).filter(|run| !run.is_empty()).into_iter().for_each(visit);
        Ok(())
    }
}

/// Nothing of a slot that is free, and of a piece of a long name.
fn decode(entry: &[u8; ENTRY_LEN]) -> Option<RootEntry> {
    let attributes = entry[11];
    if entry[0] == DELETED || attributes & LONG_NAME == LONG_NAME {
        return None;
    }
    let name = *entry.first_chunk()?;
    if attributes & LABEL != 0 {
        return Some(RootEntry::Label(name));
    }
    let mut block = [0; BLOCK_LEN];
    block.get_mut(..ENTRY_LEN)?.copy_from_slice(entry);
    let (is_folder, is_log) = (attributes & FOLDER != 0, directory::decode(entry).is_some());
    Some(RootEntry::Item { name, is_folder, is_log, size: u32_at(&block, 28)? })
}

//! A FAT16 or FAT32 volume, read without trusting it.
//!
//! `embedded-sdmmc` keeps the chain of clusters to itself, allocates one cluster at a time, and believes the first copy of
//! the table. So the tables are read and written here: bounded, and every number checked.

use embedded_sdmmc::{Block, BlockIdx};

use super::super::block::{BLOCK_LEN, BlockBytes};
use super::{Card, read_block};

/// The first two entries of a table hold flags that systems set in one copy alone. 8 bytes on FAT32, 4 on FAT16.
const FLAG_ENTRIES: u32 = 2;

/// The first cluster number that is one.
pub(super) const FIRST_CLUSTER: u32 = 2;

/// Below this many clusters it is FAT12, from the second on FAT32.
const FAT16_CLUSTERS: u32 = 4085;
const FAT32_CLUSTERS: u32 = 65525;

/// Where the root directory is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Root {
    /// FAT16: so many blocks from this one on.
    Blocks { first: u32, blocks: u32 },
    /// FAT32: a chain that begins with this cluster.
    Chain(u32),
}

/// Where things are in a FAT16 or FAT32 volume, in blocks of the card.
#[derive(Clone, Copy, Debug)]
pub(super) struct Volume {
    first_table: u32,
    table_blocks: u32,
    tables: u8,
    pub(super) root: Root,
    first_data: u32,
    cluster_blocks: u32,
    clusters: u32,
}

impl Volume {
    /// The volume in a partition, 0 to 3; `None` when it is not one.
    pub(super) fn find<D: Card>(card: &D, partition: usize) -> Result<Option<Self>, D::Error> {
        let mut block = [0; BLOCK_LEN];
        read_block(card, BlockIdx(0), &mut block)?;
        let Some(start) = u32_at(&block, partition.saturating_mul(16).saturating_add(454)) else { return Ok(None) };
        read_block(card, BlockIdx(start), &mut block)?;
        Ok(Self::of_boot_block(&block, start))
    }

    fn of_boot_block(boot: &BlockBytes, start: u32) -> Option<Self> {
        let first_of = |short: Option<u16>, long: Option<u32>| match short? {
            0 => long,
            short => Some(u32::from(short)),
        };
        let cluster_blocks = u32::from(*boot.get(13)?);
        let tables = *boot.get(16)?;
        let root_blocks = u32::from(u16_at(boot, 17)?).div_ceil(16);
        let all_blocks = first_of(u16_at(boot, 19), u32_at(boot, 32))?;
        let table_blocks = first_of(u16_at(boot, 22), u32_at(boot, 36))?;
        let first_table = start.checked_add(u32::from(u16_at(boot, 14)?))?;
        let after_tables = first_table.checked_add(table_blocks.checked_mul(u32::from(tables))?)?;
        let first_data = after_tables.checked_add(root_blocks)?;
        let data_blocks = start.checked_add(all_blocks)?.checked_sub(first_data)?;
        let clusters = data_blocks.checked_div(cluster_blocks)?;
        let root = if clusters >= FAT32_CLUSTERS {
            Root::Chain(u32_at(boot, 44)?)
        } else {
            Root::Blocks { first: after_tables, blocks: root_blocks }
        };
        let volume = Self { first_table, table_blocks, tables, root, first_data, cluster_blocks, clusters };
        (clusters >= FAT16_CLUSTERS && matches!(tables, 1 | 2)).then_some(volume)
    }

    /// Blocks in a cluster.
    pub(super) fn cluster_blocks(&self) -> u32 {
        self.cluster_blocks
    }

    /// Whether it is FAT32; else it is FAT16.
    pub(super) fn is_fat32(&self) -> bool {
        self.clusters >= FAT32_CLUSTERS
    }

    /// The first block behind it.
    pub(super) fn end(&self) -> u32 {
        // Within the size that the boot block says, which was checked.
        self.first_data + self.clusters * self.cluster_blocks
    }

    /// More than 128 MiB.
    pub(super) fn is_large(&self) -> bool {
        self.clusters.saturating_mul(self.cluster_blocks) > 262_144
    }

    /// Copies of the table, one or two.
    pub(super) fn tables(&self) -> u8 {
        self.tables
    }

    /// Blocks of one copy that have entries of clusters.
    pub(super) fn table_blocks(&self) -> u32 {
        self.table_blocks.min((self.clusters + FIRST_CLUSTER).div_ceil(self.entries_per_block()))
    }

    fn entry_len(&self) -> usize {
        if self.is_fat32() { 4 } else { 2 }
    }

    /// Entries in a block of the table.
    pub(super) fn entries_per_block(&self) -> u32 {
        (BLOCK_LEN / self.entry_len()) as u32
    }

    /// The first block of a cluster; `None` when there is no such cluster.
    pub(super) fn first_block(&self, cluster: u32) -> Option<u32> {
        let number = cluster.checked_sub(FIRST_CLUSTER).filter(|&number| number < self.clusters)?;
        // Within the volume, whose end was checked.
        Some(self.first_data + number * self.cluster_blocks)
    }

    /// The cluster that begins with this block.
    pub(super) fn cluster_of(&self, block: u32) -> Option<u32> {
        let number = block.checked_sub(self.first_data)?.checked_div(self.cluster_blocks)?;
        Some(number + FIRST_CLUSTER).filter(|&cluster| self.first_block(cluster) == Some(block))
    }

    /// What marks the last cluster of a chain.
    pub(super) fn end_mark(&self) -> u32 {
        if self.entry_len() == 4 { 0x0FFF_FFFF } else { 0xFFFF }
    }

    /// A block of one copy of the table.
    pub(super) fn read_table<D: Card>(
        &self,
        card: &D,
        copy: u8,
        block: u32,
        to: &mut BlockBytes,
    ) -> Result<(), D::Error> {
        read_block(card, BlockIdx(self.table_block(copy, block)), to)
    }

    /// Write a block of one copy of the table.
    pub(super) fn write_table<D: Card>(
        &self,
        card: &D,
        copy: u8,
        block: u32,
        from: &BlockBytes,
    ) -> Result<(), D::Error> {
        card.write(&[Block { contents: *from }], BlockIdx(self.table_block(copy, block)))
    }

    fn table_block(&self, copy: u8, block: u32) -> u32 {
        self.first_table + u32::from(copy) * self.table_blocks + block
    }

    /// The entry at this place of a block of the table, without the four bits of FAT32 that are reserved.
    pub(super) fn entry(&self, table: &BlockBytes, at: u32) -> u32 {
        let at = at as usize * self.entry_len();
        let entry = if self.entry_len() == 4 { u32_at(table, at) } else { u16_at(table, at).map(u32::from) };
        entry.unwrap_or(0) & 0x0FFF_FFFF
    }

    /// Set it.
    pub(super) fn set_entry(&self, table: &mut BlockBytes, at: u32, entry: u32) {
        let at = at as usize * self.entry_len();
        let bytes = if self.entry_len() == 4 {
            (u32_at(table, at).unwrap_or(0) & 0xF000_0000 | entry).to_le_bytes()
        } else {
            entry.to_le_bytes()
        };
        if let Some(place) = table.get_mut(at..at + self.entry_len()) {
            place.copy_from_slice(bytes.get(..place.len()).unwrap_or_default());
        }
    }

    /// Put the entries of both copies of a block together, into each. Where they differ the power went while one of them was
    /// written, and the other holds what was there before, or all of what was to be there: what looks most like an entry
    /// of a file counts, and what is in use in one of them is in use.
    pub(super) fn merge(&self, block: u32, one: &mut BlockBytes, other: &mut BlockBytes) {
        let first = block.saturating_mul(self.entries_per_block());
        for at in 0..self.entries_per_block() {
            let (a, b) = (self.entry(one, at), self.entry(other, at));
            if a == b || first + at < FLAG_ENTRIES {
                continue;
            }
            let cluster = first + at;
            let merged = if self.likelihood(cluster, b) > self.likelihood(cluster, a) { b } else { a };
            self.set_entry(one, at, merged);
            self.set_entry(other, at, merged);
        }
    }

    /// How much a value looks like the entry of a cluster: of a contiguous file, the end of one, of any file, not free.
    fn likelihood(&self, cluster: u32, entry: u32) -> u8 {
        let is_end = entry >= self.end_mark() - 7;
        match entry {
            0 => 0,
            _ if entry == cluster + 1 && self.first_block(entry).is_some() => 4,
            _ if is_end && entry != self.end_mark() => 3,
            _ if self.first_block(entry).is_some() => 3,
            _ if is_end => 2,
            _ => 1,
        }
    }

    /// A block of the table, put together from its copies.
    pub(super) fn read_merged<D: Card>(&self, card: &D, block: u32) -> Result<BlockBytes, D::Error> {
        let mut one = [0; BLOCK_LEN];
        self.read_table(card, 0, block, &mut one)?;
        if self.tables == 2 {
            let mut other = [0; BLOCK_LEN];
            self.read_table(card, 1, block, &mut other)?;
            self.merge(block, &mut one, &mut other);
        }
        Ok(one)
    }

    /// The cluster after this one in a chain; `None` at its end.
    pub(super) fn next_cluster<D: Card>(&self, card: &D, cluster: u32) -> Result<Option<u32>, D::Error> {
        let (block, at) = (cluster / self.entries_per_block(), cluster % self.entries_per_block());
        let one = self.read_merged(card, block)?;
        Ok(Some(self.entry(&one, at)).filter(|&next| self.first_block(next).is_some()))
    }
}

pub(super) fn u16_at(block: &BlockBytes, at: usize) -> Option<u16> {
    block.get(at..)?.first_chunk().map(|bytes| u16::from_le_bytes(*bytes))
}

pub(super) fn u32_at(block: &BlockBytes, at: usize) -> Option<u32> {
    block.get(at..)?.first_chunk().map(|bytes| u32::from_le_bytes(*bytes))
}

//! What the file system says about a file's blocks, read without trusting it.
//!
//! `embedded-sdmmc` keeps the chain of clusters to itself, and on a chain that a power cut has torn it may overflow.
//! So the chain is walked here: read-only, bounded, and every number checked.

use embedded_sdmmc::{BlockIdx, DirEntry};

use super::super::block::{BLOCK_LEN, BlockBytes};
use super::{Card, read_block};

/// The first two entries of a table hold flags that systems set in one copy alone. 8 bytes on FAT32, 4 on FAT16.
const FLAG_BYTES: usize = 8;

/// The first cluster number that is one.
const FIRST_CLUSTER: u32 = 2;

/// Below this many clusters it is FAT12, from the second on FAT32.
const FAT16_CLUSTERS: u32 = 4085;
const FAT32_CLUSTERS: u32 = 65525;

/// Where things are in a FAT16 or FAT32 volume, in blocks of the card.
#[derive(Clone, Copy, Debug)]
pub(super) struct Volume {
    first_table: u32,
    table_blocks: u32,
    tables: u8,
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
        let volume = Self { first_table, table_blocks, tables, first_data, cluster_blocks, clusters };
        (clusters >= FAT16_CLUSTERS && tables > 0).then_some(volume)
    }

    /// Free clusters; `None` when the copies of the table differ: the power went while it was written, and what looks
    /// free in the first may belong to a file. Reads the whole table.
    pub(super) fn free_clusters<D: Card>(&self, card: &D) -> Result<Option<u32>, D::Error> {
        let (mut one, mut other) = ([0; BLOCK_LEN], [0; BLOCK_LEN]);
        let mut free = 0;
        for block in 0..self.table_blocks {
            let index = self.first_table + block;
            read_block(card, BlockIdx(index), &mut one)?;
            if self.tables == 2 {
                read_block(card, BlockIdx(index + self.table_blocks), &mut other)?;
                let skip = if block == 0 { FLAG_BYTES } else { 0 };
                if one.get(skip..) != other.get(skip..) {
                    return Ok(None);
                }
            }
            free += self.free_in(&one, block);
        }
        Ok(Some(free))
    }

    /// Free clusters in one block of the table, not counting the entries behind the last cluster.
    fn free_in(&self, table: &BlockBytes, block: u32) -> u32 {
        let first = block.saturating_mul(self.entries_per_block());
        let entries = table.chunks_exact(self.entry_len()).zip(first..);
        let free = entries
            .filter(|(entry, cluster)| self.first_block(*cluster).is_some() && entry.iter().all(|&byte| byte == 0));
        free.count() as u32
    }

    /// Blocks in a cluster.
    pub(super) fn cluster_blocks(&self) -> u32 {
        self.cluster_blocks
    }

    fn entry_len(&self) -> usize {
        if self.clusters >= FAT32_CLUSTERS { 4 } else { 2 }
    }

    fn entries_per_block(&self) -> u32 {
        (BLOCK_LEN / self.entry_len()) as u32
    }

    /// Call `visit` with the blocks of a file, in its order, until `blocks` are through. False when the chain ends
    /// before that, leads astray, or `visit` has said false.
    pub(super) fn walk<D: Card>(
        &self,
        card: &D,
        entry: &DirEntry,
        blocks: u32,
        mut visit: impl FnMut(u32) -> bool,
    ) -> Result<bool, D::Error> {
        let mut table = TableCache { index: None, block: [0; BLOCK_LEN] };
        let Some(mut cluster) = first_cluster(card, entry)? else { return Ok(false) };
        let mut left = blocks;
        while let Some(first) = self.first_block(cluster) {
            let here = left.min(self.cluster_blocks);
            if !(first..first + here).all(&mut visit) {
                return Ok(false);
            }
            left -= here;
            if left == 0 {
                return Ok(true);
            }
            cluster = self.next_cluster(card, &mut table, cluster)?;
        }
        Ok(false)
    }

    /// `None` when there is no such cluster.
    fn first_block(&self, cluster: u32) -> Option<u32> {
        let number = cluster.checked_sub(FIRST_CLUSTER).filter(|&number| number < self.clusters)?;
        // Within the volume, whose end was checked.
        Some(self.first_data + number * self.cluster_blocks)
    }

    /// The entry of a valid cluster; an end mark is no valid cluster.
    fn next_cluster<D: Card>(&self, card: &D, table: &mut TableCache, cluster: u32) -> Result<u32, D::Error> {
        let per_block = self.entries_per_block();
        let block = table.read(card, self.first_table.saturating_add(cluster / per_block))?;
        let at = (cluster % per_block) as usize * self.entry_len();
        let next = if self.entry_len() == 4 { u32_at(block, at) } else { u16_at(block, at).map(u32::from) };
        Ok(next.unwrap_or(0) & 0x0FFF_FFFF)
    }
}

/// The block of the table that was last read.
struct TableCache {
    index: Option<u32>,
    block: BlockBytes,
}

impl TableCache {
    fn read<D: Card>(&mut self, card: &D, index: u32) -> Result<&BlockBytes, D::Error> {
        if self.index != Some(index) {
            self.index = None;
            read_block(card, BlockIdx(index), &mut self.block)?;
            self.index = Some(index);
        }
        Ok(&self.block)
    }
}

/// From the directory itself: `embedded-sdmmc` has the number, but does not give it.
fn first_cluster<D: Card>(card: &D, entry: &DirEntry) -> Result<Option<u32>, D::Error> {
    let mut block = [0; BLOCK_LEN];
    read_block(card, entry.entry_block, &mut block)?;
    let at = entry.entry_offset as usize;
    let high = u16_at(&block, at.saturating_add(20));
    let low = u16_at(&block, at.saturating_add(26));
    Ok(high.zip(low).map(|(high, low)| u32::from(high) << 16 | u32::from(low)))
}

fn u16_at(block: &BlockBytes, at: usize) -> Option<u16> {
    block.get(at..)?.first_chunk().map(|bytes| u16::from_le_bytes(*bytes))
}

fn u32_at(block: &BlockBytes, at: usize) -> Option<u32> {
    block.get(at..)?.first_chunk().map(|bytes| u32::from_le_bytes(*bytes))
}

//! Where a new file can lie: the first run of free clusters that is long enough, or the longest.

use super::super::block::BLOCK_LEN;
use super::Card;
use super::fat::{FIRST_CLUSTER, Volume};

/// Blocks of each copy of the table that one step reads: some 0.04 s of the bus.
const BLOCKS_PER_STEP: u32 = 32;

/// What may share an erase block with the directory: 4 MiB, the allocation unit of most cards.
const NEAR_BLOCKS: u32 = 8_192;

/// Consecutive clusters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Run {
    pub(super) first: u32,
    pub(super) clusters: u32,
}

/// A search through the table, a step at a time. A cluster is free when both copies of the table say so. Where the copies
/// differ, they are put together first, one after the other, so that at any time one of them is as it was.
#[derive(Debug)]
pub(super) struct Search {
    wanted: u32,
    /// Where it begins; what lies before that comes last.
    begin: u32,
    /// Blocks of the table that it has read.
    done: u32,
    run: Run,
    longest: Run,
}

impl Search {
    /// For so many clusters; on a large volume away from its first clusters, where the directory is: the card may keep
    /// both in one erase block.
    pub(super) fn new(volume: &Volume, wanted: u32) -> Self {
        let near = if volume.is_large() { NEAR_BLOCKS / volume.cluster_blocks() } else { 0 };
        Self {
            wanted,
            begin: near.div_ceil(volume.entries_per_block()),
            done: 0,
            run: Run::default(),
            longest: Run::default(),
        }
    }

    /// Read on; the run when it is found.
    pub(super) fn step<D: Card>(&mut self, card: &D, volume: &Volume) -> Result<Option<Run>, D::Error> {
        let blocks = volume.table_blocks();
        let end = (self.done + BLOCKS_PER_STEP).min(blocks);
        while self.done < end && self.longest.clusters < self.wanted {
            self.read(card, volume, (self.begin + self.done) % blocks)?;
            self.done += 1;
        }
        let is_over = self.longest.clusters >= self.wanted || self.done >= blocks;
        Ok(is_over.then_some(Run { clusters: self.longest.clusters.min(self.wanted), ..self.longest }))
    }

    fn read<D: Card>(&mut self, card: &D, volume: &Volume, block: u32) -> Result<(), D::Error> {
        if block == 0 {
            // Round the end of the volume nothing goes on.
            self.run = Run::default();
        }
        let (mut one, mut other) = ([0; BLOCK_LEN], [0; BLOCK_LEN]);
        volume.read_table(card, 0, block, &mut one)?;
        if volume.tables() == 2 {
            volume.read_table(card, 1, block, &mut other)?;
            let (first, second) = (one, other);
            volume.merge(block, &mut one, &mut other);
            if one != first {
                volume.write_table(card, 0, block, &one)?;
                card.sync()?;
            }
            if other != second {
                volume.write_table(card, 1, block, &other)?;
                card.sync()?;
            }
        }
        let first = block * volume.entries_per_block();
        for at in 0..volume.entries_per_block() {
            self.count(first + at, volume.first_block(first + at).is_some() && volume.entry(&one, at) == 0);
        }
        Ok(())
    }

    fn count(&mut self, cluster: u32, is_free: bool) {
        if !is_free || cluster < FIRST_CLUSTER {
            self.run = Run::default();
            return;
        }
        if self.run.clusters == 0 {
            self.run.first = cluster;
        }
        self.run.clusters += 1;
        if self.run.clusters > self.longest.clusters {
            self.longest = self.run;
        }
    }
}

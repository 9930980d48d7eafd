//! Which bytes of a card are tried.

use std::ops::Range;

use super::effort::Effort;
use crate::BLOCK_BYTES;

/// Bytes that are written with one call.
pub(super) const CHUNK_BYTES: u64 = 1 << 20;

/// As much as SD's own addresses can tell.
const MOST_BYTES: u64 = 1 << 41;

/// Blocks that are tried in each piece of the rest, in the pages of the operating system.
const SAMPLE_BLOCKS: u64 = 8;

/// Bytes in one piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Extent {
    pub(super) at: u64,
    pub(super) len: usize,
}

/// What is written, in this order.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    /// In one piece: for speed and pauses, too.
    pub(super) dense: Vec<Extent>,
    pub(super) samples: Vec<Extent>,
    /// Whether it reaches over all the free space.
    pub(super) is_whole: bool,
}

impl Plan {
    /// A dense piece, and blocks a stride apart over the rest.
    ///
    /// A card that starts again from its beginning has, for any size of it, a block of the rest that falls into the dense
    /// piece: that piece is a stride long at least. Where files are in the way there may be none; then a block still
    /// reads as what was written to another, unless both were in use.
    pub(super) fn spread(free: &[Range<u32>], effort: &Effort) -> Option<Self> {
        let bytes = |run: &Range<u32>| u64::from(run.start) * BLOCK_BYTES..u64::from(run.end) * BLOCK_BYTES;
        let longest = free.iter().map(bytes).max_by_key(|run| (run.end - run.start, std::cmp::Reverse(run.start)))?;
        let dense = longest.start..longest.end.min(longest.start + effort.dense_bytes.max(effort.stride_bytes));
        let mut samples = Vec::new();
        for run in free.iter().map(bytes) {
            let grid = (run.start.next_multiple_of(effort.stride_bytes)..run.end).step_by(effort.stride_bytes as usize);
            // The last blocks of each piece too: that of the last piece is the card's end.
            let last = run.end.saturating_sub(SAMPLE_BLOCKS * BLOCK_BYTES).max(run.start);
            for at in grid.filter(|&at| at < last).chain([last]).filter(|at| !dense.contains(at)) {
                samples.push(Extent { at, len: (run.end - at).min(SAMPLE_BLOCKS * BLOCK_BYTES) as usize });
            }
        }
        Some(Self { dense: chunks(dense), samples, is_whole: true })
    }

    /// All of a folder, or so many bytes of it. One that does not say how much it has is filled until it is full.
    pub(super) fn filling(free_bytes: Option<u64>, most_bytes: u64) -> Option<Self> {
        let free_bytes = free_bytes.unwrap_or(MOST_BYTES);
        let bytes = free_bytes.min(most_bytes) / CHUNK_BYTES * CHUNK_BYTES;
        let is_whole = free_bytes <= most_bytes;
        (bytes > 0).then(|| Self { dense: chunks(0..bytes), samples: Vec::new(), is_whole })
    }

    pub(super) fn extents(&self) -> impl Iterator<Item = Extent> {
        self.dense.iter().chain(&self.samples).copied()
    }

    /// Bytes of all of them.
    pub(super) fn bytes(&self) -> u64 {
        self.extents().map(|extent| extent.len as u64).sum()
    }

    /// Where a sector is written in small writes, and its copy: the two halves of the dense piece.
    pub(super) fn small_write(&self, number: usize) -> [u64; 2] {
        let first = self.dense.first().map_or(0, |extent| extent.at);
        let end = self.dense.last().map_or(first, |extent| extent.at + extent.len as u64);
        let half = ((end - first) / 2 / BLOCK_BYTES).max(1);
        let at = first + number as u64 % half * BLOCK_BYTES;
        [at, (at + half * BLOCK_BYTES).min(end.saturating_sub(BLOCK_BYTES))]
    }
}

fn chunks(bytes: Range<u64>) -> Vec<Extent> {
    let piece = |at: u64| Extent { at, len: (bytes.end - at).min(CHUNK_BYTES) as usize };
    bytes.clone().step_by(CHUNK_BYTES as usize).map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const EFFORT: Effort = Effort { dense_bytes: 1 << 20, stride_bytes: 1 << 20, ..Effort::QUICK };

    #[test]
    fn whatever_a_card_really_holds_a_sample_falls_into_the_dense_piece() {
        // 64 MiB of free space behind 100 blocks.
        let plan = Plan::spread(std::slice::from_ref(&(100..131_072)), &EFFORT).unwrap();
        let dense = plan.dense[0].at..plan.dense[0].at + (1 << 20);
        for blocks in (2_148..128_000).step_by(509) {
            let real_bytes = blocks * BLOCK_BYTES;
            let hit = plan.samples.iter().any(|sample| dense.contains(&(sample.at % real_bytes)));
            assert!(hit, "{blocks} blocks");
        }
    }

    #[test]
    fn only_free_space_is_in_it_and_nothing_twice() {
        let free = [10..20, 5_000..9_000, 20_000..20_003, 30_000..64_000];
        let plan = Plan::spread(&free, &EFFORT).unwrap();
        let mut blocks: Vec<u64> =
            plan.extents().flat_map(|Extent { at, len }| at / 512..(at + len as u64) / 512).collect();
        assert!(blocks.iter().all(|&block| free.iter().any(|run| run.contains(&(block as u32)))));
        let count = blocks.len();
        blocks.sort_unstable();
        blocks.dedup();
        assert_eq!(blocks.len(), count);
        assert!(blocks.contains(&63_999) && blocks.contains(&20_002));
    }

    #[test]
    fn nothing_free_is_no_plan() {
        assert!(Plan::spread(&[], &EFFORT).is_none());
        assert!(Plan::filling(Some(100), u64::MAX).is_none());
    }

    #[test]
    fn a_part_of_a_folder_is_not_the_whole() {
        let is_whole = |free, most| Plan::filling(free, most).unwrap().is_whole;
        assert!(is_whole(Some(5 << 20), 6 << 20) && !is_whole(Some(7 << 20), 6 << 20) && !is_whole(None, 6 << 20));
    }

    #[test]
    fn small_writes_stay_within_the_dense_piece() {
        let plan = Plan::spread(std::slice::from_ref(&(100..110)), &EFFORT).unwrap();
        for number in 0..30 {
            assert!(plan.small_write(number).iter().all(|at| (100 * 512..110 * 512).contains(at)));
        }
    }
}

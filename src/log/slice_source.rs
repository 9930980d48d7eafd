//! An image of a card in memory.

use super::block::{BLOCK_LEN, BlockBytes, BlockSource};
use super::sector::Sector;

/// Blocks in memory, such as an image of a card. A tail of less than a block is left out.
#[derive(Clone, Copy, Debug)]
pub struct SliceSource<'a>(pub &'a [u8]);

impl<'a> SliceSource<'a> {
    /// The same bytes from the first intact sector on, at whatever offset it starts: for a dump that was cut anywhere.
    pub fn aligned_to_sectors(bytes: &'a [u8]) -> Self {
        let starts_here =
            |rest: &[u8]| rest.first_chunk::<BLOCK_LEN>().is_some_and(|block| Sector::parse(block).is_ok());
        let start = (0..bytes.len()).find(|&start| bytes.get(start..).is_some_and(starts_here)).unwrap_or(0);
        Self(bytes.get(start % BLOCK_LEN..).unwrap_or_default())
    }
}

/// There is no block at this position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfBounds;

impl BlockSource for SliceSource<'_> {
    type Error = OutOfBounds;

    fn blocks(&self) -> u32 {
        u32::try_from(self.0.len() / BLOCK_LEN).unwrap_or(u32::MAX)
    }

    fn read(&mut self, position: u32, block: &mut BlockBytes) -> Result<(), OutOfBounds> {
        let start = (position as usize).checked_mul(BLOCK_LEN).ok_or(OutOfBounds)?;
        let found = self.0.get(start..).and_then(|rest| rest.first_chunk::<BLOCK_LEN>()).ok_or(OutOfBounds)?;
        *block = *found;
        Ok(())
    }
}

//! A store as the card that the body's code knows.

use std::io;

use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};
use towmag::log::Card;

use crate::{BLOCK_BYTES, Store};

/// A card whose blocks are read from a store and written to it at once.
#[derive(Debug)]
pub(crate) struct OnStore<'a, S>(pub(crate) &'a S);

impl<S: Store> BlockDevice for OnStore<'_, S> {
    type Error = io::Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> io::Result<()> {
        blocks
            .iter_mut()
            .zip(u64::from(start.0)..)
            .try_for_each(|(block, index)| self.0.read(index * BLOCK_BYTES, &mut block.contents))
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> io::Result<()> {
        blocks
            .iter()
            .zip(u64::from(start.0)..)
            .try_for_each(|(block, index)| self.0.write(index * BLOCK_BYTES, &block.contents))
    }

    fn num_blocks(&self) -> io::Result<BlockCount> {
        Ok(BlockCount(u32::try_from(self.0.blocks()).unwrap_or(u32::MAX)))
    }
}

impl<S: Store> Card for OnStore<'_, S> {
    fn sync(&self) -> io::Result<()> {
        self.0.sync()
    }
}

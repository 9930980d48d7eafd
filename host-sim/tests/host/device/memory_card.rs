//! A card in memory.

use std::convert::Infallible;

use towmag::log::{BlockBytes, BlockSink, BlockSource, Region, blank_block};

/// A card in memory.
pub(crate) struct Card(pub(crate) Vec<BlockBytes>, Region);

impl Card {
    /// Blank blocks of a log file.
    pub(crate) fn new(file_number: u16, blocks: u32) -> Self {
        let region = Region { file_number, nonce: 0x5EED };
        Self((0..blocks).map(|position| blank_block(region, position)).collect(), region)
    }
}

impl BlockSource for Card {
    type Error = Infallible;

    fn blocks(&self) -> u32 {
        self.0.len() as u32
    }

    fn read(&mut self, position: u32, block: &mut BlockBytes) -> Result<(), Infallible> {
        *block = self.0[position as usize];
        Ok(())
    }
}

impl BlockSink for Card {
    fn region(&self) -> Region {
        self.1
    }

    fn write(&mut self, position: u32, block: &BlockBytes) -> Result<(), Infallible> {
        self.0[position as usize] = *block;
        Ok(())
    }

    fn sync(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

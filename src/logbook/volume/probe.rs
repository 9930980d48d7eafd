//! A device between the file system and the card that notes where things are.

use core::cell::{Cell, RefCell};

use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};

use super::super::block::{Region, blank_block};
use super::map::FileMap;

/// What passed through a [`Probe`].
pub(super) struct Trace {
    /// The block that was last read.
    pub(super) last_read: Cell<Option<BlockIdx>>,
    /// Blocks that got the next marker of the file that is being made.
    pub(super) map: RefCell<FileMap>,
}

impl Trace {
    /// Notes the markers of this region.
    pub(super) fn new(region: Region) -> Self {
        Self { last_read: Cell::new(None), map: RefCell::new(FileMap::empty(region)) }
    }

    /// File block `n` carries the marker of position `n - 1`, wrapping: see [`file_block`].
    fn note(&self, block: &Block, index: BlockIdx) {
        let mut map = self.map.borrow_mut();
        if block.contents == file_block(map.region(), map.file_blocks()) {
            // A file in too many pieces comes out short, and is refused for that.
            map.add(index.0);
        }
    }
}

/// What block `block` of a file holds when it is made: the marker of its position in the region, which does not
/// include the file's first block.
pub(super) fn file_block(region: Region, block: u32) -> [u8; 512] {
    blank_block(region, block.wrapping_sub(1))
}

/// Passes everything on to the card.
pub(super) struct Probe<'a, D> {
    pub(super) card: &'a D,
    pub(super) trace: &'a Trace,
}

impl<D: BlockDevice> BlockDevice for Probe<'_, D> {
    type Error = D::Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), Self::Error> {
        self.trace.last_read.set(Some(start));
        self.card.read(blocks, start)
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), Self::Error> {
        self.card.write(blocks, start)?;
        for (block, index) in blocks.iter().zip(start.0..) {
            self.trace.note(block, BlockIdx(index));
        }
        Ok(())
    }

    fn num_blocks(&self) -> Result<BlockCount, Self::Error> {
        self.card.num_blocks()
    }
}

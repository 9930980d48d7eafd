//! What a log file is, and which blocks of the card it owns.

use super::super::block::{BLOCK_LEN, BlockBytes, Region, crc_fits, put_crc};
use crate::bytes::{Put, Take};

const MAGIC: [u8; 8] = *b"TOWMAGLF";

/// Version of the layout of a file. A file of version 1 had one copy of each sector; it is read, and not gone on with.
const LAYOUT_VERSION: u8 = 2;

/// Identity of a log file, and where it lies: in one piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileMap {
    region: Region,
    first_block: u32,
    blocks: u32,
}

impl FileMap {
    /// A file of so many blocks from this block of the card on.
    pub(super) fn new(region: Region, first_block: u32, blocks: u32) -> Self {
        Self { region, first_block, blocks }
    }

    /// Identity of the region.
    pub fn region(&self) -> Region {
        self.region
    }

    /// Block of the card that the file begins with.
    pub fn first_block(&self) -> u32 {
        self.first_block
    }

    /// Blocks of the file.
    pub fn file_blocks(&self) -> u32 {
        self.blocks
    }

    /// Places for sectors: half of the blocks but the first, since each sector is written twice.
    pub fn places(&self) -> u32 {
        self.blocks.saturating_sub(1) / 2
    }

    /// Block of the card that holds this position of the region; `None` beyond its end. Positions from
    /// [`places`](Self::places) on are those of the second copies.
    pub fn locate(&self, position: u32) -> Option<u32> {
        (position < 2 * self.places()).then(|| self.first_block + 1 + position)
    }

    /// The first block of the file.
    pub(super) fn encode(&self) -> BlockBytes {
        let mut block = [0; BLOCK_LEN];
        let mut put = Put::new(&mut block);
        put.bytes(&MAGIC);
        put.u8(LAYOUT_VERSION);
        put.u8(0);
        put.u16(self.region.file_number);
        put.u32(self.region.nonce);
        put.u32(self.blocks);
        put.u32(1);
        put.u32(self.first_block);
        put.u32(self.blocks);
        put_crc(&mut block);
        block
    }

    /// What [`encode`](Self::encode) made; `None` when it is anything else.
    pub(super) fn decode(block: &BlockBytes) -> Option<Self> {
        let mut take = Take(block.strip_prefix(&MAGIC)?);
        if !crc_fits(block) || take.u8()? != LAYOUT_VERSION {
            return None;
        }
        take.u8()?;
        let region = Region { file_number: take.u16()?, nonce: take.u32()? };
        let (blocks, pieces) = (take.u32()?, take.u32()?);
        let (first_block, in_piece) = (take.u32()?, take.u32()?);
        let is_sound = pieces == 1 && in_piece == blocks && first_block.checked_add(blocks).is_some();
        is_sound.then_some(Self { region, first_block, blocks })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAP: FileMap =
        FileMap { region: Region { file_number: 7, nonce: 0xDEAD_BEEF }, first_block: 100, blocks: 12 };

    #[test]
    fn each_place_has_two_blocks() {
        assert_eq!((MAP.file_blocks(), MAP.places()), (12, 5));
        assert_eq!(MAP.locate(0), Some(101));
        assert_eq!(MAP.locate(9), Some(110));
        assert_eq!(MAP.locate(10), None);
        assert_eq!(MAP.locate(u32::MAX), None);
    }

    #[test]
    fn first_block_returns_the_map() {
        assert_eq!(FileMap::decode(&MAP.encode()), Some(MAP));
    }

    #[test]
    fn damage_is_refused() {
        let whole = MAP.encode();
        for i in 0..BLOCK_LEN {
            let mut block = whole;
            block[i] ^= 0x10;
            assert_eq!(FileMap::decode(&block), None, "byte {i}");
        }
    }
}

//! Which blocks of the card a file owns.

use super::super::block::{BLOCK_LEN, BlockBytes, Region, crc_fits, put_crc};
use super::super::sector::FORMAT_VERSION;
use crate::bytes::{Put, Take};

/// Most pieces that a file may lie in. On a card that is formatted before use it is one.
pub const MAX_EXTENTS: usize = 32;

const MAGIC: [u8; 8] = *b"TOWMAGLF";

/// Consecutive blocks of the card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// The first, counted from the start of the card.
    pub first_block: u32,
    /// How many.
    pub blocks: u32,
}

/// Identity of a log file, and where it lies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileMap {
    region: Region,
    blocks: u32,
    extents: heapless::Vec<Extent, MAX_EXTENTS>,
}

impl FileMap {
    /// A file without blocks, to be filled with [`add`](Self::add).
    pub(super) fn empty(region: Region) -> Self {
        Self { region, blocks: 0, extents: heapless::Vec::new() }
    }

    /// The file's next block; false when it lies in too many pieces.
    pub(super) fn add(&mut self, block: u32) -> bool {
        let fits = match self.extents.last_mut() {
            Some(last) if last.first_block.checked_add(last.blocks) == Some(block) => {
                last.blocks += 1;
                true
            }
            _ => self.extents.push(Extent { first_block: block, blocks: 1 }).is_ok(),
        };
        self.blocks += u32::from(fits);
        fits
    }

    /// Identity of the region.
    pub fn region(&self) -> Region {
        self.region
    }

    /// Blocks of the file.
    pub fn file_blocks(&self) -> u32 {
        self.blocks
    }

    /// Blocks that the log can use: all but the first.
    pub fn region_blocks(&self) -> u32 {
        self.blocks.saturating_sub(1)
    }

    /// The pieces of the file, in its order.
    pub fn extents(&self) -> &[Extent] {
        &self.extents
    }

    /// Block of the card that holds this position of the region; `None` beyond its end.
    pub fn locate(&self, position: u32) -> Option<u32> {
        self.locate_in_file(position.checked_add(1)?)
    }

    /// Block of the card that holds this block of the file.
    pub(super) fn locate_in_file(&self, mut block: u32) -> Option<u32> {
        for extent in &self.extents {
            if block < extent.blocks {
                return extent.first_block.checked_add(block);
            }
            block -= extent.blocks;
        }
        None
    }

    /// All blocks of the card that the file owns, in its order.
    pub(super) fn card_blocks(&self) -> impl Iterator<Item = u32> {
        self.extents.iter().flat_map(|extent| extent.first_block..extent.first_block.saturating_add(extent.blocks))
    }

    /// The first block of the file.
    pub(super) fn encode(&self) -> BlockBytes {
        let mut block = [0; BLOCK_LEN];
        let mut put = Put::new(&mut block);
        put.bytes(&MAGIC);
        put.u8(FORMAT_VERSION);
        put.u8(0);
        put.u16(self.region.file_number);
        put.u32(self.region.nonce);
        put.u32(self.blocks);
        put.u32(self.extents.len() as u32);
        for extent in &self.extents {
            put.u32(extent.first_block);
            put.u32(extent.blocks);
        }
        put_crc(&mut block);
        block
    }

    /// What [`encode`](Self::encode) made; `None` when it is anything else.
    pub(super) fn decode(block: &BlockBytes) -> Option<Self> {
        let mut take = Take(block.strip_prefix(&MAGIC)?);
        if !crc_fits(block) || take.u8()? != FORMAT_VERSION {
            return None;
        }
        take.u8()?;
        let region = Region { file_number: take.u16()?, nonce: take.u32()? };
        let (blocks, extents) = (take.u32()?, take.u32()?);
        let mut map = Self { region, blocks, extents: heapless::Vec::new() };
        for _ in 0..extents {
            map.extents.push(Extent { first_block: take.u32()?, blocks: take.u32()? }).ok()?;
        }
        map.is_sound().then_some(map)
    }

    /// Whether the extents are as many blocks as the file has, and end on any card.
    fn is_sound(&self) -> bool {
        let mut total: u32 = 0;
        self.extents.iter().all(|extent| {
            let sum = total.checked_add(extent.blocks);
            total = sum.unwrap_or(0);
            sum.is_some() && extent.blocks > 0 && extent.first_block.checked_add(extent.blocks).is_some()
        }) && total == self.blocks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REGION: Region = Region { file_number: 7, nonce: 0xDEAD_BEEF };

    fn of_blocks(blocks: impl IntoIterator<Item = u32>) -> FileMap {
        let mut map = FileMap::empty(REGION);
        blocks.into_iter().for_each(|block| assert!(map.add(block)));
        map
    }

    #[test]
    fn blocks_gather_into_extents() {
        let map = of_blocks((100..110).chain(200..203).chain(150..151));
        assert_eq!(map.extents().len(), 3);
        assert_eq!((map.file_blocks(), map.region_blocks()), (14, 13));
        assert_eq!(map.locate(0), Some(101));
        assert_eq!(map.locate(8), Some(109));
        assert_eq!(map.locate(9), Some(200));
        assert_eq!(map.locate(12), Some(150));
        assert_eq!(map.locate(13), None);
        assert_eq!(map.locate(u32::MAX), None);
    }

    #[test]
    fn first_block_returns_the_map() {
        let map = of_blocks((0..32).map(|i| i * 2));
        assert_eq!(FileMap::decode(&map.encode()), Some(map));
    }

    #[test]
    fn too_many_pieces_are_refused() {
        let mut map = of_blocks((0..32).map(|i| i * 2));
        assert!(!map.add(1000));
        assert_eq!(map.file_blocks(), 32);
    }

    #[test]
    fn damage_is_refused() {
        let whole = of_blocks(100..110).encode();
        for i in 0..BLOCK_LEN {
            let mut block = whole;
            block[i] ^= 0x10;
            assert_eq!(FileMap::decode(&block), None, "byte {i}");
        }
    }
}

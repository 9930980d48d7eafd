//! What the log needs of a storage device, and how a block looks that is free for it.

use crc::{CRC_32_ISO_HDLC, Crc};

use crate::bytes::Put;

/// Bytes in a block, as on every SD card.
pub const BLOCK_LEN: usize = 512;

/// The bytes of one block.
pub type BlockBytes = [u8; BLOCK_LEN];

/// The CRC of sectors, markers and file headers: that of Ethernet and zip.
pub(super) const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Bytes of a block before the CRC in its last four.
const CRC_OFFSET: usize = BLOCK_LEN - 4;

/// Blocks that can be read by position: a region of a card, a whole card, a file or an image on a host.
pub trait BlockSource {
    /// What can go wrong with the device.
    type Error;

    /// Number of blocks; positions go from 0 to one below.
    fn blocks(&self) -> u32;

    /// Read the block at `position`.
    fn read(&mut self, position: u32, block: &mut BlockBytes) -> Result<(), Self::Error>;
}

/// A region of blocks that the log may write, each of which started out as [`blank_block`].
pub trait BlockSink: BlockSource {
    /// Which region this is.
    fn region(&self) -> Region;

    /// Write the block at `position`. After an error its content may be old, new, or neither.
    fn write(&mut self, position: u32, block: &BlockBytes) -> Result<(), Self::Error>;

    /// Return when everything written so far would survive a power cut.
    fn sync(&mut self) -> Result<(), Self::Error>;
}

/// The identity of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Number of the log file on its card, 1 to 99.
    pub file_number: u16,
    /// Random number drawn when the region was created: tells its blank blocks from those of an earlier file.
    pub nonce: u32,
}

const BLANK_MAGIC: [u8; 8] = *b"TOWMAGFR";

/// What an unused block at `position` holds: `"TOWMAGFR", nonce u32, position u32, zeros, crc u32`.
///
/// The writer writes nowhere else. Whatever goes wrong about its idea of where the log ends or which blocks the file
/// owns, it cannot overwrite a sector, another file, or the card that was swapped in.
pub fn blank_block(region: Region, position: u32) -> BlockBytes {
    let mut block = [0; BLOCK_LEN];
    let mut put = Put::new(&mut block);
    put.bytes(&BLANK_MAGIC);
    put.u32(region.nonce);
    put.u32(position);
    put_crc(&mut block);
    block
}

/// Whether a block is one of [`blank_block`], of any region.
pub(super) fn is_blank(block: &BlockBytes) -> bool {
    block.starts_with(&BLANK_MAGIC) && crc_fits(block)
}

/// Close a block with the CRC over all the rest of it.
pub(super) fn put_crc(block: &mut BlockBytes) {
    if let Some((content, crc)) = block.split_last_chunk_mut::<4>() {
        *crc = CRC.checksum(content).to_le_bytes();
    }
}

/// Whether the last four bytes of a block are the CRC of the rest.
pub(super) fn crc_fits(block: &BlockBytes) -> bool {
    let (content, crc) = block.split_at(CRC_OFFSET);
    CRC.checksum(content).to_le_bytes() == *crc
}

/// Blocks in memory, such as an image of a card. A tail of less than a block is left out.
#[derive(Clone, Copy, Debug)]
pub struct SliceSource<'a>(pub &'a [u8]);

impl<'a> SliceSource<'a> {
    /// The same bytes from the first intact sector on, at whatever offset it starts: for a dump that was cut anywhere.
    pub fn aligned_to_sectors(bytes: &'a [u8]) -> Self {
        let starts_here =
            |rest: &[u8]| rest.first_chunk::<BLOCK_LEN>().is_some_and(|block| super::Sector::parse(block).is_ok());
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

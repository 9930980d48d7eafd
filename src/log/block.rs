//! What the log needs of a storage device, and the marker of a block that is free for it.

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

    /// Whether the block at `position` can be read back as this, from every place that it was written to.
    fn holds(&mut self, position: u32, block: &BlockBytes) -> Result<bool, Self::Error> {
        let mut found = [0; BLOCK_LEN];
        self.read(position, &mut found)?;
        Ok(found == *block)
    }
}

/// The identity of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Number of the log file on its card, 1 to 99.
    pub file_number: u16,
    /// Random number drawn when the region was created: tells its blank blocks from those of an earlier file.
    pub nonce: u32,
}

impl Region {
    /// What a sector carries of the nonce, to tell it from those of an earlier file with the same number.
    pub(super) fn tag(&self) -> u16 {
        (self.nonce ^ self.nonce >> 16) as u16
    }
}

const BLANK_MAGIC: [u8; 8] = *b"TOWMAGFR";
const BLANK_HEAD_LEN: usize = 16;

/// What an unused block at `position` holds: `"TOWMAGFR", nonce u32, position u32, zeros, crc u32`.
///
/// The writer writes to such blocks alone. So even with a wrong idea of where the log ends, or of which blocks the file
/// owns, it cannot overwrite a sector, another file, or a card that was swapped in.
pub fn blank_block(region: Region, position: u32) -> BlockBytes {
    let mut block = [0; BLOCK_LEN];
    let mut put = Put::new(&mut block);
    put.bytes(&BLANK_MAGIC);
    put.u32(region.nonce);
    put.u32(position);
    put_crc(&mut block);
    block
}

/// Whether a block is the [`blank_block`] of this place. Without its CRC, which costs as much as all the rest of storing a
/// sector: what says region and position, and is zero but for its last four bytes, is nothing else.
pub(super) fn is_blank_at(region: Region, position: u32, block: &BlockBytes) -> bool {
    let mut head = [0; BLANK_HEAD_LEN];
    let mut put = Put::new(&mut head);
    put.bytes(&BLANK_MAGIC);
    put.u32(region.nonce);
    put.u32(position);
    let rest = block.get(BLANK_HEAD_LEN..CRC_OFFSET).unwrap_or_default();
    block.starts_with(&head) && rest.as_chunks::<4>().0.iter().all(|word| *word == [0; 4])
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

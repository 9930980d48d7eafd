//! Blocks that say which they are: so one that is read in the place of another tells where it was written.

use crate::BLOCK_BYTES;

const MAGIC: [u8; 8] = *b"TOWMAGTS";

/// Fill bytes that begin at this byte of the card.
pub(super) fn stamp(seed: u64, at: u64, bytes: &mut [u8]) {
    for (block, index) in bytes.as_chunks_mut::<512>().0.iter_mut().zip(at / BLOCK_BYTES..) {
        let mut noise = seed ^ index.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        for word in block.as_chunks_mut::<8>().0 {
            // xorshift: bytes that no card can compress, and no two blocks share.
            noise ^= noise << 13;
            noise ^= noise >> 7;
            noise ^= noise << 17;
            *word = noise.to_le_bytes();
        }
        block[..8].copy_from_slice(&MAGIC);
        block[8..16].copy_from_slice(&seed.to_le_bytes());
        block[16..24].copy_from_slice(&index.to_le_bytes());
    }
}

/// Where a block was written, if it was in this trial.
pub(super) fn written_at(seed: u64, block: &[u8; 512]) -> Option<u64> {
    let word = |at: usize| block.get(at..)?.first_chunk().map(|bytes| u64::from_le_bytes(*bytes));
    let is_ours = block.starts_with(&MAGIC) && word(8) == Some(seed);
    word(16).filter(|_| is_ours)
}

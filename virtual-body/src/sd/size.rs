//! How a card tells its size.

use super::answers::CRC7;
use super::card::Capacity;

/// The register that tells how large a card is (Physical Layer Specification 5.3): as many blocks as it can say, no more
/// than there are. Beside the size only what every card has.
pub(super) fn card_specific_data(capacity: Capacity, blocks: u32) -> [u8; 16] {
    let size = match capacity {
        Capacity::High => 1 << 126 | u128::from((blocks / 1024).saturating_sub(1)) << 48,
        Capacity::Standard => {
            // 2^(multiplier + 2) blocks a unit, 4,096 units at most.
            let multiplier = (0_u32..7).find(|multiplier| blocks >> (multiplier + 2) <= 4_096).unwrap_or(7);
            let units = (blocks >> (multiplier + 2)).clamp(1, 4_096);
            u128::from(units - 1) << 62 | u128::from(multiplier) << 47
        }
    };
    const BLOCK_OF_512: u128 = 9;
    let usual = 0x0e << 112 | 0x32 << 96 | 0x5b5 << 84 | BLOCK_OF_512 << 80 | 1 << 46 | BLOCK_OF_512 << 22;
    let mut bytes = (size | usual).to_be_bytes();
    bytes[15] = CRC7.checksum(&bytes[..15]) << 1 | 1;
    bytes
}

//! What a card answers with, and the checks on what it is sent.

use super::card::Capacity;
use crc::{CRC_7_MMC, CRC_16_XMODEM, Crc, Table};

const CRC7: Crc<u8, Table<1>> = Crc::<u8, Table<1>>::new(&CRC_7_MMC);
const CRC16: Crc<u16, Table<16>> = Crc::<u16, Table<16>>::new(&CRC_16_XMODEM);

/// First answer byte: in the idle state.
pub(super) const IDLE: u8 = 0x01;
/// First answer byte: the command is not known, or not now.
pub(super) const ILLEGAL: u8 = 0x04;
/// First answer byte: the command's CRC is wrong.
pub(super) const BAD_CRC: u8 = 0x08;
/// First answer byte: there is no such block.
pub(super) const BAD_ADDRESS: u8 = 0x20;

/// Before the data of a block that is read or written alone.
pub(super) const TOKEN: u8 = 0xfe;
/// Before the data of each of several blocks that are written.
pub(super) const TOKEN_OF_SEVERAL: u8 = 0xfc;
/// After several blocks.
pub(super) const STOP_TOKEN: u8 = 0xfd;
/// In place of data: the card's ECC has failed.
pub(super) const ERROR_TOKEN: u8 = 0x04;

/// To a block that was sent: accepted.
pub(super) const ACCEPTED: u8 = 0x05;
/// To a block that was sent: its CRC is wrong.
pub(super) const DATA_CRC: u8 = 0x0b;
/// To a block that was sent: not written.
pub(super) const NOT_WRITTEN: u8 = 0x0d;

/// Whether the last byte of a command is the CRC of the others.
pub(super) fn command_crc_fits(command: &[u8; 6]) -> bool {
    CRC7.checksum(&command[..5]) << 1 | 1 == command[5]
}

/// The CRC of a block.
pub(super) fn data_crc(data: &[u8]) -> [u8; 2] {
    CRC16.checksum(data).to_be_bytes()
}

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

//! What a card answers with, and the checks on what it is sent.

use crc::{CRC_7_MMC, CRC_16_XMODEM, Crc, Table};

pub(super) const CRC7: Crc<u8, Table<1>> = Crc::<u8, Table<1>>::new(&CRC_7_MMC);
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

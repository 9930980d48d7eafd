//! Frames: 24-bit words, the content of each 16-bit word in the upper two bytes (data sheet sections 8.5.1.7 and 8.5.1.8).

use super::registers::Register;
use crc::{CRC_16_IBM_3740, Crc};

/// Response, four channels and CRC, three bytes each.
pub const FRAME_BYTES: usize = 18;

/// CRC-16-CCITT, polynomial 1021, seed FFFF, most significant bit first, over all bytes with their padding.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// What a frame asks the converter to do (data sheet section 8.5.1.10).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Nothing; answered with STATUS.
    Null,
    /// Reset; answered with FF24. Works only in a whole frame.
    Reset,
    /// Take no command but NULL, RREG and UNLOCK.
    Lock,
    /// Take all commands again.
    Unlock,
    /// Stop converting and save power.
    Standby,
    /// Convert again.
    Wakeup,
    /// Read one register; answered with its content.
    Read(Register),
    /// Write one register; answered with [`Command::acknowledgement`].
    Write(Register, u16),
}

impl Command {
    /// The command word.
    pub fn word(self) -> u16 {
        match self {
            Self::Null => 0x0000,
            Self::Reset => 0x0011,
            Self::Standby => 0x0022,
            Self::Wakeup => 0x0033,
            Self::Lock => 0x0555,
            Self::Unlock => 0x0655,
            Self::Read(register) => 0xA000 | (register as u16) << 7,
            Self::Write(register, _) => 0x6000 | (register as u16) << 7,
        }
    }

    /// The response to a register write, 010a aaaa a000 0000. Other commands have none of this form.
    pub fn acknowledgement(self) -> u16 {
        self.word() & 0x1FFF | 0x4000
    }
}

/// The frame that sends a command. The CRC over the command words is always there: the converter ignores it until
/// RX_CRC_EN is set, and demands it afterwards, also from a microcontroller that has restarted meanwhile.
pub fn encode(command: Command) -> [u8; FRAME_BYTES] {
    let mut bytes = [0; FRAME_BYTES];
    let [high, low] = command.word().to_be_bytes();
    [bytes[0], bytes[1]] = [high, low];
    if let Command::Write(_, value) = command {
        [bytes[3], bytes[4]] = value.to_be_bytes();
        [bytes[6], bytes[7]] = CRC.checksum(&bytes[..6]).to_be_bytes();
    } else {
        [bytes[3], bytes[4]] = CRC.checksum(&bytes[..3]).to_be_bytes();
    }
    bytes
}

/// A frame from the converter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AdcFrame {
    /// Response to the command of the frame before.
    pub response: u16,
    /// The four channels, -8,388,608 to 8,388,607.
    pub counts: [i32; 4],
}

/// A frame whose CRC does not fit its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AdcFrameCrcError {
    /// The CRC in the frame.
    pub received: u16,
    /// The CRC of what the frame holds.
    pub computed: u16,
}

impl AdcFrame {
    /// Check the CRC and take the frame apart.
    pub fn decode(bytes: &[u8; FRAME_BYTES]) -> Result<Self, AdcFrameCrcError> {
        let computed = CRC.checksum(&bytes[..15]);
        let received = u16::from_be_bytes([bytes[15], bytes[16]]);
        if received != computed {
            return Err(AdcFrameCrcError { received, computed });
        }
        let count = |at: usize| i32::from_be_bytes([bytes[at], bytes[at + 1], bytes[at + 2], 0]) >> 8;
        Ok(Self {
            response: u16::from_be_bytes([bytes[0], bytes[1]]),
            counts: [count(3), count(6), count(9), count(12)],
        })
    }
}

//! Registers of the ADS131M04 and what is written to them.

/// Answer to a RESET.
pub(super) const RESET_DONE: u16 = 0xFF24;

/// Upper byte of the ID register: 2, and the number of channels.
pub(super) const ID_OF_FOUR_CHANNELS: u16 = 0x2400;

/// Registers that the driver uses, by address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum Register {
    /// Identity, 24xx.
    Id = 0x00,
    /// Status; see [`StatusWord`].
    Status = 0x01,
    /// Word length, CRCs, time-out, data-ready pin.
    Mode = 0x02,
    /// Channels, oversampling, power.
    Clock = 0x03,
    /// Gains.
    Gain = 0x04,
    /// Global chop, current detection.
    Configuration = 0x06,
}

/// MODE: CRC demanded from us (bit 12), reset flag cleared (10), 24-bit words (9:8 = 1), time-out of broken frames (4).
const MODE: u16 = 0x1110;

/// CLOCK: all four channels on (11:8), high-resolution power mode (1:0 = 2).
const CLOCK: u16 = 0x0F02;

/// CFG: global-chop delay (12:9) as after reset.
const CONFIGURATION: u16 = 0x0600;
const GLOBAL_CHOP: u16 = 0x0100;

/// Gain of a channel; the full scale is 1.2 V divided by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names say all
pub enum Gain {
    X1,
    X2,
    X4,
    X8,
    X16,
    X32,
    X64,
    X128,
}

/// Modulator clocks (half the clock input) per conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names say all
pub enum Oversampling {
    X128,
    X256,
    X512,
    X1024,
    X2048,
    X4096,
    X8192,
    /// 250 SPS at 8.192 MHz.
    X16384,
}

/// How the converter is set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AdcSettings {
    /// Gain of each channel.
    pub gains: [Gain; 4],
    /// Oversampling; with the clock input it gives the rate.
    pub oversampling: Oversampling,
    /// Global chop: less offset and drift, but it changes the rate and delays the conversions.
    pub global_chop: bool,
}

impl Default for AdcSettings {
    /// Gain 1, 250 SPS at 8.192 MHz, no chop.
    fn default() -> Self {
        Self { gains: [Gain::X1; 4], oversampling: Oversampling::X16384, global_chop: false }
    }
}

impl AdcSettings {
    /// What is written, in this order: from the first on, damaged commands are refused.
    pub fn registers(&self) -> [(Register, u16); 4] {
        let [gain0, gain1, gain2, gain3] = self.gains.map(|gain| gain as u16);
        let chop = if self.global_chop { GLOBAL_CHOP } else { 0 };
        [
            (Register::Mode, MODE),
            (Register::Clock, CLOCK | (self.oversampling as u16) << 2),
            (Register::Gain, gain3 << 12 | gain2 << 8 | gain1 << 4 | gain0),
            (Register::Configuration, CONFIGURATION | chop),
        ]
    }
}

/// The STATUS register, answer to every NULL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StatusWord(
    /// As it came.
    pub u16,
);

impl StatusWord {
    /// Bit 15: only NULL, RREG and UNLOCK are taken.
    pub fn is_locked(self) -> bool {
        self.0 & 0x8000 != 0
    }

    /// Bit 14: the conversion was resynchronised.
    pub fn was_resynchronised(self) -> bool {
        self.0 & 0x4000 != 0
    }

    /// Bit 13: the register map's CRC has changed.
    pub fn register_map_changed(self) -> bool {
        self.0 & 0x2000 != 0
    }

    /// Bit 12: a command came with a wrong CRC.
    pub fn command_crc_failed(self) -> bool {
        self.0 & 0x1000 != 0
    }

    /// Bit 11: the CRCs follow the ANSI polynomial.
    pub fn crc_is_ansi(self) -> bool {
        self.0 & 0x0800 != 0
    }

    /// Bit 10: the converter was reset since MODE was written.
    pub fn was_reset(self) -> bool {
        self.0 & 0x0400 != 0
    }

    /// Bits 9:8 = 1: 24-bit words.
    pub fn word_length_is_24(self) -> bool {
        self.0 & 0x0300 == 0x0100
    }

    /// Bits 3:0: all four channels have a new conversion.
    pub fn all_ready(self) -> bool {
        self.0 & 0x000F == 0x000F
    }
}

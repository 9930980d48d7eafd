//! Texas Instruments ADS131M04: four simultaneous 24-bit channels over SPI, with a CRC both ways.
//!
//! Three channels carry the fluxgate's axes, the fourth the battery current, all sampled in the same instant. SPI mode 1
//! (clock low when idle, data taken on the second edge). The slowest rate, 250 SPS, comes from an 8.192 MHz clock and an
//! oversampling of 16384. Registers, commands and frames: ADS131M04-Q1 data sheet (TI), section 8.5.1, and the Linux
//! driver `drivers/iio/adc/ti-ads131m02.c`.

mod frame;
mod registers;

pub use frame::{AdcFrame, AdcFrameCrcError, Command, FRAME_BYTES, encode};
pub use registers::{AdcSettings, Gain, Oversampling, Register, StatusWord};

use super::count;
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{Error as _, ErrorKind, SpiDevice};
use registers::{ID_OF_FOUR_CHANNELS, RESET_DONE};

/// Wait after a reset until the registers hold their defaults, microseconds; t_REGACQ of the data sheet is far less.
const AFTER_RESET_US: u32 = 1_000;

/// After set-up the converter still holds two old conversions.
const OLD_CONVERSIONS: usize = 2;

/// What can go wrong with the converter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AdcError {
    /// The SPI bus failed.
    Spi(ErrorKind),
    /// The frame's CRC does not fit its content: nothing in it can be trusted.
    Crc(AdcFrameCrcError),
    /// The converter did not answer a reset as it should: absent, not clocked, or wired wrongly.
    NoReset {
        /// What it answered; FF24 would be right.
        response: u16,
    },
    /// Another chip answers.
    WrongId {
        /// Its ID register; 24xx would be right.
        id: u16,
    },
    /// The converter acknowledged a register write wrongly.
    NotAcknowledged {
        /// The register.
        register: Register,
        /// What it answered.
        response: u16,
    },
    /// A register reads back other than it was written.
    RegisterMismatch {
        /// The register.
        register: Register,
        /// What was written.
        written: u16,
        /// What was read back.
        read: u16,
    },
    /// The converter has reset itself and lost its set-up: call [`Ads131m04::init`].
    Reset(StatusWord),
    /// The conversion was resynchronised: this one and those still settling are no good.
    Resynchronised(StatusWord),
    /// The converter saw a command of ours with a wrong CRC.
    CommandCrc(StatusWord),
    /// The set-up is not the one that was written: word length, CRC type, or the register map changed by itself.
    Corrupted(StatusWord),
    /// At least one channel had no new conversion: the frame came too early.
    Stale(StatusWord),
}

impl core::fmt::Display for AdcError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Spi(kind) => write!(f, "ADC: SPI: {kind}"),
            Self::Crc(error) => write!(f, "ADC: CRC is {:04X}, should be {:04X}", error.received, error.computed),
            Self::NoReset { response } => write!(f, "ADC: answers reset with {response:04X}, should be FF24"),
            Self::WrongId { id } => write!(f, "ADC: identity is {id:04X}, should be 24xx"),
            Self::NotAcknowledged { register, response } => {
                write!(f, "ADC: write of {register:?}: answer {response:04X}")
            }
            Self::RegisterMismatch { register, written, read } => {
                write!(f, "ADC: {register:?} reads {read:04X} after {written:04X} was written")
            }
            Self::Reset(status) => write!(f, "ADC: has reset itself (status {:04X})", status.0),
            Self::Resynchronised(status) => write!(f, "ADC: was resynchronised (status {:04X})", status.0),
            Self::CommandCrc(status) => write!(f, "ADC: got a damaged command (status {:04X})", status.0),
            Self::Corrupted(status) => write!(f, "ADC: set-up is damaged (status {:04X})", status.0),
            Self::Stale(status) => write!(f, "ADC: read before a conversion was ready (status {:04X})", status.0),
        }
    }
}

impl core::error::Error for AdcError {}

/// Errors since the start, by kind. Full counters stay full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AdcFaults {
    /// Failures of the bus.
    pub spi: u32,
    /// Frames received with a wrong CRC.
    pub crc: u32,
    /// Resets that were not answered, wrong identities, and register writes that failed.
    pub set_up: u32,
    /// Resets that nobody asked for.
    pub resets: u32,
    /// Resynchronisations.
    pub resynchronisations: u32,
    /// Commands that the converter received with a wrong CRC.
    pub command_crc: u32,
    /// Frames that showed a damaged set-up.
    pub corrupted: u32,
    /// Frames without a new conversion.
    pub stale: u32,
}

impl AdcFaults {
    fn count(&mut self, error: AdcError) {
        count(match error {
            AdcError::Spi(_) => &mut self.spi,
            AdcError::Crc(_) => &mut self.crc,
            AdcError::NoReset { .. }
            | AdcError::WrongId { .. }
            | AdcError::NotAcknowledged { .. }
            | AdcError::RegisterMismatch { .. } => &mut self.set_up,
            AdcError::Reset(_) => &mut self.resets,
            AdcError::Resynchronised(_) => &mut self.resynchronisations,
            AdcError::CommandCrc(_) => &mut self.command_crc,
            AdcError::Corrupted(_) => &mut self.corrupted,
            AdcError::Stale(_) => &mut self.stale,
        });
    }
}

/// The converter.
#[derive(Clone, Debug)]
pub struct Ads131m04<Spi> {
    spi: Spi,
    settings: AdcSettings,
    faults: AdcFaults,
}

impl<Spi: SpiDevice> Ads131m04<Spi> {
    /// Driver of the converter on `spi`; nothing is sent before [`init`](Self::init).
    pub fn new(spi: Spi, settings: AdcSettings) -> Self {
        Self { spi, settings, faults: AdcFaults::default() }
    }

    /// Reset the converter, check its identity, write its registers and read each back; its ID register. Takes about 1 ms and
    /// 20 frames.
    pub fn init(&mut self, delay: &mut impl DelayNs) -> Result<u16, AdcError> {
        self.set_up(delay).inspect_err(|error| self.faults.count(*error))
    }

    /// One conversion of all four channels, 24-bit two's complement counts. Call once each time that DRDY falls; any error
    /// means that this conversion is lost. Only [`AdcError::Reset`] and [`AdcError::Corrupted`] call for `init`.
    pub fn read(&mut self) -> Result<[i32; 4], AdcError> {
        self.conversion().inspect_err(|error| self.faults.count(*error))
    }

    /// Its ID register, between two conversions: two frames, which conversions may get lost in.
    pub fn identity(&mut self) -> Result<u16, AdcError> {
        self.read_identity().inspect_err(|error| self.faults.count(*error))
    }

    /// Errors since the start.
    pub fn faults(&self) -> &AdcFaults {
        &self.faults
    }

    /// The SPI device.
    pub fn bus_mut(&mut self) -> &mut Spi {
        &mut self.spi
    }

    /// The SPI device again.
    pub fn release(self) -> Spi {
        self.spi
    }

    fn set_up(&mut self, delay: &mut impl DelayNs) -> Result<u16, AdcError> {
        // A locked converter would ignore the reset. What this frame answers belongs to an unknown past.
        self.exchange_unchecked(Command::Unlock)?;
        self.exchange_unchecked(Command::Reset)?;
        delay.delay_us(AFTER_RESET_US);
        let response = self.exchange(Command::Read(Register::Id))?.response;
        if response != RESET_DONE {
            return Err(AdcError::NoReset { response });
        }
        let id = checked_identity(self.exchange(Command::Null)?.response)?;
        for (register, value) in self.settings.registers() {
            self.write(register, value)?;
        }
        for _ in 0..OLD_CONVERSIONS {
            self.exchange(Command::Null)?;
        }
        Ok(id)
    }

    fn read_identity(&mut self) -> Result<u16, AdcError> {
        self.exchange(Command::Read(Register::Id))?;
        checked_identity(self.exchange(Command::Null)?.response)
    }

    /// Write, acknowledge, read back. The answer to each frame comes with the next.
    fn write(&mut self, register: Register, written: u16) -> Result<(), AdcError> {
        let command = Command::Write(register, written);
        self.exchange(command)?;
        let response = self.exchange(Command::Read(register))?.response;
        if response != command.acknowledgement() {
            return Err(AdcError::NotAcknowledged { register, response });
        }
        let read = self.exchange(Command::Null)?.response;
        if read == written { Ok(()) } else { Err(AdcError::RegisterMismatch { register, written, read }) }
    }

    fn conversion(&mut self) -> Result<[i32; 4], AdcError> {
        // Since `init` every command is NULL, which is answered with STATUS.
        let frame = self.exchange(Command::Null)?;
        let status = StatusWord(frame.response);
        if status.was_reset() {
            Err(AdcError::Reset(status))
        } else if status.register_map_changed() || !status.word_length_is_24() || status.crc_is_ansi() {
            Err(AdcError::Corrupted(status))
        } else if status.command_crc_failed() {
            Err(AdcError::CommandCrc(status))
        } else if status.was_resynchronised() {
            Err(AdcError::Resynchronised(status))
        } else if !status.all_ready() {
            Err(AdcError::Stale(status))
        } else {
            Ok(frame.counts)
        }
    }

    fn exchange(&mut self, command: Command) -> Result<AdcFrame, AdcError> {
        AdcFrame::decode(&self.exchange_unchecked(command)?).map_err(AdcError::Crc)
    }

    fn exchange_unchecked(&mut self, command: Command) -> Result<[u8; FRAME_BYTES], AdcError> {
        let mut bytes = encode(command);
        self.spi.transfer_in_place(&mut bytes).map_err(|error| AdcError::Spi(error.kind()))?;
        Ok(bytes)
    }
}

fn checked_identity(id: u16) -> Result<u16, AdcError> {
    if id & 0xFF00 == ID_OF_FOUR_CHANNELS { Ok(id) } else { Err(AdcError::WrongId { id }) }
}

//! What the program needs of a board, and all that it knows of one.
//!
//! A board hands out its [`Parts`] once, each to the task that uses it, and a [`System`], which every task may ask. The
//! boards themselves are in `src/board`, outside this library; the tests have one in memory.

use crate::body::UnixTime;
use crate::housekeeping::HousekeepingSample;
use crate::lights::Lights;
use crate::log::{ResetCause, TEXT_LEN};
use crate::microcontroller::ClockCheck;
use crate::store::SettingsInFlash;
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::SpiDevice;
use embedded_hal_nb::serial::{Read, Write};
use embedded_sdmmc::BlockDevice;
use embedded_storage::nor_flash::NorFlash;

/// Rate at which [`Ticker`] calls, periods in a second: the grid wants to be asked at least every 50 ms.
pub const TICKS_PER_S: u32 = 25;

/// A board: the types of its parts, and how it starts.
pub trait Board: Sized {
    /// What the chip hands out when it starts.
    type Peripherals;
    /// UART of the scalar sensor, at the baud rate of the settings; its interrupt comes with each byte.
    type ScalarPort: Read<u8>;
    /// UART of depth sensor, altimeter or GPS receiver, at the baud rate of the settings; its interrupt comes with each byte.
    type NmeaPort: Read<u8>;
    /// Out of the sensors' UARTs, for the self-test.
    type SensorTransmitters: SensorTransmitters;
    /// To the ship.
    type CableTransmitter: CableTransmitter;
    /// From the ship; its interrupt comes with each byte.
    type CableReceiver: Read<u8>;
    /// The converter's data-ready edge.
    type DataReady: DataReady;
    /// The pulse per second of a GPS receiver.
    type SecondPulses: SecondPulses;
    /// SPI device of the fluxgate's converter.
    type FluxgateBus: SpiDevice;
    /// The socket of the card. `write` returns only when the card is no longer busy.
    type Card: CardSlot<Error: core::error::Error>;
    /// Where the settings lie.
    type SettingsFlash: NorFlash;
    /// The three lights.
    type LightOutput: LightOutput;
    /// Leak contact and battery voltage.
    type HousekeepingInputs: HousekeepingInputs;
    /// Calls `assemble`.
    type Ticker: Ticker;
    /// Resets the chip when it is not fed.
    type Watchdog: Watchdog;
    /// Measures what an epoch costs.
    type Meter: Meter;
    /// What every task may ask.
    type System: System;

    /// Set up clocks, pins and peripherals, and read the settings. Interrupts are off until it has returned.
    fn start(peripherals: Self::Peripherals) -> Parts<Self>;
}

/// Everything on a board, ready for the tasks.
#[expect(missing_docs, reason = "the types of `Board` say it")]
pub struct Parts<B: Board> {
    pub scalar_port: B::ScalarPort,
    pub nmea_port: B::NmeaPort,
    pub sensor_transmitters: B::SensorTransmitters,
    pub cable_transmitter: B::CableTransmitter,
    pub cable_receiver: B::CableReceiver,
    pub data_ready: B::DataReady,
    pub second_pulses: B::SecondPulses,
    pub fluxgate_bus: B::FluxgateBus,
    pub card: B::Card,
    pub settings: SettingsInFlash<B::SettingsFlash>,
    pub lights: B::LightOutput,
    pub housekeeping: B::HousekeepingInputs,
    pub ticker: B::Ticker,
    pub watchdog: B::Watchdog,
    pub meter: B::Meter,
    pub system: B::System,
    /// What it runs from.
    pub clock: ClockCheck,
}

/// What a stamp is for. It makes no difference but to an emulator, whose host replays the stamps that the grid sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stamp {
    /// A byte of the scalar sensor.
    ScalarByte,
    /// A conversion of the fluxgate.
    Conversion,
    /// The grid is asked for epochs.
    Poll,
    /// The converter is set up.
    SetUp,
    /// The grid does not see it.
    Other,
}

/// A socket, with a card in it or without. No call takes longer than [`CALL_US`](crate::sd_card::CALL_US).
pub trait CardSlot: BlockDevice {
    /// After a call that failed: the next one finds out anew whether there is a card, and starts it.
    fn look_again(&self);
}

/// The text of a panic or fault.
pub type LastWords = heapless::String<TEXT_LEN>;

/// The chip, as far as more than one task uses it: timer, memory that outlives a reset, start and end.
pub trait System: Clone {
    /// The free-running timer, microseconds; it wraps after 71.6 minutes.
    fn now_us(&self) -> u32;

    /// The same, for a time stamp of an input; what it is for is told to an emulator's host.
    fn stamp_us(&self, stamp: Stamp) -> u32;

    /// A number that tells sessions apart. Not for secrets.
    fn random(&self, now_us: u32) -> u32;

    /// Have the fluxgate's task run though no conversion came.
    fn wake_fluxgate(&self);

    /// Why the chip has started.
    fn reset_cause(&self) -> ResetCause;

    /// Panics, hard faults and resets by the watchdog since power came.
    fn restarts_by_fault(&self) -> u32;

    /// The message of the panic or fault that ended the last session, once.
    fn last_words(&self) -> Option<LastWords>;

    /// Keep the time of now for the session after a reset, whatever its cause; `None` when it is not known.
    fn keep_time(&self, time: Option<UnixTime>);

    /// The time that was kept last, once; `None` after the power was gone.
    fn kept_time(&self) -> Option<UnixTime>;

    /// Start the chip anew. A board never returns from it, a test may.
    fn restart(&self);

    /// The most stack that was ever in use, bytes.
    fn most_stack_used(&self) -> u32;

    /// Ticks of [`Meter`] that 100,000 instructions take; 0 where they are clock cycles.
    fn ticks_of_known_loop(&self) -> u32;
}

/// Waits by looking at the timer: for the converter's reset only, a millisecond.
pub struct SpinDelay<'a, S>(pub &'a S);

impl<S: System> DelayNs for SpinDelay<'_, S> {
    fn delay_ns(&mut self, ns: u32) {
        let begin_us = self.0.now_us();
        while self.0.now_us().wrapping_sub(begin_us) <= ns.div_ceil(1_000) {}
    }
}

/// A UART that a sensor sends to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorPort {
    /// The scalar sensor's.
    Scalar,
    /// That of depth sensor, altimeter or GPS receiver.
    Nmea,
}

impl SensorPort {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Scalar, Self::Nmea];
}

/// The other direction of these UARTs: nothing is ever sent to a sensor, but the self-test sends to a wire.
pub trait SensorTransmitters {
    /// Send a byte, or nothing while the one before it is still on its way.
    fn send(&mut self, port: SensorPort, byte: u8);
}

/// The transmitter of the tow cable, and its interrupt.
pub trait CableTransmitter: Write<u8> {
    /// Have the task of the cable run as soon as there is room for a byte.
    fn listen(&mut self);

    /// Have the task run no more when there is room for a byte.
    fn unlisten(&mut self);

    /// Have it run now and as soon as there is room: there is something to send.
    fn wake(&mut self);
}

/// The converter's data-ready edge.
pub trait DataReady {
    /// The stamp of the edge, microseconds, once.
    fn take(&mut self) -> Option<u32>;
}

/// The pulse per second of a GPS receiver, if one is connected.
pub trait SecondPulses {
    /// The stamp of the latest pulse, microseconds, once.
    fn take(&mut self) -> Option<u32>;
}

/// Three lights.
pub trait LightOutput {
    /// Switch them.
    fn show(&mut self, lights: Lights);
}

/// Leak contact and battery voltage.
pub trait HousekeepingInputs {
    /// Both as they are. Asked at every epoch, and never waits for a conversion.
    fn sample(&mut self) -> HousekeepingSample;
}

/// The periodic call of `assemble`, [`TICKS_PER_S`].
pub trait Ticker {
    /// Clear the interrupt, first of all in its task.
    fn acknowledge(&mut self);
}

/// A watchdog: it resets the chip when not fed for several seconds, which is longer than any call of the card.
pub trait Watchdog {
    /// Start its time anew: every task has run since the last call.
    fn feed(&mut self);
}

/// What the epochs so far have cost, in ticks of the [`Meter`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EpochCost {
    /// Mean of all epochs.
    pub mean: u32,
    /// The most expensive epoch.
    pub worst: u32,
}

/// Measures the processor time of an epoch: what is spent between two sleeps, all tasks included.
pub trait Meter {
    /// Sleep until an interrupt. `epochs` have been made so far; `tell` what they cost when that is known, before sleeping.
    fn sleep(&mut self, epochs: u32, tell: impl FnOnce(EpochCost));
}

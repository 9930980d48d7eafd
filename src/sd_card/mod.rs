//! The SD card on its SPI bus: what `embedded-sdmmc`'s driver leaves to its caller.
//!
//! The driver speaks the protocol. Around it, here: the clocks that a card wants before its first command, the slow clock
//! while it starts and the fast one after it, chip select held from the first byte of a command to the last, the wait for
//! a card that is still busy, and an end to every call ([`CALL_US`]), whatever the card does. A card that was taken out or
//! has lost its power is started anew once within the call that finds out; when that fails as well, calls end at once
//! until [`CardSlot::look_again`].
//!
//! Generic over the hardware, so that the tests run it on a model of a card, byte by byte.

mod bus;
mod probe;

pub use bus::{CardBus, Speed};

use crate::hardware::{CardSlot, System};
use bus::Wire;
use core::cell::Cell;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_sdmmc::sdcard::spi::{AcquireOpts, Error};
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx, SdCard};

/// The longest that a call takes, microseconds. A card may start for 1 s and be busy for 0.5 s (Physical Layer
/// Specification, 4.2.3 and 4.6.2); the watchdog waits for 6 s at least.
pub const CALL_US: u32 = 2_000_000;

/// A card that answers `probe` answers the driver's first command as well.
const START: AcquireOpts = AcquireOpts { use_crc: true, acquire_retries: 2 };

/// What is known of the card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// To be started.
    Unknown,
    /// It takes commands.
    Started,
    /// It did not start, or failed after it had been started anew.
    GivenUp,
}

/// A card, or the empty socket, on a bus of its own.
pub struct SpiCard<BUS: CardBus, CS: OutputPin, DELAY: DelayNs, S: System> {
    driver: SdCard<Wire<BUS, CS, S>, DELAY>,
    state: Cell<State>,
}

impl<BUS: CardBus, CS: OutputPin, DELAY: DelayNs, S: System> SpiCard<BUS, CS, DELAY, S> {
    /// The card has not been spoken to. `select` is high.
    pub fn new(bus: BUS, select: CS, delay: DELAY, system: S) -> Self {
        let driver = SdCard::new_with_options(Wire::new(bus, select, system), delay, START);
        Self { driver, state: Cell::new(State::Unknown) }
    }

    /// Do something with the card; a second time when it fails, with the card started anew unless it has said what was
    /// wrong and `is_repeatable` as it is.
    fn with_card<T>(
        &self,
        is_repeatable: bool,
        mut work: impl FnMut(&SdCard<Wire<BUS, CS, S>, DELAY>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        if self.state.get() == State::GivenUp {
            return Err(Error::CardNotFound);
        }
        self.driver.spi(|wire| wire.begin_call(CALL_US));
        let first = self.attempt(&mut work);
        let Err(error) = first else { return first };
        if self.driver.spi(|wire| wire.is_late()) {
            self.state.set(State::GivenUp);
            return first;
        }
        let is_alive = is_repeatable && is_answer(error) && self.driver.spi(Wire::end_write).is_ok();
        if !is_alive {
            self.state.set(State::Unknown);
        }
        let second = self.attempt(&mut work);
        if let Err(error) = second {
            self.state.set(if is_answer(error) { self.state.get() } else { State::GivenUp });
        }
        second
    }

    fn attempt<T>(
        &self,
        work: &mut impl FnMut(&SdCard<Wire<BUS, CS, S>, DELAY>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let done = if self.state.get() == State::Started { Ok(()) } else { self.start() };
        let done = done.and_then(|()| {
            self.driver.spi(Wire::select)?;
            let done = work(&self.driver)?;
            // The driver comes back from a write of several blocks while the card is at work.
            self.driver.spi(Wire::wait_until_ready)?;
            Ok(done)
        });
        // Let go of it whatever happened.
        self.driver.spi(Wire::release);
        if done.is_ok() {
            self.state.set(State::Started);
        }
        done
    }

    /// From power-up to a card that takes blocks.
    fn start(&self) -> Result<(), Error> {
        self.driver.mark_card_uninit();
        self.driver.spi(|wire| {
            wire.set_speed(Speed::Start);
            probe::probe(wire)?;
            wire.select()
        })?;
        let is_found = self.driver.get_card_type().is_some();
        self.driver.spi(|wire| {
            wire.release();
            wire.set_speed(Speed::Data);
        });
        if !is_found {
            return Err(Error::CardNotFound);
        }
        self.state.set(State::Started);
        Ok(())
    }
}

/// Whether it is the card that says so: a bad block, or a bit that went wrong on the wire.
fn is_answer(error: Error) -> bool {
    matches!(error, Error::ReadError | Error::WriteError | Error::CrcError(..))
}

impl<BUS: CardBus, CS: OutputPin, DELAY: DelayNs, S: System> BlockDevice for SpiCard<BUS, CS, DELAY, S> {
    type Error = Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), Error> {
        // A read of several blocks that broke off has no end.
        self.with_card(blocks.len() == 1, |driver| driver.read(blocks, start))
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), Error> {
        self.with_card(true, |driver| driver.write(blocks, start))
    }

    fn num_blocks(&self) -> Result<BlockCount, Error> {
        self.with_card(true, BlockDevice::num_blocks)
    }
}

impl<BUS: CardBus, CS: OutputPin, DELAY: DelayNs, S: System> CardSlot for SpiCard<BUS, CS, DELAY, S> {
    fn look_again(&self) {
        self.state.set(State::Unknown);
    }
}

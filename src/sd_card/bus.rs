//! One card on one bus: chip select, clock and the end of a call.

use crate::hardware::System;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiBus, SpiDevice};
use embedded_sdmmc::SdCardError as Error;

/// Ends a write of several blocks, and means nothing at any other time.
pub(super) const STOP: u8 = 0xfd;

/// What a card is clocked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speed {
    /// 100 to 400 kHz, what every card takes while it starts.
    Start,
    /// 10 to 25 MHz.
    Data,
}

/// A bus with the card alone on it, mode 0.
pub trait CardBus: SpiBus {
    /// Set the clock; the bus is idle.
    fn set_speed(&mut self, speed: Speed);
}

/// The bus as the driver sees it. Chip select stays as it is: the driver sends a command in pieces, and cards may take a
/// rising edge between them for the end of the command.
pub(super) struct Wire<BUS, CS, S> {
    bus: BUS,
    select: CS,
    system: S,
    began_us: u32,
    call_us: u32,
}

impl<BUS: CardBus, CS: OutputPin, S: System> Wire<BUS, CS, S> {
    pub(super) fn new(bus: BUS, select: CS, system: S) -> Self {
        Self { bus, select, system, began_us: 0, call_us: 0 }
    }

    /// From now on the bus works for so long.
    pub(super) fn begin_call(&mut self, call_us: u32) {
        self.began_us = self.system.now_us();
        self.call_us = call_us;
    }

    /// Whether the time of the call is over.
    pub(super) fn is_late(&self) -> bool {
        self.system.now_us().wrapping_sub(self.began_us) >= self.call_us
    }

    pub(super) fn set_speed(&mut self, speed: Speed) {
        self.bus.set_speed(speed);
    }

    pub(super) fn select(&mut self) -> Result<(), Error> {
        self.select.set_low().map_err(|_| Error::GpioError)
    }

    /// Chip select high, and eight clocks: only with them does a card let go of its output.
    pub(super) fn release(&mut self) {
        // Nothing could be done about a pin or a bus that fails: the next command does, and is told.
        _ = self.select.set_high();
        _ = self.bus.write(&[0xff]);
        _ = self.bus.flush();
    }

    /// Clocks with nothing said; what came back last.
    pub(super) fn idle(&mut self, bytes: u32) -> Result<u8, Error> {
        let mut byte = [0xff];
        for _ in 0..bytes {
            byte = [0xff];
            self.transfer(&mut byte)?;
        }
        Ok(byte[0])
    }

    /// Send these bytes and get what comes back.
    pub(super) fn transfer(&mut self, bytes: &mut [u8]) -> Result<(), Error> {
        let mut operations = [Operation::TransferInPlace(bytes)];
        self.transaction(&mut operations).map_err(|_| Error::Transport)
    }

    /// After a write that was refused: a write of several blocks must be told that it is over.
    pub(super) fn end_write(&mut self) -> Result<(), Error> {
        self.select()?;
        self.transfer(&mut [STOP, 0xff])?;
        self.wait_until_ready()?;
        self.release();
        Ok(())
    }

    /// As long as the card holds its output low it is at work.
    pub(super) fn wait_until_ready(&mut self) -> Result<(), Error> {
        while self.idle(1)? != 0xff {}
        Ok(())
    }
}

impl<BUS: CardBus, CS: OutputPin, S: System> ErrorType for Wire<BUS, CS, S> {
    type Error = ErrorKind;
}

impl<BUS: CardBus, CS: OutputPin, S: System> SpiDevice for Wire<BUS, CS, S> {
    /// Ends with an error when the time of the call is over: the driver then gives up, however often it would try.
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        if self.is_late() {
            return Err(ErrorKind::Other);
        }
        let bus = &mut self.bus;
        let done = operations.iter_mut().try_for_each(|operation| match operation {
            Operation::Read(bytes) => bus.read(bytes),
            Operation::Write(bytes) => bus.write(bytes),
            Operation::Transfer(read, write) => bus.transfer(read, write),
            Operation::TransferInPlace(bytes) => bus.transfer_in_place(bytes),
            // The driver's delays are its own.
            Operation::DelayNs(_) => Ok(()),
        });
        done.and(bus.flush()).map_err(|_| ErrorKind::Other)
    }
}

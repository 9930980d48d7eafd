//! The bus, chip select and the timer of the delays.

use super::world::World;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{ErrorType, SpiBus};
use std::convert::Infallible;
use std::rc::Rc;
use towmag::sd_card::{CardBus, Speed};

/// SPI2 of the board, on a bus of 42 MHz: what its divisors make of 400 kHz, and of 12 MHz.
const START_HZ: u32 = 42_000_000 / 128;
const DATA_HZ: u32 = 42_000_000 / 4;

/// Bytes that are clocked before the world is asked what has happened meanwhile.
const BYTES_AT_ONCE: usize = 64;

pub struct VirtualBus(pub Rc<World>);

impl VirtualBus {
    fn clock(&self, byte: u8) -> u8 {
        let world = &self.0;
        let hz = world.hz.get();
        let mut socket = world.socket.borrow_mut();
        let Some(card) = socket.as_mut() else { return 0xff };
        if !world.is_selected.get() {
            card.clock_unselected(hz);
            return 0xff;
        }
        world.over_the_wire(card.clock(world.over_the_wire(byte), world.now_ns(), hz))
    }

    fn pass(&self, bytes: usize) {
        let world = &self.0;
        world.bytes.set(world.bytes.get() + bytes as u64);
        world.advance(bytes as u64 * 8_000_000_000 / u64::from(world.hz.get()));
    }
}

impl ErrorType for VirtualBus {
    type Error = Infallible;
}

impl SpiBus for VirtualBus {
    fn read(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        bytes.fill(0xff);
        self.transfer_in_place(bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Infallible> {
        for part in bytes.chunks(BYTES_AT_ONCE) {
            self.pass(part.len());
            part.iter().for_each(|&byte| _ = self.clock(byte));
        }
        Ok(())
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Infallible> {
        read.fill(0xff);
        read.iter_mut().zip(write).for_each(|(to, from)| *to = *from);
        self.transfer_in_place(read)
    }

    fn transfer_in_place(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for part in bytes.chunks_mut(BYTES_AT_ONCE) {
            self.pass(part.len());
            part.iter_mut().for_each(|byte| *byte = self.clock(*byte));
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl CardBus for VirtualBus {
    fn set_speed(&mut self, speed: Speed) {
        self.0.hz.set(match speed {
            Speed::Start => START_HZ,
            Speed::Data => DATA_HZ,
        });
    }
}

pub struct VirtualSelect(pub Rc<World>);

impl digital::ErrorType for VirtualSelect {
    type Error = Infallible;
}

impl OutputPin for VirtualSelect {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.is_selected.set(true);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.is_selected.set(false);
        Ok(())
    }
}

pub struct VirtualDelay(pub Rc<World>);

impl DelayNs for VirtualDelay {
    fn delay_ns(&mut self, ns: u32) {
        self.0.advance(u64::from(ns));
    }
}

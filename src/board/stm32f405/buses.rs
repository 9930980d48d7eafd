//! SPI: the fluxgate's converter and the card, each on a bus of its own.

use embedded_hal::spi::{self, Operation, SpiBus, SpiDevice};
use stm32f4xx_hal::gpio::{self, Output, PushPull};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::spi::{Mode, Phase, Polarity, Spi};
use stm32f4xx_hal::timer::DelayUs;
use towmag::sd_card::{CardBus, Speed, SpiCard};

use super::system::System;

/// Below the converter's 25 MHz at 3.3 V, with room for a cable.
const FLUXGATE_HZ: u32 = 8_000_000;

/// What every card takes while it starts. SPI2 is on the bus of 42 MHz, and its divisor 128: 328 kHz.
const CARD_START_HZ: u32 = 400_000;

/// Divisor 4, 10.5 MHz: cards take 25, wires of some centimetres this.
const CARD_DATA_BR: u8 = 0b001;
/// Divisor 128.
const CARD_START_BR: u8 = 0b110;

/// The SPI device of the converter.
pub type FluxgateBus = Exclusive<pac::SPI1>;

/// The card in its socket.
pub type LogCard = SpiCard<CardSpi, gpio::ErasedPin<Output<PushPull>>, DelayUs<pac::TIM5>, System>;

/// A bus with one device on it.
pub struct Exclusive<SPI: stm32f4xx_hal::spi::Instance> {
    bus: Spi<SPI>,
    select: gpio::ErasedPin<Output<PushPull>>,
}

/// Bus and chip select of the converter: mode 1.
pub fn fluxgate(
    spi: pac::SPI1,
    (clock, miso, mosi): (gpio::PA5, gpio::PA6, gpio::PA7),
    select: gpio::PA4,
    rcc: &mut Rcc,
) -> FluxgateBus {
    let mode = Mode { polarity: Polarity::IdleLow, phase: Phase::CaptureOnSecondTransition };
    let pins = (Some(clock), Some(miso), Some(mosi));
    let bus = Spi::new(spi, pins, mode, FLUXGATE_HZ.Hz(), rcc);
    Exclusive { bus, select: selected_by(select) }
}

/// Bus and chip select of the card: mode 0.
pub fn card(
    spi: pac::SPI2,
    (clock, miso, mosi): (gpio::PB13, gpio::PB14, gpio::PB15),
    select: gpio::PB12,
    timer: pac::TIM5,
    rcc: &mut Rcc,
) -> LogCard {
    let mode = Mode { polarity: Polarity::IdleLow, phase: Phase::CaptureOnFirstTransition };
    let pins = (Some(clock), Some(miso.internal_pull_up(true)), Some(mosi));
    let bus = Spi::new(spi, pins, mode, CARD_START_HZ.Hz(), rcc);
    SpiCard::new(CardSpi(bus), selected_by(select), timer.delay_us(rcc), System::new())
}

fn selected_by<const P: char, const N: u8>(pin: gpio::Pin<P, N>) -> gpio::ErasedPin<Output<PushPull>> {
    let mut pin = pin.into_push_pull_output();
    pin.set_speed(gpio::Speed::High);
    pin.set_high();
    pin.erase()
}

/// SPI2, whose clock changes when the card has started.
pub struct CardSpi(Spi<pac::SPI2>);

impl CardBus for CardSpi {
    fn set_speed(&mut self, speed: Speed) {
        let br = match speed {
            Speed::Start => CARD_START_BR,
            Speed::Data => CARD_DATA_BR,
        };
        self.0.enable(false);
        // The HAL sets the clock only when it makes a bus out of its parts.
        #[allow(unsafe_code)]
        // SAFETY: this owns SPI2, and no interrupt touches it; the field takes every value of three bits.
        unsafe { &*pac::SPI2::ptr() }.cr1().modify(|_, w| w.br().set(br));
        self.0.enable(true);
    }
}

impl spi::ErrorType for CardSpi {
    type Error = stm32f4xx_hal::spi::Error;
}

impl SpiBus for CardSpi {
    fn read(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error> {
        SpiBus::read(&mut self.0, bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Self::Error> {
        SpiBus::write(&mut self.0, bytes)
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Self::Error> {
        SpiBus::transfer(&mut self.0, read, write)
    }

    fn transfer_in_place(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error> {
        SpiBus::transfer_in_place(&mut self.0, bytes)
    }

    fn flush(&mut self) -> Result<(), Self::Error> {
        SpiBus::flush(&mut self.0)
    }
}

impl<SPI: stm32f4xx_hal::spi::Instance> spi::ErrorType for Exclusive<SPI> {
    type Error = stm32f4xx_hal::spi::Error;
}

impl<SPI: stm32f4xx_hal::spi::Instance> SpiDevice for Exclusive<SPI> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Self::Error> {
        self.select.set_low();
        let done = operations.iter_mut().try_for_each(|operation| match operation {
            Operation::Read(bytes) => SpiBus::read(&mut self.bus, bytes),
            Operation::Write(bytes) => SpiBus::write(&mut self.bus, bytes),
            Operation::Transfer(read, write) => SpiBus::transfer(&mut self.bus, read, write),
            Operation::TransferInPlace(bytes) => SpiBus::transfer_in_place(&mut self.bus, bytes),
            Operation::DelayNs(ns) => {
                cortex_m::asm::delay(ns.div_ceil(6)); // 168 MHz
                Ok(())
            }
        });
        // The device must be let go of whatever happened.
        let flushed = SpiBus::flush(&mut self.bus);
        self.select.set_high();
        done.and(flushed)
    }
}

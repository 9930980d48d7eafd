//! SPI: the fluxgate's converter and the card, each on a bus of its own.

use embedded_hal::spi::{self, Operation, SpiBus, SpiDevice};
use embedded_sdmmc::SdCard;
use stm32f4xx_hal::gpio::{self, Output, PushPull, Speed};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::spi::{Mode, Phase, Polarity, Spi};
use stm32f4xx_hal::timer::DelayUs;

/// Below the converter's 25 MHz at 3.3 V, with room for a cable.
const FLUXGATE_HZ: u32 = 8_000_000;

/// What every card takes while it starts. Data go at the same speed: 640 bytes a second are not much.
const CARD_HZ: u32 = 400_000;

/// The SPI device of the converter.
pub type FluxgateBus = Exclusive<pac::SPI1>;

/// The card.
pub type LogCard = SdCard<Exclusive<pac::SPI2>, DelayUs<pac::TIM5>>;

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
    let bus = Spi::new(spi, pins, mode, CARD_HZ.Hz(), rcc);
    SdCard::new(Exclusive { bus, select: selected_by(select) }, timer.delay_us(rcc))
}

fn selected_by<const P: char, const N: u8>(pin: gpio::Pin<P, N>) -> gpio::ErasedPin<Output<PushPull>> {
    let mut pin = pin.into_push_pull_output();
    pin.set_speed(Speed::High);
    pin.set_high();
    pin.erase()
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

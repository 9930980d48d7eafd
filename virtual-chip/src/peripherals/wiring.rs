//! What is wired to which pin, and what passes over the wires.

use super::bus::Bus;
use super::gpio::Pin;
use super::spi::Mode;
use crate::clocks::{Clocks, Moment};
use crate::time::ns;
use crate::wires::converter::Converter;

const MODE_0: Mode = Mode { is_idle_high: false, is_second_edge: false };
const MODE_1: Mode = Mode { is_idle_high: false, is_second_edge: true };

/// Port and pin, and number of the alternate function: what leads out of the chip.
const SERIAL_PINS: [[(usize, u32); 2]; 3] = [[(0, 9), (0, 10)], [(0, 2), (0, 3)], [(1, 10), (1, 11)]];
const SERIAL_FUNCTION: u32 = 7;
const SPI_PINS: [[(usize, u32); 3]; 2] = [[(0, 5), (0, 6), (0, 7)], [(1, 13), (1, 14), (1, 15)]];
const SPI_FUNCTION: u32 = 5;
const SELECT_PINS: [(usize, u32); 2] = [(0, 4), (1, 12)];
const PULSE_PIN: (usize, u32) = (0, 0);
const PULSE_FUNCTION: u32 = 1;
const READY_PIN: (usize, u32) = (2, 6);

/// What an open input reads.
const OPEN: u8 = 0xFF;

impl Bus {
    /// Levels of the three lights: green, yellow, red.
    pub fn lights(&self) -> [bool; 3] {
        [0, 1, 2].map(|pin| self.ports[2].pin(pin) == Pin::Output(true))
    }

    /// What has passed over the UARTs' wires by now: only through the right pins.
    pub(super) fn pass_serial(&mut self, now: Moment) {
        for (i, pins) in SERIAL_PINS.into_iter().enumerate() {
            let has_pins = pins.map(|pin| self.is_alternate(pin, SERIAL_FUNCTION));
            self.usarts[i].elapse(now.fs, uart_clock_hz(i, now.clocks), has_pins);
        }
    }

    /// What has passed over the wires of both SPI controllers by now.
    pub(super) fn pass_spi(&mut self, now: Moment) {
        for i in 0..2 {
            let bus_hz = [now.clocks.bus_2_hz, now.clocks.bus_1_hz][i];
            while let Some((end_fs, sent)) = self.spis[i].finished(now.fs) {
                let has_pins = SPI_PINS[i].iter().all(|pin| self.is_alternate(*pin, SPI_FUNCTION));
                let answer = if has_pins { self.exchange(i, sent, end_fs, bus_hz) } else { OPEN };
                self.spis[i].finish(end_fs, answer, bus_hz);
            }
        }
    }

    /// Conversions, and the level of the data-ready pin.
    pub(super) fn convert(&mut self, now_fs: u64) {
        let (port, pin) = READY_PIN;
        while let Some(converter) = self.converter.as_mut().filter(|converter| converter.due_fs() <= now_fs) {
            converter.convert(converter.due_fs());
            // It rises shortly before each conversion, whether anybody has read or not.
            self.exti.edge(port as u32, pin, false);
        }
        let is_high = self.converter.as_ref().is_none_or(|converter| converter.is_ready_high);
        self.ports[port].input = self.ports[port].input & !(1 << pin) | u16::from(is_high) << pin;
    }

    /// Pulses of the second.
    pub(super) fn pass_pulses(&mut self, now: Moment) {
        while let Some(at_fs) = self.pulses.take(now.fs) {
            if self.is_alternate(PULSE_PIN, PULSE_FUNCTION) {
                self.timers[0].rising_edge_1(Moment { fs: at_fs, ..now });
            }
        }
    }

    /// After a change of the pins.
    pub(super) fn follow_selects(&mut self) {
        let is_selected = self.is_selected(0);
        if let Some(converter) = &mut self.converter {
            converter.select(is_selected);
        }
    }

    /// A byte to and from what is on this bus. With a wrong mode the bits are off by one.
    fn exchange(&mut self, spi: usize, sent: u8, now_fs: u64, bus_hz: f64) -> u8 {
        let is_right = self.spis[spi].mode() == [MODE_1, MODE_0][spi];
        let sent = if is_right { sent } else { sent << 1 };
        let is_selected = self.is_selected(spi);
        let hz = self.spis[spi].hz(bus_hz) as u32;
        match (spi, &mut self.card) {
            (0, _) => self.converter.as_mut().map_or(OPEN, |converter: &mut Converter| converter.clock(sent)),
            (_, Some(card)) if is_selected => card.clock(sent, ns(now_fs), hz),
            (_, Some(card)) => {
                card.clock_unselected(hz);
                OPEN
            }
            (_, None) => OPEN,
        }
    }

    fn is_alternate(&self, (port, pin): (usize, u32), function: u32) -> bool {
        self.ports[port].pin(pin) == Pin::Alternate(function)
    }

    fn is_selected(&self, spi: usize) -> bool {
        let (port, pin) = SELECT_PINS[spi];
        self.ports[port].pin(pin) == Pin::Output(false)
    }
}

/// The clock of a UART of these three, Hz.
pub(super) fn uart_clock_hz(uart: usize, clocks: Clocks) -> f64 {
    if uart == 0 { clocks.bus_2_hz } else { clocks.bus_1_hz }
}

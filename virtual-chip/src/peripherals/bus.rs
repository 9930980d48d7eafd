//! Which address is whose, what time does to all of them, and what is wired to which pin.

use super::adc::Adc;
use super::core::Core;
use super::exti::Exti;
use super::flash::{Cells, Flash};
use super::gpio::{Gpio, Pin};
use super::pwr::Pwr;
use super::rcc::Rcc;
use super::spi::{Mode, Spi};
use super::timer::Timer;
use super::usart::Usart;
use super::watchdog::Watchdog;
use crate::board::{Board, Oscillators};
use crate::clocks::{Clocks, Moment};
use crate::time::{NEVER_FS, ns};
use crate::wires::pulses::Pulses;
use crate::wires::serial::Line;
use crate::wires::converter::Converter;
use towmag_virtual_body::sd::SdCard;

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

/// Interrupts of the chip.
const EXTI9_5: u32 = 23;
const TIMERS: [u32; 3] = [28, 30, 50];
const USARTS: [u32; 3] = [37, 38, 39];

/// Why a run cannot go on: the program does what the chip does not bear, or what nothing here models.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Complaint(pub String);

/// All peripherals, and what is wired to them.
pub struct Bus {
    /// The clocks; `None` while the core has none.
    pub clocks: Option<Clocks>,
    oscillators: Oscillators,
    /// Reset and clock control.
    pub rcc: Rcc,
    pwr: Pwr,
    /// The flash interface.
    pub flash: Flash,
    ports: [Gpio; 3],
    exti: Exti,
    /// USART1 to 3.
    pub usarts: [Usart; 3],
    spis: [Spi; 2],
    /// TIM2, TIM4, TIM5.
    timers: [Timer; 3],
    /// The first analogue-to-digital converter.
    pub adc: Adc,
    /// The independent watchdog.
    pub watchdog: Watchdog,
    /// What the core itself has.
    pub core: Core,
    /// The fluxgate's converter, if it is there.
    pub converter: Option<Converter>,
    /// The card in its socket.
    pub card: Option<SdCard>,
    /// The pulse per second.
    pub pulses: Pulses,
}

impl Bus {
    /// As power comes, with these reset flags.
    pub fn new(board: Board, cells: Cells, flags: u32) -> Self {
        let Board { oscillators, supply_mv, converter, card, lines } = board;
        let rcc = Rcc::new(oscillators, flags);
        Self {
            clocks: rcc.clocks(),
            oscillators,
            rcc,
            pwr: Pwr::new(supply_mv),
            flash: Flash::new(cells),
            ports: [0, 1, 2].map(Gpio::new),
            exti: Exti::default(),
            usarts: lines.map(Usart::new),
            spis: Default::default(),
            timers: timers(),
            adc: Adc::default(),
            watchdog: Watchdog::new(),
            core: Core::default(),
            converter,
            card,
            pulses: Pulses::default(),
        }
    }

    /// A reset for these reasons: everything in the chip begins anew, what is wired to it does not.
    pub fn reset(&mut self, flags: u32, now_fs: u64) {
        self.rcc = Rcc::new(self.oscillators, self.rcc.flags() | flags);
        self.pwr = Pwr::new(self.pwr.supply_mv);
        self.flash.reset();
        self.ports = [0, 1, 2].map(Gpio::new);
        self.exti = Exti::default();
        self.usarts.iter_mut().for_each(Usart::reset);
        self.spis = Default::default();
        self.timers = timers();
        self.adc.reset();
        self.watchdog = Watchdog::new();
        self.core = Core::default();
        self.follow_clocks(now_fs);
        self.follow_selects();
    }

    /// Power goes: what the board is made of, and the cells.
    pub fn into_parts(self) -> (Board, Cells) {
        let lines = self.usarts.map(|usart| usart.line);
        let board = Board {
            oscillators: self.oscillators,
            supply_mv: self.pwr.supply_mv,
            converter: self.converter,
            card: self.card,
            lines,
        };
        (board, self.flash.cells)
    }

    /// When something happens by itself.
    pub fn due_fs(&self) -> u64 {
        let usarts = self.usarts.iter().map(Usart::due_fs);
        let spis = self.spis.iter().map(Spi::due_fs);
        let timers = self.timers.iter().map(Timer::due_fs);
        let converter_fs = self.converter.as_ref().map_or(NEVER_FS, Converter::due_fs);
        let others = [self.watchdog.due_fs(), converter_fs, self.pulses.due_fs()];
        usarts.chain(spis).chain(timers).chain(others).min().unwrap_or(NEVER_FS)
    }

    /// What has happened by now.
    pub fn elapse(&mut self, now_fs: u64) {
        let Some(clocks) = self.clocks else { return };
        let now = Moment { fs: now_fs, clocks };
        for i in 0..3 {
            let has_pins = SERIAL_PINS[i].map(|pin| self.is_alternate(pin, SERIAL_FUNCTION));
            self.usarts[i].elapse(now_fs, bus_hz(i, clocks), has_pins);
        }
        self.pass_bytes(now_fs, clocks);
        self.timers.iter_mut().for_each(|timer| timer.elapse(now));
        self.convert(now_fs);
        while let Some(at_fs) = self.pulses.take(now_fs) {
            if self.is_alternate(PULSE_PIN, PULSE_FUNCTION) {
                self.timers[0].rising_edge_1(Moment { fs: at_fs, clocks });
            }
        }
        self.follow_lines();
    }

    /// Whether a program that looks at this register has nothing to do until something happens.
    pub fn is_polled(&self, address: u32) -> bool {
        match address {
            0x4001_3008 => self.spis[0].is_waited_for(),
            0x4000_3808 => self.spis[1].is_waited_for(),
            0x4000_0C00 => self.timers[2].is_in_pulse(),
            _ => false,
        }
    }

    /// The core reads a register.
    pub fn read(&mut self, address: u32, now: Moment) -> Result<u32, Complaint> {
        self.check_clock(address)?;
        let offset = address & 0x3FF;
        let value = match address & !0x3FF {
            0x4000_0000 => self.timers[0].read(offset, now),
            0x4000_0800 => self.timers[1].read(offset, now),
            0x4000_0C00 => self.timers[2].read(offset, now),
            0x4000_3000 => self.watchdog.read(offset, now),
            0x4000_3800 => self.spis[1].read(offset),
            0x4000_4400 => self.usarts[1].read(offset),
            0x4000_4800 => self.usarts[2].read(offset),
            0x4000_7000 => self.pwr.read(offset),
            0x4001_1000 => self.usarts[0].read(offset),
            0x4001_2000 => self.adc.read(offset, now.fs),
            0x4001_3000 => self.spis[0].read(offset),
            0x4001_3800 => self.exti.read_configuration(offset),
            0x4001_3C00 => self.exti.read(offset),
            0x4002_0000 | 0x4002_0400 | 0x4002_0800 => self.ports[port(address)].read(offset),
            0x4002_3800 => self.rcc.read(offset, now),
            0x4002_3C00 => self.flash.read(offset, now.fs),
            0xE000_0000.. => self.core.read(address, now),
            _ => None,
        };
        self.follow_lines();
        value.ok_or_else(|| unknown("reads", address))
    }

    /// The core writes a register.
    pub fn write(&mut self, address: u32, value: u32, size: usize, now: Moment) -> Result<(), Complaint> {
        self.check_clock(address)?;
        let offset = address & 0x3FF;
        let clocks = now.clocks;
        let done = match address & !0x3FF {
            0x4000_0000 => self.timers[0].write(offset, value, now),
            0x4000_0800 => self.timers[1].write(offset, value, now),
            0x4000_0C00 => self.timers[2].write(offset, value, now),
            0x4000_3000 => self.watchdog.write(offset, value, now, self.oscillators.low_speed_hz),
            0x4000_3800 => self.spis[1].write(offset, value, now.fs, clocks.bus_1_hz),
            0x4000_4400 => self.usarts[1].write(offset, value, now, clocks.bus_1_hz),
            0x4000_4800 => self.usarts[2].write(offset, value, now, clocks.bus_1_hz),
            0x4000_7000 => self.pwr.write(offset, value),
            0x4001_1000 => self.usarts[0].write(offset, value, now, clocks.bus_2_hz),
            0x4001_2000 => self.adc.write(offset, value, now.fs, clocks.bus_2_hz),
            0x4001_3000 => self.spis[0].write(offset, value, now.fs, clocks.bus_2_hz),
            0x4001_3800 => self.exti.write_configuration(offset, value),
            0x4001_3C00 => self.exti.write(offset, value),
            0x4002_0000 | 0x4002_0400 | 0x4002_0800 => self.ports[port(address)].write(offset, value),
            0x4002_3800 => self.rcc.write(offset, value, now),
            0x4002_3C00 => self.flash.write(offset, value, now.fs),
            0xE000_0000.. => self.core.write(address, value, size, now),
            _ => None,
        };
        done.ok_or_else(|| unknown("writes", address))?;
        match address & !0x3FF {
            0x4002_0000 | 0x4002_0400 => self.follow_selects(),
            0x4002_3800 | 0x4000_3000 => self.follow_clocks(now.fs),
            _ => {}
        }
        self.follow_lines();
        self.rcc.complaint(self.flash.wait_states()).map_or(Ok(()), |text| Err(Complaint(text)))
    }

    /// The crystal stops.
    pub fn stop_crystal(&mut self, now_fs: u64) {
        self.oscillators.crystal_hz = None;
        self.rcc.stop_crystal();
        self.follow_clocks(now_fs);
        self.follow_lines();
    }

    /// Put other oscillators on the board; they count from the next reset on.
    pub fn set_oscillators(&mut self, oscillators: Oscillators) {
        self.oscillators = oscillators;
    }

    /// The supply, millivolts.
    pub fn set_supply(&mut self, supply_mv: u32) {
        self.pwr.supply_mv = supply_mv;
    }

    /// The clock of a UART of these three, Hz.
    pub fn serial_clock_hz(&self, uart: usize) -> f64 {
        self.clocks.map_or(0.0, |clocks| bus_hz(uart, clocks))
    }

    /// Levels of the three lights: green, yellow, red.
    pub fn lights(&self) -> [bool; 3] {
        [0, 1, 2].map(|pin| self.ports[2].pin(pin) == Pin::Output(true))
    }

    /// A wire into one of the UARTs.
    pub fn line(&mut self, uart: usize) -> &mut Line {
        &mut self.usarts[uart].line
    }

    fn is_alternate(&self, (port, pin): (usize, u32), function: u32) -> bool {
        self.ports[port].pin(pin) == Pin::Alternate(function)
    }

    fn is_selected(&self, spi: usize) -> bool {
        let (port, pin) = SELECT_PINS[spi];
        self.ports[port].pin(pin) == Pin::Output(false)
    }

    fn pass_bytes(&mut self, now_fs: u64, clocks: Clocks) {
        for i in 0..2 {
            let bus_hz = [clocks.bus_2_hz, clocks.bus_1_hz][i];
            while let Some((end_fs, sent)) = self.spis[i].finished(now_fs) {
                let has_pins = SPI_PINS[i].iter().all(|pin| self.is_alternate(*pin, SPI_FUNCTION));
                let answer = if has_pins { self.exchange(i, sent, end_fs, bus_hz) } else { 0xFF };
                self.spis[i].finish(end_fs, answer, bus_hz);
            }
        }
    }

    /// A byte to and from what is on this bus. With a wrong mode the bits are off by one; an open input reads as 1.
    fn exchange(&mut self, spi: usize, sent: u8, now_fs: u64, bus_hz: f64) -> u8 {
        let is_right = self.spis[spi].mode() == [MODE_1, MODE_0][spi];
        let sent = if is_right { sent } else { sent << 1 };
        let is_selected = self.is_selected(spi);
        let hz = self.spis[spi].hz(bus_hz) as u32;
        match (spi, &mut self.converter, &mut self.card) {
            (0, Some(converter), _) => converter.clock(sent),
            (1, _, Some(card)) if is_selected => card.clock(sent, ns(now_fs), hz),
            (1, _, Some(card)) => {
                card.clock_unselected(hz);
                0xFF
            }
            _ => 0xFF,
        }
    }

    fn convert(&mut self, now_fs: u64) {
        let (port, pin) = READY_PIN;
        while let Some(converter) = self.converter.as_mut().filter(|converter| converter.due_fs() <= now_fs) {
            let at_fs = converter.due_fs();
            if converter.convert(at_fs) {
                self.exti.edge(port as u32, pin, false);
            }
        }
        if let Some(converter) = &self.converter {
            let level = u16::from(converter.is_ready_high) << pin;
            self.ports[port].input = self.ports[port].input & !(1 << pin) | level;
        }
    }

    fn follow_selects(&mut self) {
        let is_selected = self.is_selected(0);
        if let Some(converter) = &mut self.converter {
            converter.select(is_selected);
        }
    }

    /// After a change of the clocks or of what is held in reset.
    fn follow_clocks(&mut self, now_fs: u64) {
        self.rcc.low_speed_forced = self.watchdog.is_on();
        let [_, _, _, bus_1, bus_2] = self.rcc.resets();
        for (timer, bit) in self.timers.iter_mut().zip([0, 2, 3]) {
            if bus_1 & 1 << bit != 0 {
                *timer = Timer::new(if bit == 2 { 0xFFFF } else { u32::MAX });
            }
        }
        for (spi, held) in self.spis.iter_mut().zip([bus_2 & 1 << 12, bus_1 & 1 << 14]) {
            if held != 0 {
                *spi = Spi::default();
            }
        }
        for (usart, held) in self.usarts.iter_mut().zip([bus_2 & 1 << 4, bus_1 & 1 << 17, bus_1 & 1 << 18]) {
            if held != 0 {
                usart.reset();
            }
        }
        if bus_2 & 1 << 8 != 0 {
            self.adc.reset();
        }
        self.clocks = self.rcc.clocks();
        if let Some(clocks) = self.clocks {
            self.timers.iter_mut().for_each(|timer| timer.set_clocks(Moment { fs: now_fs, clocks }));
        }
    }

    fn follow_lines(&mut self) {
        let nvic = &mut self.core.nvic;
        nvic.set_line(EXTI9_5, self.exti.lines() & 0x3E0 != 0);
        for (timer, interrupt) in self.timers.iter().zip(TIMERS) {
            nvic.set_line(interrupt, timer.wants_interrupt());
        }
        for (usart, interrupt) in self.usarts.iter().zip(USARTS) {
            nvic.set_line(interrupt, usart.wants_interrupt());
        }
        nvic.set_nmi(self.rcc.has_crystal_failed());
    }

    /// A peripheral without its clock reads as nothing and takes nothing.
    fn check_clock(&self, address: u32) -> Result<(), Complaint> {
        let (bus, bit) = match address & !0x3FF {
            0x4000_0000 => (3, 0),
            0x4000_0800 => (3, 2),
            0x4000_0C00 => (3, 3),
            0x4000_3800 => (3, 14),
            0x4000_4400 => (3, 17),
            0x4000_4800 => (3, 18),
            0x4000_7000 => (3, 28),
            0x4001_1000 => (4, 4),
            0x4001_2000 => (4, 8),
            0x4001_3000 => (4, 12),
            0x4001_3800 => (4, 14),
            0x4002_0000..=0x4002_0BFF => (0, port(address) as u32),
            _ => return Ok(()),
        };
        if self.rcc.is_enabled(bus, bit) {
            return Ok(());
        }
        Err(Complaint(format!("uses {} while it has no clock", name(address))))
    }
}

fn timers() -> [Timer; 3] {
    [u32::MAX, 0xFFFF, u32::MAX].map(Timer::new)
}

/// The clock of a UART of these three.
fn bus_hz(uart: usize, clocks: Clocks) -> f64 {
    if uart == 0 { clocks.bus_2_hz } else { clocks.bus_1_hz }
}

fn port(address: u32) -> usize {
    (address as usize & 0xFFFF) / 0x400
}

fn unknown(does: &str, address: u32) -> Complaint {
    Complaint(format!("{does} {address:#010x} ({}), which nothing here models", name(address)))
}

/// Name and offset of a register.
fn name(address: u32) -> String {
    let block = match address & !0x3FF {
        0x4000_0000 => "TIM2",
        0x4000_0800 => "TIM4",
        0x4000_0C00 => "TIM5",
        0x4000_3000 => "IWDG",
        0x4000_3800 => "SPI2",
        0x4000_4400 => "USART2",
        0x4000_4800 => "USART3",
        0x4000_7000 => "PWR",
        0x4001_1000 => "USART1",
        0x4001_2000 => "ADC",
        0x4001_3000 => "SPI1",
        0x4001_3800 => "SYSCFG",
        0x4001_3C00 => "EXTI",
        0x4002_0000..=0x4002_23FF => return format!("GPIO{}+{:#x}", (b'A' + port(address) as u8) as char, address & 0x3FF),
        0x4002_3800 => "RCC",
        0x4002_3C00 => "FLASH",
        0xE000_0000.. => "core",
        _ => "?",
    };
    format!("{block}+{:#x}", address & 0x3FF)
}

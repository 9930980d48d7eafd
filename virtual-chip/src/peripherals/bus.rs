//! Which address is whose, and what time does to all of them.

use super::adc::Adc;
use super::addresses::{port, unknown};
use super::complaint::Complaint;
use super::core::Core;
use super::exti::Exti;
use super::flash::{Cells, Flash};
use super::gpio::Gpio;
use super::pwr::Pwr;
use super::rcc::Rcc;
use super::spi::Spi;
use super::timer::Timer;
use super::usart::Usart;
use super::watchdog::Watchdog;
use crate::board::{Board, Oscillators};
use crate::clocks::{Clocks, Moment};
use crate::time::NEVER_FS;
use crate::wires::converter::Converter;
use crate::wires::pulses::Pulses;
use crate::wires::serial::Line;
use towmag_virtual_body::sd::SdCard;

/// All peripherals, and what is wired to them.
pub struct Bus {
    /// The clocks; `None` while the core has none.
    pub clocks: Option<Clocks>,
    pub(super) oscillators: Oscillators,
    /// Reset and clock control.
    pub rcc: Rcc,
    pwr: Pwr,
    /// The flash interface.
    pub flash: Flash,
    /// Ports A to C.
    pub ports: [Gpio; 3],
    pub(super) exti: Exti,
    /// USART1 to 3.
    pub usarts: [Usart; 3],
    pub(super) spis: [Spi; 2],
    /// TIM2, TIM4, TIM5.
    pub(super) timers: [Timer; 3],
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
        self.pass_serial(now);
        self.pass_spi(now);
        self.timers.iter_mut().for_each(|timer| timer.elapse(now));
        self.convert(now_fs);
        self.pass_pulses(now);
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

    /// Put other oscillators on the board; they count from the next reset on.
    pub fn set_oscillators(&mut self, oscillators: Oscillators) {
        self.oscillators = oscillators;
    }

    /// A wire into one of the UARTs.
    pub fn line(&mut self, uart: usize) -> &mut Line {
        &mut self.usarts[uart].line
    }
}

/// TIM2, TIM4 and TIM5 after a reset.
pub(super) fn timers() -> [Timer; 3] {
    [u32::MAX, 0xFFFF, u32::MAX].map(Timer::new)
}

//! What follows from the registers of reset and clock control for all the others, and from all of them for the interrupts.

use super::addresses::{name, port};
use super::bus::{Bus, timers};
use super::complaint::Complaint;
use super::spi::Spi;
use crate::clocks::Moment;

/// Interrupts of the chip.
const EXTI9_5: u32 = 23;
const TIMERS: [u32; 3] = [28, 30, 50];
const USARTS: [u32; 3] = [37, 38, 39];

/// Pins that have one interrupt together.
const LINES_9_TO_5: u32 = 0x3E0;

impl Bus {
    /// The crystal stops.
    pub fn stop_crystal(&mut self, now_fs: u64) {
        self.oscillators.crystal_hz = None;
        self.rcc.stop_crystal();
        self.follow_clocks(now_fs);
        self.follow_lines();
    }

    /// After a change of the clocks or of what is held in reset.
    pub(super) fn follow_clocks(&mut self, now_fs: u64) {
        self.rcc.low_speed_forced = self.watchdog.is_on();
        self.hold_in_reset();
        self.clocks = self.rcc.clocks();
        if let Some(clocks) = self.clocks {
            self.timers.iter_mut().for_each(|timer| timer.set_clocks(Moment { fs: now_fs, clocks }));
        }
    }

    fn hold_in_reset(&mut self) {
        let [_, _, _, bus_1, bus_2] = self.rcc.resets();
        for ((timer, new), bit) in self.timers.iter_mut().zip(timers()).zip([0, 2, 3]) {
            if bus_1 & 1 << bit != 0 {
                *timer = new;
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
    }

    /// The interrupts that are wanted now.
    pub(super) fn follow_lines(&mut self) {
        let nvic = &mut self.core.nvic;
        nvic.set_line(EXTI9_5, self.exti.lines() & LINES_9_TO_5 != 0);
        for (timer, interrupt) in self.timers.iter().zip(TIMERS) {
            nvic.set_line(interrupt, timer.wants_interrupt());
        }
        for (usart, interrupt) in self.usarts.iter().zip(USARTS) {
            nvic.set_line(interrupt, usart.wants_interrupt());
        }
        nvic.set_nmi(self.rcc.has_crystal_failed());
    }

    /// A peripheral without its clock reads as nothing and takes nothing: the program is wrong that uses it.
    pub(super) fn check_clock(&self, address: u32) -> Result<(), Complaint> {
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

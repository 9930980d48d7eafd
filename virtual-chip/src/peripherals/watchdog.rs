//! The independent watchdog (RM0090, 21).

use crate::clocks::Moment;
use crate::time::{NEVER_FS, period_fs};

const START: u32 = 0xCCCC;
const UNLOCK: u32 = 0x5555;
const FEED: u32 = 0xAAAA;

/// Periods of its oscillator until a new prescaler or reload value is taken over.
const TAKE_OVER_PERIODS: u64 = 5;

/// The registers.
#[derive(Clone, Debug)]
pub struct Watchdog {
    is_on: bool,
    is_unlocked: bool,
    prescaler: u32,
    reload: u32,
    /// When the prescaler and the reload value that were written hold, and what held before.
    prescaler_from: (u64, u32),
    reload_from: (u64, u32),
    /// Periods of the oscillator that were left at some time, femtoseconds.
    left: u64,
    at_fs: u64,
    oscillator_fs: u64,
}

impl Watchdog {
    /// After a reset.
    pub fn new() -> Self {
        Self {
            is_on: false,
            is_unlocked: false,
            prescaler: 0,
            reload: 0xFFF,
            prescaler_from: (0, 0),
            reload_from: (0, 0xFFF),
            left: 0,
            at_fs: 0,
            oscillator_fs: NEVER_FS,
        }
    }

    /// Whether it runs: then so does the low-speed oscillator.
    pub fn is_on(&self) -> bool {
        self.is_on
    }

    /// Read a register.
    pub fn read(&mut self, offset: u32, now: Moment) -> Option<u32> {
        let is_coming = |from: (u64, u32)| u32::from(now.fs < from.0);
        Some(match offset {
            0x00 => 0,
            0x04 => self.prescaler,
            0x08 => self.reload,
            0x0C => is_coming(self.prescaler_from) | is_coming(self.reload_from) << 1,
            _ => return None,
        })
    }

    /// Write a register. `low_speed_hz` is what its oscillator has, also while it is still off.
    pub fn write(&mut self, offset: u32, value: u32, now: Moment, low_speed_hz: f64) -> Option<()> {
        self.oscillator_fs = if low_speed_hz > 0.0 { period_fs(low_speed_hz) } else { NEVER_FS };
        self.elapse(now.fs);
        let from_fs = now.fs.saturating_add(self.oscillator_fs.saturating_mul(TAKE_OVER_PERIODS));
        match (offset, value) {
            (0x00, START) => {
                self.is_on = true;
                self.feed(now.fs);
            }
            (0x00, UNLOCK) => self.is_unlocked = true,
            (0x00, FEED) => self.feed(now.fs),
            (0x04, _) if self.is_unlocked => {
                self.prescaler_from = (from_fs, self.prescaler);
                self.prescaler = value & 7;
            }
            (0x08, _) if self.is_unlocked => {
                self.reload_from = (from_fs, self.reload);
                self.reload = value & 0xFFF;
            }
            (0x04 | 0x08, _) => {}
            _ => return None,
        }
        Some(())
    }

    /// When it resets the chip.
    pub fn due_fs(&self) -> u64 {
        if self.is_on { self.at_fs.saturating_add(self.left.saturating_mul(self.oscillator_fs)) } else { NEVER_FS }
    }

    fn elapse(&mut self, now_fs: u64) {
        if self.is_on {
            let periods = (now_fs - self.at_fs) / self.oscillator_fs;
            self.left = self.left.saturating_sub(periods);
            self.at_fs += periods * self.oscillator_fs;
        }
    }

    fn feed(&mut self, now_fs: u64) {
        let held = |from: (u64, u32), new: u32| if now_fs < from.0 { from.1 } else { new };
        let divider = 4_u64 << held(self.prescaler_from, self.prescaler).min(6);
        self.left = (u64::from(held(self.reload_from, self.reload)) + 1) * divider;
        self.at_fs = now_fs;
        self.is_unlocked = false;
    }
}

impl Default for Watchdog {
    fn default() -> Self {
        Self::new()
    }
}

//! One general-purpose timer that counts up: prescaler, reload, one pulse, and captures of its inputs (RM0090, 18).

use crate::clocks::Moment;
use crate::time::{NEVER_FS, period_fs};

const ON: u32 = 1;
const NO_UPDATES: u32 = 1 << 1;
const UPDATES_BY_OVERFLOW_ONLY: u32 = 1 << 2;
const ONE_PULSE: u32 = 1 << 3;
const UPDATED: u32 = 1;

/// The registers.
pub struct Timer {
    control: u32,
    interrupts: u32,
    status: u32,
    modes: [u32; 2],
    channels: u32,
    prescaler: u32,
    reload: u32,
    captures: [u32; 4],
    option: u32,
    largest: u32,
    divider: u64,
    clock_fs: u64,
    count: u32,
    /// When the counter got to `count`.
    at_fs: u64,
    next_low_speed_fs: u64,
}

impl Timer {
    /// After a reset; its counter goes to `largest`.
    pub fn new(largest: u32) -> Self {
        Self {
            control: 0,
            interrupts: 0,
            status: 0,
            modes: [0; 2],
            channels: 0,
            prescaler: 0,
            reload: largest,
            captures: [0; 4],
            option: 0,
            largest,
            divider: 1,
            clock_fs: 1,
            count: 0,
            at_fs: 0,
            next_low_speed_fs: NEVER_FS,
        }
    }

    /// The clocks have become these.
    pub fn set_clocks(&mut self, now: Moment) {
        self.elapse(now);
        self.clock_fs = period_fs(now.clocks.timers_1_hz);
        self.plan_low_speed(now);
    }

    /// Read a register.
    pub fn read(&mut self, offset: u32, now: Moment) -> Option<u32> {
        self.elapse(now);
        Some(match offset {
            0x00 => self.control,
            0x0C => self.interrupts,
            0x10 => self.status,
            0x18 | 0x1C => self.modes[(offset as usize - 0x18) / 4],
            0x20 => self.channels,
            0x24 => self.count,
            0x28 => self.prescaler,
            0x2C => self.reload,
            0x34..=0x40 => {
                let channel = (offset - 0x34) / 4;
                self.status &= !(2 << channel);
                self.captures[channel as usize]
            }
            0x50 => self.option,
            _ => return None,
        })
    }

    /// Write a register.
    pub fn write(&mut self, offset: u32, value: u32, now: Moment) -> Option<()> {
        self.elapse(now);
        match offset {
            0x00 => self.control = value,
            0x0C => self.interrupts = value,
            0x10 => self.status &= value,
            0x14 => self.generate(value),
            0x18 | 0x1C => self.modes[(offset as usize - 0x18) / 4] = value,
            0x20 => self.channels = value,
            0x24 => self.count = value & self.largest,
            0x28 => self.prescaler = value & 0xFFFF,
            0x2C => self.reload = value & self.largest,
            0x50 => self.option = value,
            _ => return None,
        }
        self.at_fs = if matches!(offset, 0x00 | 0x14 | 0x24) { now.fs } else { self.at_fs };
        self.plan_low_speed(now);
        Some(())
    }

    /// Whether it counts to its end and stops there: the program waits for that.
    pub fn is_in_pulse(&self) -> bool {
        self.control & (ON | ONE_PULSE) == ON | ONE_PULSE
    }

    /// Whether its interrupt is wanted.
    pub fn wants_interrupt(&self) -> bool {
        self.status & self.interrupts & 0x1F != 0
    }

    /// When something happens that nobody has to look for.
    pub fn due_fs(&self) -> u64 {
        let wants_overflow = self.is_on() && self.interrupts & UPDATED != 0 || self.is_in_pulse();
        let overflow_fs = if wants_overflow { self.overflow_fs() } else { NEVER_FS };
        overflow_fs.min(self.next_low_speed_fs)
    }

    /// Count on to now.
    pub fn elapse(&mut self, now: Moment) {
        while self.next_low_speed_fs <= now.fs {
            let at_fs = self.next_low_speed_fs;
            self.count_to(at_fs);
            self.capture_now(3);
            self.plan_low_speed(Moment { fs: at_fs, ..now });
        }
        self.count_to(now.fs);
    }

    /// A rising edge at the input of channel 1.
    pub fn rising_edge_1(&mut self, now: Moment) {
        self.elapse(now);
        let is_input = self.modes[0] & 0b11 == 0b01;
        let is_rising = self.channels & 0b1011 == 0b0001;
        if self.is_on() && is_input && is_rising {
            self.capture_now(0);
        }
    }

    fn is_on(&self) -> bool {
        self.control & ON != 0
    }

    fn tick_fs(&self) -> u64 {
        self.divider * self.clock_fs
    }

    fn overflow_fs(&self) -> u64 {
        let ticks = (u64::from(self.reload) + 1).saturating_sub(self.count.into()).max(1);
        self.at_fs + ticks * self.tick_fs()
    }

    fn count_to(&mut self, now_fs: u64) {
        while self.is_on() && self.overflow_fs() <= now_fs {
            self.at_fs = self.overflow_fs();
            self.update();
            if self.control & ONE_PULSE != 0 {
                self.control &= !ON;
            }
        }
        if self.is_on() {
            let ticks = now_fs.saturating_sub(self.at_fs) / self.tick_fs();
            self.count += ticks as u32;
            self.at_fs += ticks * self.tick_fs();
        }
    }

    /// The update event.
    fn update(&mut self) {
        self.count = 0;
        if self.control & NO_UPDATES == 0 {
            self.divider = u64::from(self.prescaler) + 1;
            self.status |= UPDATED;
        }
    }

    /// By software.
    fn generate(&mut self, value: u32) {
        if value & 1 == 0 {
            return;
        }
        let status = self.status;
        self.update();
        if self.control & UPDATES_BY_OVERFLOW_ONLY != 0 {
            self.status = status;
        }
    }

    fn capture_now(&mut self, channel: u32) {
        let flag = 2 << channel;
        if self.status & flag != 0 {
            self.status |= flag << 8;
        }
        self.status |= flag;
        self.captures[channel as usize] = self.count;
    }

    /// Input 4 of TIM5 can be the low-speed oscillator.
    fn plan_low_speed(&mut self, now: Moment) {
        let is_input = self.modes[1] >> 8 & 0b11 == 0b01 && self.channels & 1 << 12 != 0;
        let is_low_speed = self.option >> 6 & 0b11 == 0b01 && now.clocks.low_speed_hz > 0.0;
        self.next_low_speed_fs = NEVER_FS;
        if self.is_on() && is_input && is_low_speed {
            let edges_fs = period_fs(now.clocks.low_speed_hz) << (self.modes[1] >> 10 & 0b11);
            self.next_low_speed_fs = (now.fs / edges_fs + 1) * edges_fs;
        }
    }
}

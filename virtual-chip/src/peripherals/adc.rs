//! The first analogue-to-digital converter: one channel, started by software (RM0090, 13).

use crate::time::{NEVER_FS, period_fs};

const DONE: u32 = 1 << 1;
const ON: u32 = 1;
const START: u32 = 1 << 30;

/// Periods of its clock for a conversion with the longest sampling, and of the bus for one of that clock, by ADCPRE.
const CONVERSION_PERIODS: u64 = 492;
const DIVIDERS: [u64; 4] = [2, 4, 6, 8];

/// The registers.
#[derive(Clone, Debug)]
pub struct Adc {
    status: u32,
    control: [u32; 2],
    sampling: [u32; 2],
    sequence: [u32; 3],
    common: u32,
    data: u32,
    ready_fs: u64,
    /// What each channel reads, counts.
    pub counts: [u16; 16],
}

impl Default for Adc {
    fn default() -> Self {
        Self {
            status: 0,
            control: [0; 2],
            sampling: [0; 2],
            sequence: [0; 3],
            common: 0,
            data: 0,
            ready_fs: NEVER_FS,
            counts: [0; 16],
        }
    }
}

impl Adc {
    /// A reset: what is at the inputs stays.
    pub fn reset(&mut self) {
        *self = Self { counts: self.counts, common: self.common, ..Self::default() };
    }

    /// Read a register.
    pub fn read(&mut self, offset: u32, now_fs: u64) -> Option<u32> {
        self.elapse(now_fs);
        Some(match offset {
            0x00 => self.status,
            0x04 | 0x08 => self.control[(offset as usize - 0x04) / 4],
            0x0C | 0x10 => self.sampling[(offset as usize - 0x0C) / 4],
            0x2C..=0x34 => self.sequence[(offset as usize - 0x2C) / 4],
            0x4C => {
                self.status &= !DONE;
                self.data
            }
            0x304 => self.common,
            _ => return None,
        })
    }

    /// Write a register. The bus that drives it runs at `bus_hz`.
    pub fn write(&mut self, offset: u32, value: u32, now_fs: u64, bus_hz: f64) -> Option<()> {
        self.elapse(now_fs);
        match offset {
            0x00 => self.status &= value,
            0x04 | 0x08 => self.control[(offset as usize - 0x04) / 4] = value & !START,
            0x0C | 0x10 => self.sampling[(offset as usize - 0x0C) / 4] = value,
            0x2C..=0x34 => self.sequence[(offset as usize - 0x2C) / 4] = value,
            0x304 => self.common = value,
            _ => return None,
        }
        if offset == 0x08 && value & (START | ON) == START | ON {
            let divider = DIVIDERS[(self.common >> 16 & 0b11) as usize];
            self.ready_fs = now_fs + CONVERSION_PERIODS * divider * period_fs(bus_hz);
        }
        Some(())
    }

    fn elapse(&mut self, now_fs: u64) {
        if now_fs >= self.ready_fs {
            self.ready_fs = NEVER_FS;
            self.status |= DONE;
            self.data = self.counts[(self.sequence[2] & 0xF) as usize].into();
        }
    }
}

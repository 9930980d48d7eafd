//! The flash interface: wait states, programming and erasing the two sectors of the settings, option bytes (RM0090, 3).

use crate::time::fs;

/// Where the settings begin, counted from the first address of the flash, and their sectors.
pub const SETTINGS: usize = 0xC_0000;
const SECTOR_LEN: usize = 0x2_0000;
const FIRST_SECTOR: u32 = 10;

const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];
const OPTION_KEYS: [u32; 2] = [0x0819_2A3B, 0x4C5D_6E7F];

const PROGRAM: u32 = 1;
const ERASE: u32 = 1 << 1;
const START: u32 = 1 << 16;
const LOCK: u32 = 1 << 31;
const OPTION_LOCK: u32 = 1;
const OPTION_START: u32 = 1 << 1;

const BUSY: u32 = 1 << 16;
const SEQUENCE: u32 = 1 << 7;
const PARALLELISM: u32 = 1 << 6;
const ERRORS: u32 = 0b1111_0011;

/// What it takes, seconds: data sheet DS8626, by bytes, typical.
const PROGRAM_S: f64 = 16e-6;
const ERASE_S: f64 = 2.0;
const OPTIONS_S: f64 = 0.2;

/// What stays without power.
#[derive(Clone, Debug)]
pub struct Cells {
    /// The two sectors of the settings.
    pub settings: Vec<u8>,
    /// The option bytes as FLASH_OPTCR shows them.
    pub options: u32,
    /// How often the option bytes were programmed.
    pub option_programmings: u32,
}

impl Default for Cells {
    /// As the chip is delivered.
    fn default() -> Self {
        Self { settings: vec![0xFF; 2 * SECTOR_LEN], options: 0x0FFF_AAEC, option_programmings: 0 }
    }
}

/// The registers and the cells.
pub struct Flash {
    /// What stays without power.
    pub cells: Cells,
    access: u32,
    keys: [usize; 2],
    control: u32,
    option_control: u32,
    errors: u32,
    busy_until_fs: u64,
    /// The power goes within so many operations; the last of them does not come to its end.
    pub cut_after: Option<u32>,
    /// The power is gone.
    pub is_cut: bool,
}

impl Flash {
    /// After a reset.
    pub fn new(cells: Cells) -> Self {
        Self {
            option_control: cells.options | OPTION_LOCK,
            cells,
            access: 0,
            keys: [0; 2],
            control: LOCK,
            errors: 0,
            busy_until_fs: 0,
            cut_after: None,
            is_cut: false,
        }
    }

    /// A reset: the registers begin anew.
    pub fn reset(&mut self) {
        let cells = std::mem::take(&mut self.cells);
        *self = Self { cut_after: self.cut_after, ..Self::new(cells) };
    }

    /// The processor is not served before.
    pub fn busy_until_fs(&self) -> u64 {
        self.busy_until_fs
    }

    /// Wait states of a read.
    pub fn wait_states(&self) -> u32 {
        self.access & 0xF
    }

    /// Read a register.
    pub fn read(&mut self, offset: u32, now_fs: u64) -> Option<u32> {
        let busy = if now_fs < self.busy_until_fs { BUSY } else { 0 };
        Some(match offset {
            0x00 => self.access,
            0x0C => self.errors | busy,
            0x10 => self.control,
            0x14 => self.option_control,
            _ => return None,
        })
    }

    /// Write a register.
    pub fn write(&mut self, offset: u32, value: u32, now_fs: u64) -> Option<()> {
        match offset {
            0x00 => self.access = value & !0x1800,
            0x04 => {
                if next_key(&mut self.keys[0], KEYS, value) {
                    self.control &= !LOCK;
                }
            }
            0x08 => {
                if next_key(&mut self.keys[1], OPTION_KEYS, value) {
                    self.option_control &= !OPTION_LOCK;
                }
            }
            0x0C => self.errors &= !(value & ERRORS),
            0x10 if self.control & LOCK == 0 => return self.write_control(value, now_fs),
            0x14 if self.option_control & OPTION_LOCK == 0 => self.write_options(value, now_fs),
            0x10 | 0x14 => {}
            _ => return None,
        }
        Some(())
    }

    /// The processor writes a byte to the cells, counted from the first of the settings.
    pub fn program(&mut self, at: usize, value: u32, size: usize, now_fs: u64) {
        if self.control & (LOCK | PROGRAM) != PROGRAM {
            self.errors |= SEQUENCE;
        } else if size != 1 << (self.control >> 8 & 0b11) {
            self.errors |= PARALLELISM;
        } else {
            let ends = self.begin(PROGRAM_S, now_fs);
            for (cell, new) in self.cells.settings[at..at + size].iter_mut().zip(value.to_le_bytes()) {
                // Should the power go meanwhile, some of the bits are programmed.
                *cell &= if ends { new } else { new | 0b0101_1010 };
            }
        }
    }

    fn write_control(&mut self, value: u32, now_fs: u64) -> Option<()> {
        self.control = value & !START;
        if value & START == 0 || value & ERASE == 0 {
            return Some(());
        }
        let sector = (value >> 3 & 0x1F).checked_sub(FIRST_SECTOR).filter(|sector| *sector < 2)? as usize;
        let ends = self.begin(ERASE_S, now_fs);
        let cells = &mut self.cells.settings[sector * SECTOR_LEN..(sector + 1) * SECTOR_LEN];
        if ends {
            cells.fill(0xFF);
        } else {
            cells.iter_mut().enumerate().for_each(|(i, cell)| *cell |= (i as u8).wrapping_mul(37));
        }
        Some(())
    }

    fn write_options(&mut self, value: u32, now_fs: u64) {
        self.option_control = value & !OPTION_START;
        if value & OPTION_START == 0 {
            return;
        }
        self.cells.option_programmings += 1;
        let ends = self.begin(OPTIONS_S, now_fs);
        self.cells.options = if ends { self.option_control & !(OPTION_LOCK | OPTION_START) } else { 0x0FFF_FFEC };
    }

    /// Whether the operation comes to its end.
    fn begin(&mut self, takes_s: f64, now_fs: u64) -> bool {
        self.busy_until_fs = self.busy_until_fs.max(now_fs) + fs(takes_s);
        self.cut_after = self.cut_after.map(|left| left.saturating_sub(1));
        self.is_cut = self.cut_after == Some(0);
        !self.is_cut
    }
}

/// Whether the register is unlocked by this key, the second after the first.
fn next_key(at: &mut usize, keys: [u32; 2], value: u32) -> bool {
    *at = if value == keys[*at] { *at + 1 } else { 0 };
    let is_last = *at == keys.len();
    if is_last {
        *at = 0;
    }
    is_last
}

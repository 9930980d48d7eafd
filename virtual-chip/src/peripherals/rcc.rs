//! Reset and clock control: oscillators, PLL, bus clocks, clocks and resets of the peripherals, reset flags (RM0090, 7).

use crate::board::Oscillators;
use crate::clocks::{Clocks, Moment};
use crate::time::{NEVER_FS, fs};

const CR_RESET: u32 = 0x0000_0083;
const HSI_ON: u32 = 1;
const HSE_ON: u32 = 1 << 16;
const HSE_READY: u32 = 1 << 17;
const CSS_ON: u32 = 1 << 19;
const PLL_ON: u32 = 1 << 24;
const PLL_READY: u32 = 1 << 25;
const LSI_ON: u32 = 1;
const LSI_READY: u32 = 1 << 1;
const REMOVE_FLAGS: u32 = 1 << 24;
const CSS_FLAG: u32 = 1 << 7;
const CLEAR_CSS_FLAG: u32 = 1 << 23;

/// What a crystal takes to start, and the PLL to lock, seconds.
const CRYSTAL_START_S: f64 = 2e-3;
const PLL_LOCK_S: f64 = 100e-6;

/// Reset flags of CSR.
pub const BROWN_OUT: u32 = 1 << 25;
/// The pin, which every reset pulls.
pub const PIN: u32 = 1 << 26;
/// Power-on.
pub const POWER_ON: u32 = 1 << 27;
/// By software.
pub const SOFTWARE: u32 = 1 << 28;
/// By the independent watchdog.
pub const WATCHDOG: u32 = 1 << 29;

/// What drives the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Internal,
    Crystal,
    Pll,
}

/// The registers.
pub struct Rcc {
    oscillators: Oscillators,
    cr: u32,
    pll_configuration: u32,
    cfgr: u32,
    interrupts: u32,
    csr: u32,
    /// AHB1, AHB2, AHB3, APB1, APB2.
    enabled: [u32; 5],
    resets: [u32; 5],
    source: Source,
    crystal_ready_fs: u64,
    pll_ready_fs: u64,
    /// The watchdog keeps the low-speed oscillator on.
    pub low_speed_forced: bool,
}

impl Rcc {
    /// After a reset for these reasons.
    pub fn new(oscillators: Oscillators, flags: u32) -> Self {
        Self {
            oscillators,
            cr: CR_RESET,
            pll_configuration: 0x2400_3010,
            cfgr: 0,
            interrupts: 0,
            csr: flags,
            enabled: [0x0010_0000, 0, 0, 0, 0],
            resets: [0; 5],
            source: Source::Internal,
            crystal_ready_fs: NEVER_FS,
            pll_ready_fs: NEVER_FS,
            low_speed_forced: false,
        }
    }

    /// Flags that a reset leaves, with those of the next.
    pub fn flags(&self) -> u32 {
        self.csr & 0xFE00_0000
    }

    /// Read a register.
    pub fn read(&mut self, offset: u32, now: Moment) -> Option<u32> {
        Some(match offset {
            0x00 => self.cr(now.fs),
            0x04 => self.pll_configuration,
            0x08 => {
                self.switch(now.fs);
                self.cfgr & !0b1100 | (self.source as u32) << 2
            }
            0x0C => self.interrupts,
            0x10 | 0x14 | 0x18 => self.resets[(offset as usize - 0x10) / 4],
            0x20 | 0x24 => self.resets[3 + (offset as usize - 0x20) / 4],
            0x30 | 0x34 | 0x38 => self.enabled[(offset as usize - 0x30) / 4],
            0x40 | 0x44 => self.enabled[3 + (offset as usize - 0x40) / 4],
            0x74 => self.csr | if self.has_low_speed() { LSI_READY } else { 0 },
            _ => return None,
        })
    }

    /// Write a register.
    pub fn write(&mut self, offset: u32, value: u32, now: Moment) -> Option<()> {
        match offset {
            0x00 => self.write_cr(value, now.fs),
            0x04 => self.pll_configuration = value,
            0x08 => {
                self.cfgr = value;
                self.switch(now.fs);
            }
            0x0C => self.write_interrupts(value),
            0x10 | 0x14 | 0x18 => self.resets[(offset as usize - 0x10) / 4] = value,
            0x20 | 0x24 => self.resets[3 + (offset as usize - 0x20) / 4] = value,
            0x30 | 0x34 | 0x38 => self.enabled[(offset as usize - 0x30) / 4] = value,
            0x40 | 0x44 => self.enabled[3 + (offset as usize - 0x40) / 4] = value,
            0x74 => {
                self.csr = self.csr & !LSI_ON | value & LSI_ON;
                if value & REMOVE_FLAGS != 0 {
                    self.csr &= LSI_ON;
                }
            }
            _ => return None,
        }
        Some(())
    }

    /// Whether a peripheral has its clock: number of the bus (AHB1, AHB2, AHB3, APB1, APB2), and bit.
    pub fn is_enabled(&self, bus: usize, bit: u32) -> bool {
        self.enabled[bus] & 1 << bit != 0
    }

    /// Peripherals that are being held in reset, of all buses.
    pub fn resets(&self) -> [u32; 5] {
        self.resets
    }

    /// The crystal stops. With the clock security system the core goes on from the internal oscillator, else it stands.
    pub fn stop_crystal(&mut self) {
        self.oscillators.crystal_hz = None;
        self.crystal_ready_fs = NEVER_FS;
        if self.cr & CSS_ON != 0 && self.cr & HSE_ON != 0 {
            self.cr &= !(HSE_ON | CSS_ON);
            if self.source == Source::Crystal || self.is_pll_on_crystal() {
                self.cr &= !PLL_ON;
                self.pll_ready_fs = NEVER_FS;
                self.source = Source::Internal;
                self.cfgr &= !0b11;
            }
            self.interrupts |= CSS_FLAG;
        }
    }

    /// Whether the interrupt that cannot be masked is pending.
    pub fn has_crystal_failed(&self) -> bool {
        self.interrupts & CSS_FLAG != 0
    }

    /// The clocks; `None` when the core has none.
    pub fn clocks(&self) -> Option<Clocks> {
        let internal_hz = self.oscillators.internal_hz;
        let system_hz = match self.source {
            Source::Internal => internal_hz,
            Source::Crystal => self.oscillators.crystal_hz?,
            Source::Pll => self.pll_hz()?.1,
        };
        let divided = |code: u32, first: u32| if code < first { 1.0 } else { f64::from(2 << (code - first)) };
        let core = match self.cfgr >> 4 & 0xF {
            code @ 0..=11 => divided(code, 8),
            code => f64::from(64 << (code - 12)),
        };
        let core_hz = system_hz / core;
        let bus_1 = divided(self.cfgr >> 10 & 7, 4);
        let bus_2 = divided(self.cfgr >> 13 & 7, 4);
        Some(Clocks {
            core_hz,
            bus_1_hz: core_hz / bus_1,
            bus_2_hz: core_hz / bus_2,
            timers_1_hz: core_hz / (bus_1 / 2.0).max(1.0),
            low_speed_hz: if self.has_low_speed() { self.oscillators.low_speed_hz } else { 0.0 },
        })
    }

    /// What the chip cannot stand, with so many wait states of the flash.
    pub fn complaint(&self, wait_states: u32) -> Option<String> {
        let clocks = self.clocks()?;
        // The internal oscillator may be off by some per cent: what is set is meant.
        let off = if self.source == Source::Internal || !self.is_pll_on_crystal() {
            self.oscillators.internal_hz / 16e6
        } else {
            1.0
        };
        let mhz = |hz: f64| hz / off / 1e6;
        let core_mhz = mhz(clocks.core_hz);
        let vco = self.pll_hz().filter(|_| self.source == Source::Pll).map_or(192e6, |(vco_hz, _)| vco_hz) / off / 1e6;
        if core_mhz > 168.5 || mhz(clocks.bus_1_hz) > 42.1 || mhz(clocks.bus_2_hz) > 84.2 {
            return Some(format!("overclocks the chip: {clocks:?}"));
        }
        if !(100.0..=432.5).contains(&vco) {
            return Some(format!("lets the PLL's oscillator run at {vco} MHz"));
        }
        (core_mhz > 30.1 * f64::from(wait_states + 1))
            .then(|| format!("reads the flash with {wait_states} wait states at {core_mhz} MHz"))
    }

    fn cr(&self, now_fs: u64) -> u32 {
        let crystal = if now_fs >= self.crystal_ready_fs { HSE_READY } else { 0 };
        let pll = if now_fs >= self.pll_ready_fs { PLL_READY } else { 0 };
        self.cr | HSI_ON << 1 | crystal | pll
    }

    fn write_cr(&mut self, value: u32, now_fs: u64) {
        let rises = value & !self.cr;
        let is_driven =
            matches!(self.source, Source::Crystal) || self.source == Source::Pll && self.is_pll_on_crystal();
        // What drives the core cannot be switched off.
        let value = if is_driven { value | HSE_ON } else { value };
        let value = if self.source == Source::Pll { value | PLL_ON } else { value };
        self.cr = value & !(HSE_READY | PLL_READY);
        if rises & HSE_ON != 0 && self.oscillators.crystal_hz.is_some() {
            self.crystal_ready_fs = now_fs + fs(CRYSTAL_START_S);
        }
        if value & HSE_ON == 0 {
            self.crystal_ready_fs = NEVER_FS;
        }
        if rises & PLL_ON != 0 && self.pll_hz().is_some() {
            self.pll_ready_fs = now_fs + fs(PLL_LOCK_S);
        }
        if value & PLL_ON == 0 {
            self.pll_ready_fs = NEVER_FS;
        }
    }

    fn write_interrupts(&mut self, value: u32) {
        let flag = if value & CLEAR_CSS_FLAG != 0 { 0 } else { self.interrupts & CSS_FLAG };
        self.interrupts = value & 0x3F00 | flag;
    }

    /// To what the software has asked for, if it is ready.
    fn switch(&mut self, now_fs: u64) {
        match self.cfgr & 0b11 {
            0 => self.source = Source::Internal,
            1 if now_fs >= self.crystal_ready_fs => self.source = Source::Crystal,
            2 if now_fs >= self.pll_ready_fs => self.source = Source::Pll,
            _ => {}
        }
    }

    fn has_low_speed(&self) -> bool {
        self.csr & LSI_ON != 0 || self.low_speed_forced
    }

    fn is_pll_on_crystal(&self) -> bool {
        self.pll_configuration & 1 << 22 != 0
    }

    /// The PLL's oscillator and what it gives the core, Hz; `None` without what it multiplies.
    fn pll_hz(&self) -> Option<(f64, f64)> {
        let bits = self.pll_configuration;
        let input_hz =
            if self.is_pll_on_crystal() { self.oscillators.crystal_hz? } else { self.oscillators.internal_hz };
        let vco_hz = input_hz / f64::from(bits & 0x3F) * f64::from(bits >> 6 & 0x1FF);
        Some((vco_hz, vco_hz / f64::from(2 * ((bits >> 16 & 0b11) + 1))))
    }
}

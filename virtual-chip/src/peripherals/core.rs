//! What the core itself has on its bus: interrupt controller, SysTick, system control and the debug unit.

use super::nvic::Nvic;
use crate::clocks::Moment;
use crate::time::period_fs;

const RESET_KEY: u32 = 0x05FA_0004;
const SYSTICK_MASK: u32 = 0x00FF_FFFF;
const SYSTICK_ON: u32 = 1;
const SYSTICK_INTERRUPT: u32 = 1 << 1;

/// The registers.
#[derive(Clone, Debug, Default)]
pub struct Core {
    /// The interrupt controller.
    pub nvic: Nvic,
    systick_control: u32,
    systick_reload: u32,
    systick_from_fs: u64,
    /// Where the vectors are; 0 is the alias of the flash.
    pub vectors: u32,
    system_priorities: [u32; 3],
    /// Who may use the floating-point unit.
    pub coprocessors: u32,
    trace: u32,
    cycle_counter_control: u32,
    freezes: [u32; 3],
    /// The software has asked for a reset.
    pub wants_reset: bool,
}

impl Core {
    /// Read a register.
    pub fn read(&mut self, address: u32, now: Moment) -> Option<u32> {
        let offset = address & 0xFFFF;
        Some(match address {
            0xE000_E010 => self.systick_control,
            0xE000_E014 => self.systick_reload,
            0xE000_E018 => self.systick(now),
            0xE000_E100..=0xE000_E4FF => return self.nvic.read(offset - 0xE000),
            0xE000_ED00 => 0x410F_C241,
            0xE000_ED04 => self.nvic.running(),
            0xE000_ED08 => self.vectors,
            0xE000_ED0C => 0xFA05_0000,
            0xE000_ED18..=0xE000_ED20 => self.system_priorities[(offset as usize - 0xED18) / 4],
            0xE000_ED88 => self.coprocessors,
            0xE000_EDF0 => 0, // no debugger
            0xE000_EDFC => self.trace,
            0xE000_1000 => self.cycle_counter_control,
            0xE004_2004..=0xE004_200C => self.freezes[(offset as usize - 0x2004) / 4],
            _ => return None,
        })
    }

    /// Write a register.
    pub fn write(&mut self, address: u32, value: u32, size: usize, now: Moment) -> Option<()> {
        let offset = address & 0xFFFF;
        match address {
            0xE000_E010 if value & SYSTICK_INTERRUPT == 0 => self.systick_control = value,
            0xE000_E014 => self.systick_reload = value & SYSTICK_MASK,
            0xE000_E018 => self.systick_from_fs = now.fs,
            0xE000_E100..=0xE000_E4FF => return self.nvic.write(offset - 0xE000, value, size),
            0xE000_ED08 => self.vectors = value,
            0xE000_ED0C => self.wants_reset |= value == RESET_KEY,
            0xE000_ED18..=0xE000_ED23 => self.write_priority(offset as usize - 0xED18, value, size),
            0xE000_ED88 => self.coprocessors = value,
            0xE000_EDFC => self.trace = value,
            0xE000_1000 => self.cycle_counter_control = value,
            0xE004_2004..=0xE004_200C => self.freezes[(offset as usize - 0x2004) / 4] = value,
            _ => return None,
        }
        Some(())
    }

    fn write_priority(&mut self, at: usize, value: u32, size: usize) {
        let mut bytes = self.system_priorities[at / 4].to_le_bytes();
        for (byte, new) in bytes[at % 4..].iter_mut().zip(value.to_le_bytes()).take(size) {
            *byte = new;
        }
        self.system_priorities[at / 4] = u32::from_le_bytes(bytes);
    }

    /// It counts the core's cycles down, also while the core sleeps.
    fn systick(&self, now: Moment) -> u32 {
        if self.systick_control & SYSTICK_ON == 0 {
            return 0;
        }
        let cycles = (now.fs - self.systick_from_fs) / period_fs(now.clocks.core_hz);
        let left = u64::from(self.systick_reload) - cycles % (u64::from(self.systick_reload) + 1);
        left as u32
    }
}

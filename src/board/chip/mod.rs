//! Pieces of an STM32F405 that more than one board uses. What the boards differ in, they get as arguments.

pub mod cost;
pub mod lights;
pub mod reset_cause;
pub mod retained_ram;
pub mod serial;
pub mod stack;
pub mod system;
pub mod timers;
pub mod vectors;
pub mod watchdog;

use towmag::store::FlashSectors;

/// The two last sectors of the flash, which the linker leaves alone (`memory.x`).
pub const SETTINGS: FlashSectors = FlashSectors { sectors: [0xC_0000, 0xE_0000], sector_len: 0x2_0000 };

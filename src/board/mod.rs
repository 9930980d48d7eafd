//! The boards that the firmware runs on, one folder each, behind the trait [`towmag::hardware::Board`]. This file chooses.
//!
//! A board has three things: `Hardware`, which implements the trait; `vectors`, which names the interrupts that the tasks
//! of `main.rs` are bound to; and `restart`, for panics. Pieces of the STM32F405 that more than one board uses are in
//! `chip`. How to add a board: `docs/extending.md`.

mod chip;
mod panic;

#[cfg(feature = "emulation")]
mod emulated;
#[cfg(feature = "emulation")]
use emulated as chosen;

#[cfg(not(feature = "emulation"))]
mod stm32f405;
#[cfg(not(feature = "emulation"))]
use stm32f405 as chosen;

pub use chosen::{Hardware, vectors};

use chosen::restart;
// Carries the messages of `defmt`.
use defmt_rtt as _;

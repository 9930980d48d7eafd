//! The boards that the firmware runs on, one folder each, behind the trait [`towmag::hardware::Board`]. This file chooses.
//!
//! A board gives `main.rs` three things: `Hardware`, which implements the trait; `vectors`, which names the interrupts
//! that the tasks are bound to; and `restart`, for panics. Pieces of the STM32F405 that more than one board uses are in
//! `chip`. How to add a board: `docs/extending.md`.

mod chip;
mod panic;

#[cfg(feature = "emulation")]
mod emulated;
#[cfg(not(feature = "emulation"))]
mod stm32f405;

#[cfg(feature = "emulation")]
pub use emulated::{Hardware, vectors};
#[cfg(not(feature = "emulation"))]
pub use stm32f405::{Hardware, vectors};

#[cfg(feature = "emulation")]
use emulated::restart;
#[cfg(not(feature = "emulation"))]
use stm32f405::restart;

// Carries the messages of `defmt`.
use defmt_rtt as _;

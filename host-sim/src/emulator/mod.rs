//! The real firmware image on an emulated STM32F405, in lock-step with a recording.
//!
//! ```text
//! recording -> Feed -> bytes ----> USART1 --+
//!                   -> counts -> Adc ------>| firmware in QEMU -> USART2 -> telemetry --+
//!                      (SPI frames)         |                  -> card.img -> log ------+-> compare, bit for bit
//!                   \-> the same bytes and frames, with the body's own stamps -> Twin --+
//! ```
//!
//! Time in the emulator stands still while the body waits for an SPI answer, so that a recording of an hour takes as long
//! as its instructions take. The `Twin` is given every byte and frame at the stamp that the body has noted for it, and
//! runs the same parser, converter driver, grid and core.
//!
//! A reset ends the emulator, and the next life of the body begins in another one, with the same card and flash. Twin,
//! telemetry and log are compared life by life.

mod card;
mod compare;
mod difference;
mod emulated;
mod error;
mod flash;
mod life;
mod lockstep;
mod machine;
mod onlooker;
mod run;
mod settings;
mod telemetry;
mod twin;

pub use crate::wire::{Fault, FaultKind};
pub use difference::Difference;
pub use emulated::Emulated;
pub use error::EmulatorError;
pub use machine::DEFAULT_IMAGE;
pub use onlooker::Onlooker;
pub use run::emulate;
pub use settings::{EmulationSettings, Typed};
pub use telemetry::{FIGURE_NAMES, Figures, in_instructions};

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
mod flash;
mod life;
mod machine;
mod run;
mod telemetry;
mod twin;

pub use crate::wire::{Fault, FaultKind};
pub use compare::Difference;
pub use machine::DEFAULT_IMAGE;
pub use run::{Emulated, EmulationSettings, Typed, emulate, in_instructions};
pub use telemetry::Figures;

/// Why an emulation failed.
#[derive(Debug, thiserror::Error)]
pub enum EmulatorError {
    /// There is no image.
    #[error("{path}: no firmware image there: build it with `cargo fw-emu`, or name one with --image")]
    NoImage {
        /// Where it was looked for.
        path: String,
    },
    /// There is no emulator.
    #[error("{program} is not installed: on Debian and Ubuntu, `apt install qemu-system-arm`")]
    NoQemu {
        /// What was looked for.
        program: String,
    },
    /// A file or socket of the emulation does not work.
    #[error("emulation: {what}: {source}")]
    Io {
        /// What was tried.
        what: &'static str,
        /// The system's own words.
        source: std::io::Error,
    },
    /// The emulator ended, or the firmware did not do what it must.
    #[error("emulation: {0}")]
    Broken(String),
    /// Body and replay differ.
    #[error("the emulated body differs from the replay of the same bytes: {0}")]
    Differs(Difference),
}

impl EmulatorError {
    fn io(what: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io { what, source }
    }

    /// Whether the user can mend it on the command line.
    pub fn is_bad_usage(&self) -> bool {
        matches!(self, Self::NoImage { .. } | Self::NoQemu { .. })
    }
}

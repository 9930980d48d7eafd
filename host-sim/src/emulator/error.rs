//! What can go wrong in an emulation.

use towmag::SettingsError;

use super::difference::Difference;
use crate::recording::RecordingError;

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
    /// The recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A setting is out of its range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// Body and replay differ.
    #[error("the emulated body differs from the replay of the same bytes: {0}")]
    Differs(#[from] Difference),
}

impl EmulatorError {
    pub(super) fn io(what: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io { what, source }
    }

    /// Whether the user can mend it on the command line.
    pub fn is_bad_usage(&self) -> bool {
        match self {
            Self::Recording(error) => error.is_bad_input(),
            Self::NoImage { .. } | Self::NoQemu { .. } | Self::Settings(_) => true,
            Self::Io { .. } | Self::Broken(_) | Self::Differs(_) => false,
        }
    }
}

//! Why settings are not stored.

use crate::settings::SettingsError;

/// Why settings were not stored, or could not be looked for. What was stored before still is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoreError<E> {
    /// The flash refuses.
    Flash(E),
    /// The flash takes the image and gives back something else.
    NotStored,
    /// The region does not fit the flash, or its sectors are no whole slots.
    Region,
    /// The settings are not valid.
    Settings(SettingsError),
    /// There is no sequence number left.
    WornOut,
}

impl<E: core::fmt::Debug> core::fmt::Display for StoreError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Flash(error) => write!(f, "the flash refuses: {error:?}"),
            Self::NotStored => write!(f, "the flash does not keep what is written to it"),
            Self::Region => write!(f, "the region does not fit the flash"),
            Self::Settings(error) => error.fmt(f),
            Self::WornOut => write!(f, "no sequence number is left"),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for StoreError<E> {}

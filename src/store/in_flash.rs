//! The settings that hold, together with the flash that they lie in.

use super::body_settings::Stored;
use super::error::StoreError;
use super::flash::SettingsStore;
use super::scan::{Condition, FlashSectors};
use embedded_storage::nor_flash::NorFlash;

/// The settings, and where they lie.
pub struct SettingsInFlash<F> {
    flash: F,
    /// `None` when the flash cannot be read: nothing can be stored then.
    store: Option<SettingsStore>,
    /// What holds.
    pub stored: Stored,
    condition: Condition,
}

/// Why settings do not outlive this session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SaveError<E> {
    /// The flash could not be read at the start.
    Unreadable,
    /// The store says.
    Store(StoreError<E>),
}

impl<E: core::fmt::Debug> core::fmt::Display for SaveError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unreadable => f.write_str("the flash cannot be read"),
            Self::Store(error) => error.fmt(f),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for SaveError<E> {}

impl<F: NorFlash> SettingsInFlash<F> {
    /// Read what lies in `sectors`; the defaults hold where there is nothing, or no flash.
    pub fn open(mut flash: F, sectors: FlashSectors) -> Self {
        match SettingsStore::open(&mut flash, sectors) {
            Ok((store, opened)) => {
                let stored = opened.stored.unwrap_or_default();
                Self { flash, store: Some(store), stored, condition: opened.condition }
            }
            Err(_) => Self { flash, store: None, stored: Stored::default(), condition: Condition::Lost },
        }
    }

    /// How the flash was found, or that it holds what was saved since.
    pub fn condition(&self) -> Condition {
        self.condition
    }

    /// Read the flash again: whether what was stored last is still there, `None` when nothing was stored yet.
    pub fn is_intact(&mut self) -> Option<bool> {
        match &self.store {
            Some(store) => store.is_intact(&mut self.flash),
            None => Some(false),
        }
    }

    /// Store what holds. May erase a sector.
    pub fn save(&mut self) -> Result<(), SaveError<F::Error>> {
        let store = self.store.as_mut().ok_or(SaveError::Unreadable)?;
        store.save(&mut self.flash, &self.stored).map_err(SaveError::Store)?;
        self.condition = Condition::Intact;
        Ok(())
    }
}

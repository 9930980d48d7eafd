//! Images of the settings in two sectors of the internal flash.
//!
//! Each image goes into the next blank slot of its sector, so that the one before it stays whole until the new one
//! is, and the sector need not be erased for it: erasing stops the STM32F405 for seconds. When a sector is full the other
//! one, which holds nothing but older images, is erased and taken into use. The image with the highest sequence
//! number and an intact CRC holds.

use super::body_settings::Stored;
use super::error::StoreError;
use super::image::{Content, SLOT_LEN, decode, encode, is_whole};
use super::scan::{FlashSectors, Opened, Place, condition, newest, read, survey};
use embedded_storage::nor_flash::{NorFlash, ReadNorFlash};

/// Slots that are tried for one image before the caller is told.
const ATTEMPTS: u32 = 4;

/// Knows where the latest image lies and where the next one goes. The flash is lent for each call.
#[derive(Clone, Debug)]
pub struct SettingsStore {
    region: FlashSectors,
    /// Sequence number of the next image; `None` when there is none left.
    sequence: Option<u32>,
    newest: Option<Place>,
    /// Sector and slot of the next image; beyond the last slot, a sector must be erased first.
    next: Place,
}

impl SettingsStore {
    /// Look for the latest intact image. Reads both sectors.
    pub fn open<F: ReadNorFlash>(flash: &mut F, region: FlashSectors) -> Result<(Self, Opened), StoreError<F::Error>> {
        if !region.fits(flash.capacity()) || !SLOT_LEN.is_multiple_of(F::READ_SIZE) {
            return Err(StoreError::Region);
        }
        let surveys = [survey(flash, &region, 0)?, survey(flash, &region, 1)?];
        let newest = newest(&surveys);
        let stored = match newest {
            Some(place) => match decode(&read(flash, &region, place)?) {
                Content::Image { stored, .. } => Some(stored),
                _ => None,
            },
            None => None,
        };
        let highest = surveys[0].highest.max(surveys[1].highest);
        let sequence = highest.map_or(Some(1), |highest| highest.checked_add(1));
        // Without an image of one's own begin with an erasure, and keep what another firmware stored last.
        let keep = usize::from(surveys[0].highest <= surveys[1].highest);
        let next = newest.map_or(Place { sector: keep, slot: region.slots() }, |Place { sector, .. }| Place {
            sector,
            slot: surveys[sector & 1].end,
        });
        let opened = Opened { stored, condition: condition(&region, &surveys, newest) };
        Ok((Self { region, sequence, newest, next }, opened))
    }

    /// Whether the image that holds still reads as a whole one, CRC included; `None` where there is none. What is in it has
    /// been looked at before.
    pub fn is_intact<F: ReadNorFlash>(&self, flash: &mut F) -> Option<bool> {
        let place = self.newest?;
        Some(read(flash, &self.region, place).is_ok_and(|bytes| is_whole(&bytes)))
    }

    /// Store settings and coefficients. They hold from the return on; the earlier ones hold after any error and after
    /// any power cut before it, unless the new ones were whole by then. May erase a sector.
    pub fn save<F: NorFlash>(&mut self, flash: &mut F, stored: &Stored) -> Result<(), StoreError<F::Error>> {
        if !SLOT_LEN.is_multiple_of(F::WRITE_SIZE) {
            return Err(StoreError::Region);
        }
        stored.settings.validate().map_err(StoreError::Settings)?;
        let mut error = StoreError::NotStored;
        for _ in 0..ATTEMPTS {
            match self.attempt(flash, stored) {
                Ok(true) => return Ok(()),
                Ok(false) => error = StoreError::NotStored,
                Err(StoreError::WornOut) => return Err(StoreError::WornOut),
                Err(failure) => error = failure,
            }
        }
        Err(error)
    }

    /// Saves until the next one has to erase a sector; 0 when it has to.
    pub fn saves_before_erasing(&self) -> u32 {
        self.region.slots().saturating_sub(self.next.slot)
    }

    /// Write into the next slot and read it back; false when it comes back different.
    fn attempt<F: NorFlash>(&mut self, flash: &mut F, stored: &Stored) -> Result<bool, StoreError<F::Error>> {
        if self.next.slot >= self.region.slots() {
            self.change_sector(flash)?;
        }
        let sequence = self.sequence.ok_or(StoreError::WornOut)?;
        let image = encode(sequence, stored).ok_or(StoreError::NotStored)?;
        let place = self.next;
        // Whatever becomes of the write, neither the slot nor the number is used again.
        self.next.slot += 1;
        self.sequence = sequence.checked_add(1);
        flash.write(self.region.offset(place), &image).map_err(StoreError::Flash)?;
        let is_stored = read(flash, &self.region, place)? == image;
        if is_stored {
            self.newest = Some(place);
        }
        Ok(is_stored)
    }

    /// Erase the sector that does not hold the latest image, and go on there.
    fn change_sector<F: NorFlash>(&mut self, flash: &mut F) -> Result<(), StoreError<F::Error>> {
        let sector = 1 - (self.newest.map_or(self.next.sector, |place| place.sector) & 1);
        let start = self.region.offset(Place { sector, slot: 0 });
        flash.erase(start, start + self.region.sector_len).map_err(StoreError::Flash)?;
        self.next = Place { sector, slot: 0 };
        Ok(())
    }
}

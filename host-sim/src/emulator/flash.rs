//! The settings' sectors of the emulated body's flash, as a file.

use std::convert::Infallible;
use std::fs;
use std::io;
use std::path::Path;

use embedded_storage::nor_flash::{ErrorType, NorFlash, ReadNorFlash};
use towmag::store::{FlashSectors, SettingsStore, Stored};

const SECTOR_LEN: u32 = 0x2_0000;

/// The two sectors, which in the file follow each other.
const REGION: FlashSectors = FlashSectors { sectors: [0, SECTOR_LEN], sector_len: SECTOR_LEN };

/// What erased flash holds.
const BLANK: u8 = 0xff;

/// Make a flash that holds these settings and nothing else.
pub(super) fn write(path: &Path, stored: &Stored) -> io::Result<()> {
    let mut flash = Memory(vec![BLANK; 2 * SECTOR_LEN as usize]);
    let refused = |error: &dyn std::fmt::Display| io::Error::other(error.to_string());
    let (mut store, _) = SettingsStore::open(&mut flash, REGION).map_err(|error| refused(&error))?;
    store.save(&mut flash, stored).map_err(|error| refused(&error))?;
    fs::write(path, flash.0)
}

/// What the body starts with.
pub(super) fn read(path: &Path) -> io::Result<Stored> {
    let opened = SettingsStore::open(&mut Memory(fs::read(path)?), REGION);
    let (_, opened) = opened.map_err(|error| io::Error::other(error.to_string()))?;
    Ok(opened.stored.unwrap_or_default())
}

/// A flash in memory.
struct Memory(Vec<u8>);

impl ErrorType for Memory {
    type Error = Infallible;
}

impl ReadNorFlash for Memory {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Infallible> {
        let from = offset as usize;
        bytes.copy_from_slice(&self.0[from..from + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.0.len()
    }
}

impl NorFlash for Memory {
    const WRITE_SIZE: usize = 1;
    const ERASE_SIZE: usize = SECTOR_LEN as usize;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Infallible> {
        self.0[from as usize..to as usize].fill(BLANK);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Infallible> {
        self.0.iter_mut().skip(offset as usize).zip(bytes).for_each(|(cell, byte)| *cell &= byte);
        Ok(())
    }
}

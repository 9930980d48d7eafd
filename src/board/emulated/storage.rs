//! What keeps data without power, as files of the host: the card, the two sectors of the settings, and, as a reset ends
//! the emulator, the memory that outlives one.

use super::host::{File, FileError, Mode};
use crate::board::chip::SETTINGS;
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use towmag::hardware::CardSlot;
use towmag::store::SLOT_LEN;

/// The card: a file of blocks.
pub struct LogCard(File);

impl LogCard {
    pub fn open() -> Self {
        Self(File::open(c"card.img", Mode::ReadWrite))
    }
}

impl BlockDevice for LogCard {
    type Error = FileError;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), FileError> {
        self.0.seek(start.0 * Block::LEN_U32)?;
        blocks.iter_mut().try_for_each(|block| self.0.read(&mut block.contents))
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), FileError> {
        self.0.seek(start.0 * Block::LEN_U32)?;
        blocks.iter().try_for_each(|block| self.0.write(&block.contents))
    }

    fn num_blocks(&self) -> Result<BlockCount, FileError> {
        Ok(BlockCount(self.0.len()? / Block::LEN_U32))
    }
}

impl CardSlot for LogCard {
    /// A file of the host is always there.
    fn look_again(&self) {}
}

/// The two sectors of the settings: a file that begins with the first.
pub struct SettingsFlash(File);

impl SettingsFlash {
    pub fn open() -> Self {
        Self(File::open(c"flash.img", Mode::ReadWrite))
    }

    fn seek(&self, offset: u32) -> Result<(), FileError> {
        self.0.seek(offset - SETTINGS.sectors[0])
    }
}

impl NorFlashError for FileError {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl ErrorType for SettingsFlash {
    type Error = FileError;
}

impl ReadNorFlash for SettingsFlash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FileError> {
        self.seek(offset)?;
        self.0.read(bytes)
    }

    fn capacity(&self) -> usize {
        SETTINGS.sectors[0] as usize + self.0.len().unwrap_or(0) as usize
    }
}

impl NorFlash for SettingsFlash {
    const WRITE_SIZE: usize = 1;
    const ERASE_SIZE: usize = SETTINGS.sector_len as usize;

    /// Writing clears bits and sets none, as in the chip's own flash.
    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FileError> {
        let mut cell = [0; SLOT_LEN];
        for (at, chunk) in (offset..).step_by(SLOT_LEN).zip(bytes.chunks(SLOT_LEN)) {
            let cells = &mut cell[..chunk.len()];
            self.read(at, cells)?;
            cells.iter_mut().zip(chunk).for_each(|(cell, byte)| *cell &= byte);
            self.seek(at)?;
            self.0.write(cells)?;
        }
        Ok(())
    }

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FileError> {
        self.seek(from)?;
        (from..to).step_by(SLOT_LEN).try_for_each(|_| self.0.write(&[0xff; SLOT_LEN]))
    }
}

/// Before a reset: what memory shall still hold after it.
pub fn save_retained(memory: &[u8]) {
    // Should it fail, the memory is as after power-up.
    _ = File::open(c"retained.bin", Mode::Write).write(memory);
}

/// After a reset. Leaves the memory as it is when there was none.
pub fn load_retained(memory: &mut [u8]) {
    _ = File::open(c"retained.bin", Mode::Read).read(memory);
}

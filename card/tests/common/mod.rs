//! A card in memory as the store of the tests.

use std::cell::RefCell;
use std::io;

use towmag_card::Store;
use towmag_virtual_body::disk::Disk;

/// An image in memory. One that lies says that it is larger than it is, and starts again from its beginning.
pub(crate) struct Memory {
    pub(crate) bytes: RefCell<Vec<u8>>,
    pub(crate) told_blocks: u64,
}

impl Memory {
    fn each_block(&self, at: u64, len: usize, mut visit: impl FnMut(usize, usize)) -> io::Result<()> {
        if at + len as u64 > self.told_blocks * 512 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let real = self.bytes.borrow().len() as u64 / 512 * 512;
        (0..len).step_by(512).for_each(|offset| visit(offset, ((at + offset as u64) % real) as usize));
        Ok(())
    }
}

impl From<&Disk> for Memory {
    fn from(disk: &Disk) -> Self {
        Self::from(disk.image())
    }
}

impl From<Vec<u8>> for Memory {
    fn from(bytes: Vec<u8>) -> Self {
        Self { told_blocks: bytes.len() as u64 / 512, bytes: RefCell::new(bytes) }
    }
}

impl Store for Memory {
    fn blocks(&self) -> u64 {
        self.told_blocks
    }

    fn read(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        self.each_block(at, bytes.len(), |offset, place| {
            bytes[offset..offset + 512].copy_from_slice(&self.bytes.borrow()[place..place + 512]);
        })
    }

    fn write(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        self.each_block(at, bytes.len(), |offset, place| {
            self.bytes.borrow_mut()[place..place + 512].copy_from_slice(&bytes[offset..offset + 512]);
        })
    }

    fn sync(&self) -> io::Result<()> {
        Ok(())
    }

    fn forget_cache(&self) -> bool {
        true
    }
}

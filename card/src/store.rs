//! A card as bytes: an image, or a device of the operating system.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use crate::{BLOCK_BYTES, CardError};

/// Bytes that can be written, made safe, and read back. Places and lengths are whole blocks.
pub trait Store {
    /// Its size in blocks.
    fn blocks(&self) -> u64;

    /// Read from this byte on; `UnexpectedEof` beyond the end.
    fn read(&self, at: u64, bytes: &mut [u8]) -> io::Result<()>;

    /// Write from this byte on.
    fn write(&self, at: u64, bytes: &[u8]) -> io::Result<()>;

    /// Return when everything written is on the card.
    fn sync(&self) -> io::Result<()>;

    /// Make the next read come from the card and not from the computer's memory; whether that can be done here.
    fn forget_cache(&self) -> bool;
}

/// What is to be done with an image or device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Look at it.
    Read,
    /// Write to it; a device for this program alone.
    Write,
}

/// An image or a device.
#[derive(Debug)]
pub struct DiskFile {
    file: File,
    blocks: u64,
}

impl DiskFile {
    /// Open it.
    pub fn open(path: &Path, access: Access) -> Result<Self, CardError> {
        let mut options = OpenOptions::new();
        options.read(true).write(access == Access::Write);
        let metadata = path.metadata().map_err(CardError::opening(path))?;
        if access == Access::Write && metadata.is_file() && metadata.permissions().readonly() {
            return Err(CardError::ReadOnly(path.into()));
        }
        if access == Access::Write && !metadata.is_file() {
            exclusively(&mut options);
        }
        let file = options.open(path).map_err(CardError::opening(path))?;
        let blocks = if metadata.is_file() { metadata.len() / BLOCK_BYTES } else { device_blocks(&file)? };
        Ok(Self { file, blocks })
    }

    fn at(&self, at: u64, len: usize) -> io::Result<&File> {
        let end = at.checked_add(len as u64).filter(|&end| end <= self.blocks * BLOCK_BYTES);
        end.ok_or(io::ErrorKind::UnexpectedEof)?;
        (&self.file).seek(SeekFrom::Start(at))?;
        Ok(&self.file)
    }
}

impl Store for DiskFile {
    fn blocks(&self) -> u64 {
        self.blocks
    }

    fn read(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        self.at(at, bytes.len())?.read_exact(bytes)
    }

    fn write(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        self.at(at, bytes.len())?.write_all(bytes)
    }

    fn sync(&self) -> io::Result<()> {
        self.file.sync_data()
    }

    fn forget_cache(&self) -> bool {
        forget_cache(&self.file)
    }
}

/// Linux refuses a device with this flag that is mounted, is swapped to, or is a part of something larger.
#[cfg(target_os = "linux")]
fn exclusively(options: &mut OpenOptions) {
    use std::os::unix::fs::OpenOptionsExt;
    options.custom_flags(rustix::fs::OFlags::EXCL.bits().cast_signed());
}

#[cfg(not(target_os = "linux"))]
fn exclusively(_: &mut OpenOptions) {}

/// What was written must be safe already: the system drops only what it need not keep.
#[cfg(target_os = "linux")]
pub(crate) fn forget_cache(file: &File) -> bool {
    rustix::fs::fadvise(file, 0, None, rustix::fs::Advice::DontNeed).is_ok()
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn forget_cache(_: &File) -> bool {
    false
}

/// Not every system tells the size of a device; but the blocks that can be read end somewhere.
fn device_blocks(mut file: &File) -> Result<u64, CardError> {
    if let Ok(bytes) = file.seek(SeekFrom::End(0))
        && bytes > 0
    {
        return Ok(bytes / BLOCK_BYTES);
    }
    let mut block = [0; BLOCK_BYTES as usize];
    let mut is_there = |index: u64| {
        let found = file.seek(SeekFrom::Start(index * BLOCK_BYTES)).and_then(|_| file.read_exact(&mut block));
        found.is_ok()
    };
    // No card has more blocks than SD's own addresses can tell.
    let (mut there, mut beyond) = (0, u64::from(u32::MAX) + 1);
    while there < beyond {
        let middle = there + (beyond - there) / 2;
        if is_there(middle) { there = middle + 1 } else { beyond = middle }
    }
    Ok(there)
}

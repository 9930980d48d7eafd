//! Finding the file to go on with.

use embedded_sdmmc::BlockIdx;

use super::super::block::{BLOCK_LEN, is_blank, is_blank_at};
use super::directory::{Directory, FileEntry};
use super::fat::Volume;
use super::file::is_own;
use super::map::FileMap;
use super::{Card, LAST_FILE, VolumeError, read_block};

impl FileMap {
    /// The log file to go on with, of those on the card that have room and a number above `after`: the newest that was
    /// begun, or else the oldest of those that were prepared for later. Changes nothing.
    pub fn open_newest<D: Card>(card: &D, partition: usize, after: u16) -> Result<Option<Self>, VolumeError<D::Error>> {
        let volume = Volume::find(card, partition)?.ok_or(VolumeError::NoVolume)?;
        let mut entries = [None; LAST_FILE as usize + 1];
        Directory::read(card, &volume, |entry| {
            if let Some(place) = entries.get_mut(usize::from(entry.number)) {
                *place = Some(entry);
            }
        })?;
        let newest_first = entries.into_iter().flatten().rev().filter(|entry| entry.number > after);
        let mut oldest_untouched = None;
        for entry in newest_first {
            match open(card, &volume, entry)?.filter(|map| has_room(card, map)) {
                Some(map) if is_untouched(card, &map) => oldest_untouched = Some(map),
                Some(map) => return Ok(Some(map)),
                None => {}
            }
        }
        Ok(oldest_untouched)
    }
}

/// Whether the file was marked, as one is that was prepared on a desk, and nothing was written to it since. One that the
/// body itself has made is marked when it is needed.
fn is_untouched<D: Card>(card: &D, map: &FileMap) -> bool {
    let mut block = [0; BLOCK_LEN];
    let read = map.locate(0).map(|index| read_block(card, BlockIdx(index), &mut block));
    matches!(read, Some(Ok(()))) && is_blank_at(map.region(), 0, &block)
}

/// A file whose first block says that it is this file and lies here; `None` for any other.
fn open<D: Card>(card: &D, volume: &Volume, entry: FileEntry) -> Result<Option<FileMap>, D::Error> {
    let Some(first) = volume.first_block(entry.first_cluster) else { return Ok(None) };
    let mut block = [0; BLOCK_LEN];
    read_block(card, BlockIdx(first), &mut block)?;
    Ok(FileMap::decode(&block).filter(|map| {
        map.region().file_number == entry.number
            && map.first_block() == first
            && map.file_blocks().checked_mul(BLOCK_LEN as u32) == Some(entry.size)
    }))
}

/// Whether the log has not reached the last place of the file. When that cannot be read, or holds anything else, it may
/// have: the writer finds out.
fn has_room<D: Card>(card: &D, map: &FileMap) -> bool {
    let mut block = [0; BLOCK_LEN];
    let last = map.places().saturating_sub(1);
    let read = map.locate(last).map(|index| read_block(card, BlockIdx(index), &mut block));
    !matches!(read, Some(Ok(())) if is_own(map, last, &block) && !is_blank(&block))
}

//! Finding the log file to go on with, or making a new one.

use core::ops::ControlFlow;

use embedded_sdmmc::{
    Block, BlockCount, BlockDevice, BlockIdx, DirEntry, Directory, Error, File, Mode, ShortFileName, TimeSource,
    VolumeIdx, VolumeManager,
};

use super::super::block::{BLOCK_LEN, BlockBytes, Region, blank_block};
use super::fat::Volume;
use super::map::FileMap;
use super::{Card, read_block};

/// Highest file number.
const LAST_FILE: u16 = 99;

/// Fewest blocks that make a file worth having, when the card has no more: a minute and a half at 10 Hz.
const FEWEST_BLOCKS: u32 = 100;

type Manager<'a, D, T> = VolumeManager<Borrowed<'a, D>, T, 1, 1, 1>;
type Root<'v, 'a, D, T> = Directory<'v, Borrowed<'a, D>, T, 1, 1, 1>;
type LogHandle<'v, 'a, D, T> = File<'v, Borrowed<'a, D>, T, 1, 1, 1>;

/// The file system takes its device by value; the log file needs the same device afterwards, so it gets a reference.
struct Borrowed<'a, D>(&'a D);

impl<D: BlockDevice> BlockDevice for Borrowed<'_, D> {
    type Error = D::Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), Self::Error> {
        self.0.read(blocks, start)
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), Self::Error> {
        self.0.write(blocks, start)
    }

    fn num_blocks(&self) -> Result<BlockCount, Self::Error> {
        self.0.num_blocks()
    }
}

/// The file to make if there is none to go on with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NewFile {
    /// Partition of the card, 0 to 3. Cards come with one, number 0.
    pub partition: usize,
    /// Size in blocks of 512 bytes, 100 to 8,388,607. A day at 10 Hz takes 86,400. When the card has less, the file
    /// gets what there is.
    pub blocks: u32,
    /// A random number, to tell this file's blank blocks from those of earlier files.
    pub nonce: u32,
}

/// Why there is no log file.
#[derive(Debug)]
pub enum VolumeError<E: core::error::Error> {
    /// The card or its file system.
    FileSystem(Error<E>),
    /// The partition holds no FAT16 or FAT32 that makes sense.
    NoVolume,
    /// All 99 numbers are taken.
    TooManyFiles,
    /// The free space is less than 100 blocks, or in more than [`MAX_EXTENTS`](super::MAX_EXTENTS) pieces.
    NoSpace,
    /// The copies of the file allocation table differ, as after a power cut while a file was made: a new file might
    /// take the blocks of another. To be repaired on a laptop; files that are there can still be written to.
    TablesDiffer,
    /// The size is not 100 to 8,388,607 blocks.
    Size(u32),
}

impl<E: core::error::Error> core::fmt::Display for VolumeError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::FileSystem(error) => write!(f, "{error}"),
            Self::NoVolume => write!(f, "the card's file system makes no sense: format it"),
            Self::TooManyFiles => write!(f, "there are {LAST_FILE} log files on the card: move some away"),
            Self::NoSpace => write!(f, "no space for a log file: empty or format the card"),
            Self::TablesDiffer => write!(f, "the card's file system is damaged: repair it on a laptop"),
            Self::Size(blocks) => write!(f, "log file of {blocks} blocks: choose 100 to 8388607"),
        }
    }
}

impl<E: core::error::Error> core::error::Error for VolumeError<E> {}

impl<E: core::error::Error> From<Error<E>> for VolumeError<E> {
    fn from(error: Error<E>) -> Self {
        Self::FileSystem(error)
    }
}

impl FileMap {
    /// The newest log file on the card that has room, or a new one. `time` stamps a new file's directory entry.
    ///
    /// Nothing that is on the card is changed but by making a new file; a file that is there but not as it should be
    /// is left alone. Takes some 4 kB of stack.
    pub fn open_or_create<D: Card, T: TimeSource>(
        card: &D,
        time: T,
        new: NewFile,
    ) -> Result<Self, VolumeError<D::Error>> {
        let manager: Manager<'_, D, T> = VolumeManager::new_with_limits(Borrowed(card), time, 1);
        let file_system = manager.open_volume(VolumeIdx(new.partition))?;
        let root = file_system.open_root_dir()?;
        let volume = Volume::find(card, new.partition).map_err(Error::DeviceError)?.ok_or(VolumeError::NoVolume)?;
        let present = file_numbers(&root)?;
        let newest_first = (1..=LAST_FILE).rev().filter(|number| present & (1 << number) != 0);
        for number in newest_first.clone() {
            if let Some(map) = open(&root, card, &volume, number).filter(|map| has_room(card, map)) {
                return Ok(map);
            }
        }
        let file_number = newest_first.clone().next().unwrap_or(0) + 1;
        if file_number > LAST_FILE {
            return Err(VolumeError::TooManyFiles);
        }
        create(&root, card, &volume, Region { file_number, nonce: new.nonce }, new.blocks)
    }
}

/// `TOWMAG01.BIN` and so on. The bytes are ASCII.
fn file_name(number: u16) -> [u8; 12] {
    let mut name = *b"TOWMAG00.BIN";
    name[6] += (number / 10 % 10) as u8;
    name[7] += (number % 10) as u8;
    name
}

fn number_of(name: &ShortFileName) -> Option<u16> {
    let digits = name.base_name().strip_prefix(b"TOWMAG")?;
    let number = core::str::from_utf8(digits).ok()?.parse().ok()?;
    (digits.len() == 2 && name.extension() == b"BIN" && (1..=LAST_FILE).contains(&number)).then_some(number)
}

/// The numbers of the log files, one bit each.
fn file_numbers<D: Card, T: TimeSource>(root: &Root<'_, '_, D, T>) -> Result<u128, Error<D::Error>> {
    let mut present = 0;
    root.iterate_dir(|entry| {
        if let Some(number) = number_of(&entry.name) {
            present |= 1 << number;
        }
        ControlFlow::Continue(())
    })?;
    Ok(present)
}

fn entry<D: Card, T: TimeSource>(root: &Root<'_, '_, D, T>, number: u16) -> Result<DirEntry, Error<D::Error>> {
    root.find_directory_entry(core::str::from_utf8(&file_name(number)).unwrap_or_default())
}

/// A finished file that lies where its first block says; `None` for any other, also for one that cannot be read.
fn open<D: Card, T: TimeSource>(root: &Root<'_, '_, D, T>, card: &D, volume: &Volume, number: u16) -> Option<FileMap> {
    let entry = entry(root, number).ok()?;
    let mut first = None;
    volume.walk(card, &entry, 1, |index| first.replace(index).is_none()).ok()?;
    let mut block = [0; BLOCK_LEN];
    read_block(card, BlockIdx(first?), &mut block).ok()?;
    let map = FileMap::decode(&block)?;
    let is_as_said = map.region().file_number == number
        && map.file_blocks().checked_mul(BLOCK_LEN as u32) == Some(entry.size)
        && lies_as_said(card, volume, &entry, &map);
    is_as_said.then_some(map)
}

/// Whether every block is where the file system has it.
fn lies_as_said<D: Card>(card: &D, volume: &Volume, entry: &DirEntry, map: &FileMap) -> bool {
    let mut said = map.card_blocks();
    volume.walk(card, entry, map.file_blocks(), |index| said.next() == Some(index)).unwrap_or(false)
}

/// Whether the last block of the file is still blank.
fn has_room<D: Card>(card: &D, map: &FileMap) -> bool {
    let mut block = [0; BLOCK_LEN];
    let last = map.region_blocks().saturating_sub(1);
    let read = map.locate(last).is_some_and(|index| read_block(card, BlockIdx(index), &mut block).is_ok());
    read && block == blank_block(map.region(), last)
}

fn create<D: Card, T: TimeSource>(
    root: &Root<'_, '_, D, T>,
    card: &D,
    volume: &Volume,
    region: Region,
    blocks: u32,
) -> Result<FileMap, VolumeError<D::Error>> {
    if !(FEWEST_BLOCKS..=u32::MAX / BLOCK_LEN as u32).contains(&blocks) {
        return Err(VolumeError::Size(blocks));
    }
    let blocks = blocks.min(free_blocks(card, volume)?);
    if blocks < FEWEST_BLOCKS {
        return Err(VolumeError::NoSpace);
    }
    let name = file_name(region.file_number);
    let file = root.open_file_in_dir(core::str::from_utf8(&name).unwrap_or_default(), Mode::ReadWriteCreate)?;
    let filled = fill(&file, region, blocks);
    file.close()?;
    let filled = filled?;
    if filled < FEWEST_BLOCKS {
        return Err(VolumeError::NoSpace);
    }
    let entry = entry(root, region.file_number)?;
    let mut map = FileMap::empty(region);
    if !volume.walk(card, &entry, filled, |index| map.add(index)).map_err(Error::DeviceError)? {
        return Err(VolumeError::NoSpace);
    }
    finish(card, &map).map_err(Error::DeviceError)?;
    Ok(map)
}

/// Room for files. Asked beforehand, because `embedded-sdmmc` 0.10 does not stop at the last cluster of a full volume:
/// it goes on to the end of the table's last block, and would write behind the volume.
fn free_blocks<D: Card>(card: &D, volume: &Volume) -> Result<u32, VolumeError<D::Error>> {
    match volume.free_clusters(card).map_err(Error::DeviceError)? {
        Some(clusters) => Ok(clusters.saturating_mul(volume.cluster_blocks())),
        None => Err(VolumeError::TablesDiffer),
    }
}

/// Write the marker of each block's position in the region, which begins with the file's second block; returns how
/// many blocks there was room for.
fn fill<D: Card, T: TimeSource>(
    file: &LogHandle<'_, '_, D, T>,
    region: Region,
    blocks: u32,
) -> Result<u32, Error<D::Error>> {
    for block in 0..blocks {
        match file.write(&blank_block(region, block.wrapping_sub(1))) {
            Ok(()) => {}
            Err(Error::DiskFull | Error::NotEnoughSpace) => return Ok(block),
            Err(error) => return Err(error),
        }
    }
    Ok(blocks)
}

/// Write the first block. Everything else must be safe before: it says so.
fn finish<D: Card>(card: &D, map: &FileMap) -> Result<(), D::Error> {
    card.sync()?;
    if let Some(first) = map.locate_in_file(0) {
        let contents: BlockBytes = map.encode();
        card.write(&[Block { contents }], BlockIdx(first))?;
    }
    card.sync()
}

//! Finding the log file to go on with, or making a new one.

use core::ops::ControlFlow;

use embedded_sdmmc::{
    Block, BlockIdx, Directory, Error, File, Mode, ShortFileName, TimeSource, VolumeIdx, VolumeManager,
};

use super::super::block::{BLOCK_LEN, BlockBytes, Region, blank_block};
use super::map::FileMap;
use super::probe::{Probe, Trace, file_block};
use super::{Card, read_block};

/// Highest file number.
const LAST_FILE: u16 = 99;

/// Fewest blocks that make a file worth having, when the card has no more: a minute and a half at 10 Hz.
const FEWEST_BLOCKS: u32 = 100;

type Manager<'a, D, T> = VolumeManager<Probe<'a, D>, T, 1, 1, 1>;
type Root<'v, 'a, D, T> = Directory<'v, Probe<'a, D>, T, 1, 1, 1>;
type LogHandle<'v, 'a, D, T> = File<'v, Probe<'a, D>, T, 1, 1, 1>;

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
    /// All 99 numbers are taken.
    TooManyFiles,
    /// The free space is less than 100 blocks, or in more than [`MAX_EXTENTS`](super::MAX_EXTENTS) pieces.
    NoSpace,
    /// The size is not 100 to 8,388,607 blocks.
    Size(u32),
}

impl<E: core::error::Error> core::fmt::Display for VolumeError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::FileSystem(error) => write!(f, "{error}"),
            Self::TooManyFiles => write!(f, "there are {LAST_FILE} log files on the card: move some away"),
            Self::NoSpace => write!(f, "no space for a log file: empty or format the card"),
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
    /// is left alone. Takes some 2 kB of stack.
    pub fn open_or_create<D: Card, T: TimeSource>(
        card: &D,
        time: T,
        new: NewFile,
    ) -> Result<Self, VolumeError<D::Error>> {
        let trace = Trace::new(Region { file_number: 0, nonce: new.nonce });
        let manager: Manager<'_, D, T> = VolumeManager::new_with_limits(Probe { card, trace: &trace }, time, 1);
        let volume = manager.open_volume(VolumeIdx(new.partition))?;
        let root = volume.open_root_dir()?;
        let present = file_numbers(&root)?;
        for number in (1..=LAST_FILE).rev().filter(|number| present & (1 << number) != 0) {
            if let Some(map) = open(&root, card, &trace, number).filter(|map| has_room(card, map)) {
                return Ok(map);
            }
        }
        let number = (1..=LAST_FILE).rev().find(|number| present & (1 << number) != 0).unwrap_or(0) + 1;
        if number > LAST_FILE {
            return Err(VolumeError::TooManyFiles);
        }
        create(&root, card, &trace, Region { file_number: number, nonce: new.nonce }, new.blocks)
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

fn open_handle<'v, 'a, D: Card, T: TimeSource>(
    root: &Root<'v, 'a, D, T>,
    number: u16,
    mode: Mode,
) -> Result<LogHandle<'v, 'a, D, T>, Error<D::Error>> {
    let name = file_name(number);
    root.open_file_in_dir(core::str::from_utf8(&name).unwrap_or_default(), mode)
}

/// A finished file that lies where its first block says; `None` for any other, also for one that cannot be read.
fn open<D: Card, T: TimeSource>(root: &Root<'_, '_, D, T>, card: &D, trace: &Trace, number: u16) -> Option<FileMap> {
    let file = open_handle(root, number, Mode::ReadOnly).ok()?;
    let first = block_of(&file, trace, 0)?;
    let mut block = [0; BLOCK_LEN];
    read_block(card, first, &mut block).ok()?;
    let map = FileMap::decode(&block)?;
    let as_said = map.region().file_number == number
        && Some(file.length()) == map.file_blocks().checked_mul(BLOCK_LEN as u32)
        && lies_as_said(&file, trace, &map);
    as_said.then_some(map)
}

/// Whether the first and last block of each extent is where the file system has it.
fn lies_as_said<D: Card, T: TimeSource>(file: &LogHandle<'_, '_, D, T>, trace: &Trace, map: &FileMap) -> bool {
    let mut next = 0;
    map.extents().iter().all(|extent| {
        let (first, last) = (next, next + extent.blocks - 1);
        next += extent.blocks;
        let found = |block| block_of(file, trace, block).map(|index| index.0);
        found(first) == map.locate_in_file(first) && found(last) == map.locate_in_file(last)
    })
}

/// Where the file system has this block of the file: the block that it reads to give us one byte of it. Its cache
/// holds one block and must not answer instead, hence the second byte elsewhere.
fn block_of<D: Card, T: TimeSource>(file: &LogHandle<'_, '_, D, T>, trace: &Trace, block: u32) -> Option<BlockIdx> {
    let read_at = |block: u32| {
        trace.last_read.set(None);
        file.seek_from_start(block.checked_mul(BLOCK_LEN as u32)?).ok()?;
        let count = file.read(&mut [0]).ok()?;
        (count == 1).then_some(())
    };
    let other = if block == 0 { 1 } else { 0 };
    read_at(other)?;
    read_at(block)?;
    trace.last_read.get()
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
    trace: &Trace,
    region: Region,
    blocks: u32,
) -> Result<FileMap, VolumeError<D::Error>> {
    if !(FEWEST_BLOCKS..=u32::MAX / BLOCK_LEN as u32).contains(&blocks) {
        return Err(VolumeError::Size(blocks));
    }
    trace.map.replace(FileMap::empty(region));
    let file = open_handle(root, region.file_number, Mode::ReadWriteCreate)?;
    let filled = fill(&file, region, blocks);
    file.close()?;
    let filled = filled?;
    let map = trace.map.borrow().clone();
    if filled < FEWEST_BLOCKS || map.file_blocks() != filled {
        return Err(VolumeError::NoSpace);
    }
    finish(card, &map).map_err(Error::DeviceError)?;
    Ok(map)
}

/// Write the markers; returns how many blocks there was room for.
fn fill<D: Card, T: TimeSource>(
    file: &LogHandle<'_, '_, D, T>,
    region: Region,
    blocks: u32,
) -> Result<u32, Error<D::Error>> {
    for block in 0..blocks {
        match file.write(&file_block(region, block)) {
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

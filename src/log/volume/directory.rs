//! The root directory: which log files there are, and the entry of a new one.

use embedded_sdmmc::{Block, BlockIdx};

use super::super::block::{BLOCK_LEN, BlockBytes};
use super::fat::{Root, Volume, u16_at, u32_at};
use super::{Card, LAST_FILE, VolumeError, read_block};

/// Bytes of an entry.
pub(super) const ENTRY_LEN: usize = 32;

/// Blocks of a root directory that are looked at: room for 65,536 entries, as FAT has it at most.
const MOST_BLOCKS: u32 = 4096;

/// First byte of a slot that was never used, and of one whose file was deleted.
pub(super) const NEVER_USED: u8 = 0;
pub(super) const DELETED: u8 = 0xE5;

/// Attributes: of an ordinary file, of a piece of a long name, and bits that no entry has.
const ARCHIVE: u8 = 0x20;
pub(super) const LONG_NAME: u8 = 0x0F;
const NO_ATTRIBUTES: u8 = 0xC0;

/// 1980-01-01: the body does not know the date before it is told.
const NO_DATE: u16 = 0x0021;

/// The entry of a log file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FileEntry {
    pub(super) number: u16,
    pub(super) first_cluster: u32,
    /// In bytes.
    pub(super) size: u32,
}

/// What is in the root directory.
#[derive(Clone, Copy, Debug)]
pub(super) struct Directory {
    /// Of each number, one bit.
    present: u128,
    /// The first slot without an entry.
    free: Option<(u32, usize)>,
}

impl Directory {
    /// Look at all of it, and call `visit` with each log file.
    pub(super) fn read<D: Card>(card: &D, volume: &Volume, mut visit: impl FnMut(FileEntry)) -> Result<Self, D::Error> {
        let mut directory = Self { present: 0, free: None };
        each_block(card, volume, |index, block| {
            for (slot, entry) in block.chunks_exact(ENTRY_LEN).enumerate() {
                if directory.free.is_none() && is_free(entry) {
                    directory.free = Some((index, slot));
                }
                if let Some(file) = decode(entry) {
                    directory.present |= 1 << file.number;
                    visit(file);
                }
            }
        })?;
        Ok(directory)
    }

    /// The number of the next file, one above the highest.
    pub(super) fn next_number(&self) -> Option<u16> {
        let next = (128 - self.present.leading_zeros()).max(1) as u16;
        (next <= LAST_FILE).then_some(next)
    }

    /// Add a file.
    pub(super) fn add<D: Card>(&self, card: &D, file: FileEntry) -> Result<(), VolumeError<D::Error>> {
        let (index, slot) = self.free.ok_or(VolumeError::DirectoryFull)?;
        let mut contents = [0; BLOCK_LEN];
        read_block(card, BlockIdx(index), &mut contents)?;
        if let Some(place) = contents.chunks_exact_mut(ENTRY_LEN).nth(slot) {
            place.copy_from_slice(&encode(file));
        }
        Ok(card.write(&[Block { contents }], BlockIdx(index))?)
    }
}

/// Call `visit` with each block of the root directory.
pub(super) fn each_block<D: Card>(
    card: &D,
    volume: &Volume,
    mut visit: impl FnMut(u32, &BlockBytes),
) -> Result<(), D::Error> {
    let mut block = [0; BLOCK_LEN];
    let mut each = |first: u32, blocks: u32| {
        (first..first.saturating_add(blocks)).try_for_each(|index| {
            read_block(card, BlockIdx(index), &mut block)?;
            visit(index, &block);
            Ok(())
        })
    };
    let first_cluster = match volume.root {
        Root::Blocks { first, blocks } => return each(first, blocks.min(MOST_BLOCKS)),
        Root::Chain(first_cluster) => first_cluster,
    };
    let (mut next, mut left) = (Some(first_cluster), MOST_BLOCKS);
    while let Some((cluster, first)) = next.and_then(|cluster| Some((cluster, volume.first_block(cluster)?)))
        && left > 0
    {
        each(first, volume.cluster_blocks().min(left))?;
        left = left.saturating_sub(volume.cluster_blocks());
        next = volume.next_cluster(card, cluster)?;
    }
    Ok(())
}

/// Whether there is no entry in a slot: also where a write that was cut has left what cannot be one.
fn is_free(entry: &[u8]) -> bool {
    let (&first, attributes) = (entry.first().unwrap_or(&NEVER_USED), entry.get(11).copied().unwrap_or(0));
    let name = entry.get(1..11).unwrap_or_default();
    matches!(first, NEVER_USED | DELETED)
        || attributes & NO_ATTRIBUTES != 0
        || (attributes != LONG_NAME && name.iter().any(|&byte| byte < b' '))
}

/// `TOWMAG01BIN` and so on.
fn name(number: u16) -> [u8; 11] {
    let mut name = *b"TOWMAG00BIN";
    name[6] += (number / 10 % 10) as u8;
    name[7] += (number % 10) as u8;
    name
}

/// The entry of a log file; `None` of anything else.
pub(super) fn decode(entry: &[u8]) -> Option<FileEntry> {
    let entry: &[u8; ENTRY_LEN] = entry.try_into().ok()?;
    let digits = entry.strip_prefix(b"TOWMAG")?.get(..2)?;
    let number = core::str::from_utf8(digits).ok()?.parse().ok().filter(|number| (1..=LAST_FILE).contains(number))?;
    let mut block = [0; BLOCK_LEN];
    block.get_mut(..ENTRY_LEN)?.copy_from_slice(entry);
    let first_cluster = u32::from(u16_at(&block, 20)?) << 16 | u32::from(u16_at(&block, 26)?);
    let is_file = entry.starts_with(&name(number)) && entry[11] & 0x18 == 0;
    is_file.then_some(FileEntry { number, first_cluster, size: u32_at(&block, 28)? })
}

fn encode(file: FileEntry) -> [u8; ENTRY_LEN] {
    let mut entry = [0; ENTRY_LEN];
    let mut put = crate::bytes::Put::new(&mut entry);
    put.bytes(&name(file.number));
    put.u8(ARCHIVE);
    put.bytes(&[0; 4]); // reserved, and the time of making
    put.u16(NO_DATE);
    put.u16(NO_DATE);
    put.u16((file.first_cluster >> 16) as u16);
    put.u16(0);
    put.u16(NO_DATE);
    put.u16(file.first_cluster as u16);
    put.u32(file.size);
    entry
}

//! Log files on a card, made with the body's own code and marked to their end, so that the body logs at once.

use std::io;

use embedded_sdmmc::BlockIdx;
use towmag::log::{BLOCK_LEN, FileMap, LAST_FILE, LogFile, Maker, NewFile, VolumeError, blank_block};
use towmag::storage::{BLOCKS_PER_HOUR, PARTITION};
use towmag::store::LOG_FILE_HOURS;

use crate::blocks::OnStore;
use crate::rehearsal::Rehearsal;
use crate::{BLOCK_BYTES, CardError, Listing, Progress, Store};

/// Markers of one write, which ends where a multiple of it does: a card's erase blocks are filled one after the other.
const CHUNK_BLOCKS: u32 = 2_048;

/// Bytes between two times that the system is told to really write them: the bar shall show the card, not the memory.
const SYNC_BYTES: u64 = 16 << 20;

/// What to make.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// Hours of log in each file, 1 to 240.
    pub hours: u32,
    /// Files, used one after the other.
    pub files: u32,
    /// A number that is seldom the same.
    pub nonce: u32,
}

/// A file that was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prepared {
    /// Of `TOWMAG01.BIN` it is 1.
    pub number: u16,
    /// Its size.
    pub bytes: u64,
}

/// Make the files: all of them or, where they have no room, none. Nothing else on the card changes.
pub fn prepare<S: Store>(store: &S, wanted: &Wanted, progress: &dyn Progress) -> Result<Vec<Prepared>, CardError> {
    check(wanted)?;
    Listing::of(store)?;
    let card = Rehearsal::new(store);
    let maps = (0..wanted.files).map(|file| make(&card, wanted, file)).collect::<Result<Vec<_>, _>>()?;
    progress.begin("laying out", maps.iter().map(bytes).sum());
    maps.iter().try_for_each(|map| mark(store, map, progress))?;
    card.perform()?;
    store.forget_cache();
    maps.iter().try_for_each(|map| read_back(store, map))?;
    Ok(maps.iter().map(|map| Prepared { number: map.region().file_number, bytes: bytes(map) }).collect())
}

fn check(wanted: &Wanted) -> Result<(), CardError> {
    let Wanted { hours, files, .. } = wanted;
    if !LOG_FILE_HOURS.contains(hours) {
        let (least, most) = LOG_FILE_HOURS.into_inner();
        return Err(CardError::Usage(format!("--hours {hours}: choose {least} to {most}, as the body does")));
    }
    if !(1..=u32::from(LAST_FILE)).contains(files) {
        return Err(CardError::Usage(format!("--files {files}: choose 1 to {LAST_FILE}, as there are numbers")));
    }
    Ok(())
}

fn bytes(map: &FileMap) -> u64 {
    u64::from(map.file_blocks()) * BLOCK_BYTES
}

/// The next file, of full size.
fn make<S: Store>(card: &Rehearsal<'_, S>, wanted: &Wanted, file: u32) -> Result<FileMap, CardError> {
    let blocks = wanted.hours * BLOCKS_PER_HOUR;
    let nonce = wanted.nonce.wrapping_add(file.wrapping_mul(0x9E37_79B9)); // far apart, whatever comes in
    let mut maker = Maker::new(card, NewFile { partition: PARTITION, blocks, nonce })?;
    let ready = loop {
        match maker.step(card) {
            Ok(Some(ready)) => break ready,
            Ok(None) => {}
            Err(VolumeError::NoSpace) => return Err(no_room(wanted, file, 0)),
            Err(error) => return Err(error.into()),
        }
    };
    if ready.map.file_blocks() < blocks {
        return Err(no_room(wanted, file, ready.map.file_blocks()));
    }
    Ok(ready.map)
}

fn no_room(wanted: &Wanted, file: u32, blocks: u32) -> CardError {
    let Wanted { hours, files, .. } = wanted;
    let mb = |blocks: u32| u64::from(blocks) * BLOCK_BYTES / 1_000_000;
    CardError::Full(format!(
        "no room for file {} of {files}: {hours} h take {} MB in one piece, and the longest free piece has {} MB: \
         choose fewer --hours or --files, or empty the card",
        file + 1,
        mb(hours * BLOCKS_PER_HOUR),
        mb(blocks)
    ))
}

/// Markers to the end of the file, whose first block is written with the tables.
fn mark<S: Store>(store: &S, map: &FileMap, progress: &dyn Progress) -> io::Result<()> {
    let (mut position, mut unsafe_bytes) = (0, 0);
    let mut chunk = Vec::with_capacity(CHUNK_BLOCKS as usize * BLOCK_LEN);
    while let Some(first) = map.locate(position) {
        chunk.clear();
        let end = position + (CHUNK_BLOCKS - first % CHUNK_BLOCKS);
        for position in (position..end).take_while(|&position| map.locate(position).is_some()) {
            chunk.extend_from_slice(&blank_block(map.region(), position));
        }
        store.write(u64::from(first) * BLOCK_BYTES, &chunk)?;
        progress.add(chunk.len() as u64);
        unsafe_bytes += chunk.len() as u64;
        if unsafe_bytes >= SYNC_BYTES {
            store.sync()?;
            unsafe_bytes = 0;
        }
        position = end;
    }
    store.sync()
}

/// Look at the file as the body will, and at a marker of every chunk.
fn read_back<S: Store>(store: &S, map: &FileMap) -> Result<(), CardError> {
    let before = map.region().file_number - 1;
    let found = FileMap::open_newest(&OnStore(store), PARTITION, before)?;
    let is_marked = LogFile::new(OnStore(store), *map).is_marked();
    let positions = (0..2 * map.places()).step_by(CHUNK_BLOCKS as usize).chain([2 * map.places() - 1]);
    let mut markers = positions.map(|position| -> io::Result<bool> {
        let Some(index) = map.locate(position).map(BlockIdx) else { return Ok(false) };
        let mut block = [0; BLOCK_LEN];
        store.read(u64::from(index.0) * BLOCK_BYTES, &mut block)?;
        Ok(block == blank_block(map.region(), position))
    });
    let all_there = markers.try_fold(true, |all, one| one.map(|one| all && one))?;
    if found == Some(*map) && is_marked && all_there { Ok(()) } else { Err(CardError::NotKept) }
}

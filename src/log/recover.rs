//! The way back: every sector that is still intact, in order, whatever has become of the file system.
//!
//! [`Scan`] looks at every block of a file, a region or a whole card and recognises sectors by magic and CRC alone.
//! [`order`] brings them into the order of writing and drops what is there twice. [`Records`] then reads the records
//! and says where sectors are missing:
//!
//! ```
//! use towmag::log::{Found, Records, Scan, SliceSource, Survey, order};
//!
//! let mut image = SliceSource(&[0; 2048]);
//! let mut survey = Survey::default();
//! let mut keys: Vec<_> = Scan::new(&mut image).filter_map(|found| survey.count(found)).collect();
//! let sectors = order(&mut keys);
//! survey.duplicates = keys.len() - sectors;
//! assert_eq!(Records::new(&mut image, &keys[..sectors]).count(), 0);
//! ```

use core::cmp::Reverse;

use super::block::{BLOCK_LEN, BlockBytes, BlockSource, is_blank};
use super::record::{DecodeError, Record};
use super::sector::{Sector, SectorError, SectorId};

/// An intact sector, and where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SectorKey {
    /// Where it belongs.
    pub id: SectorId,
    /// Bytes of records in it.
    pub payload_len: u16,
    /// Position of its block in the source.
    pub position: u32,
}

/// What a block turned out to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// An intact sector.
    Sector(SectorKey),
    /// The marker of a block that the log has not reached yet.
    Blank,
    /// Once a sector, or meant to be one; torn or decayed.
    Damaged {
        /// Position of the block in the source.
        position: u32,
    },
    /// An intact sector of a format version that this reader does not know.
    OtherVersion {
        /// Position of the block in the source.
        position: u32,
        /// That version.
        version: u8,
    },
    /// Something else.
    Foreign,
    /// The device does not give the block back.
    Unreadable {
        /// Position of the block in the source.
        position: u32,
    },
}

/// How many blocks of each sort there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Survey {
    /// Intact sectors.
    pub sectors: usize,
    /// Blocks that the log has not reached.
    pub blank: usize,
    /// Damaged sectors.
    pub damaged: usize,
    /// Sectors of other format versions.
    pub other_versions: usize,
    /// Blocks that are not of the log.
    pub foreign: usize,
    /// Blocks that could not be read.
    pub unreadable: usize,
    /// Copies of sectors that are there already: each is written twice; [`order`] tells.
    pub duplicates: usize,
}

impl Survey {
    /// Count a block, and hand its key on if it is a sector.
    pub fn count(&mut self, found: Found) -> Option<SectorKey> {
        let (counter, key) = match found {
            Found::Sector(key) => (&mut self.sectors, Some(key)),
            Found::Blank => (&mut self.blank, None),
            Found::Damaged { .. } => (&mut self.damaged, None),
            Found::OtherVersion { .. } => (&mut self.other_versions, None),
            Found::Foreign => (&mut self.foreign, None),
            Found::Unreadable { .. } => (&mut self.unreadable, None),
        };
        *counter += 1;
        key
    }
}

/// Looks at every block of a source, once.
#[derive(Debug)]
pub struct Scan<'s, S> {
    source: &'s mut S,
    next: u32,
}

impl<'s, S: BlockSource> Scan<'s, S> {
    /// Scan a source from its first block to its last.
    pub fn new(source: &'s mut S) -> Self {
        Self { source, next: 0 }
    }
}

impl<S: BlockSource> Iterator for Scan<'_, S> {
    type Item = Found;

    fn next(&mut self) -> Option<Found> {
        if self.next >= self.source.blocks() {
            return None;
        }
        let position = self.next;
        self.next += 1;
        let mut block = [0; BLOCK_LEN];
        Some(match self.source.read(position, &mut block) {
            Ok(()) => classify(&block, position),
            Err(_) => Found::Unreadable { position },
        })
    }
}

fn classify(block: &BlockBytes, position: u32) -> Found {
    match Sector::parse(block) {
        Ok(sector) => Found::Sector(SectorKey { id: sector.id(), payload_len: sector.payload_len(), position }),
        Err(SectorError::Damaged) => Found::Damaged { position },
        Err(SectorError::Version(version)) => Found::OtherVersion { position, version },
        Err(SectorError::NotASector) if is_blank(block) => Found::Blank,
        Err(SectorError::NotASector) => Found::Foreign,
    }
}

/// Bring sectors into the order in which they were written, and move those to the end of which there is a better copy.
/// Returns how many are left before these.
///
/// Each sector is written twice, and goes to the next place as well when a card reports an error for a block that it has
/// stored after all. The longer copy holds all that the shorter one does.
pub fn order(keys: &mut [SectorKey]) -> usize {
    keys.sort_unstable_by_key(|key| (key.id, Reverse(key.payload_len), key.position));
    let mut kept: usize = 0;
    for i in 0..keys.len() {
        let previous = kept.checked_sub(1).and_then(|last| keys.get(last));
        let is_new = match (previous, keys.get(i)) {
            (Some(previous), Some(key)) => previous.id != key.id,
            _ => true,
        };
        if is_new {
            keys.swap(kept, i);
            kept += 1;
        }
    }
    kept
}

/// What comes out of the log, in order.
#[derive(Clone, Debug, PartialEq)]
// Consumed one at a time.
#[allow(clippy::large_enum_variant)]
pub enum Recovered {
    /// The sectors from here on are of this session.
    Session(SectorId),
    /// Sectors of this session are missing here, before the sector that comes next. Those missing at the end of a
    /// session leave no trace.
    Missing {
        /// How many.
        sectors: u32,
    },
    /// A sector was intact before and is not now, or can no longer be read.
    SectorLost(SectorKey),
    /// A record.
    Record(Record),
    /// Something in an intact sector that this reader cannot read.
    Unreadable(DecodeError),
}

/// Reads the records of sectors in the order given.
#[derive(Debug)]
pub struct Records<'s, 'k, S> {
    source: &'s mut S,
    keys: &'k [SectorKey],
    previous: Option<SectorId>,
    block: BlockBytes,
    /// Where the next record starts in the sector's records; `None` between sectors.
    offset: Option<usize>,
    announced: bool,
}

impl<'s, 'k, S: BlockSource> Records<'s, 'k, S> {
    /// Read the sectors that [`order`] has ordered, from the source that they were found in.
    pub fn new(source: &'s mut S, keys: &'k [SectorKey]) -> Self {
        Self { source, keys, previous: None, block: [0; BLOCK_LEN], offset: None, announced: false }
    }

    /// What is to be said before the sector itself, once for each thing.
    fn announce(&mut self, id: SectorId) -> Option<Recovered> {
        let same_session = |previous: &SectorId| SectorId { sequence: id.sequence, ..*previous } == id;
        let expected = match self.previous {
            Some(previous) if same_session(&previous) => previous.sequence.wrapping_add(1),
            _ => {
                // So that the first sector itself is the next expected.
                self.previous = Some(SectorId { sequence: u32::MAX, ..id });
                return Some(Recovered::Session(id));
            }
        };
        let missing = id.sequence.wrapping_sub(expected);
        (missing > 0 && !self.announced).then(|| {
            self.announced = true;
            Recovered::Missing { sectors: missing }
        })
    }

    fn record(&mut self, offset: usize) -> Option<Recovered> {
        let sector = Sector::parse_checked(&self.block).ok()?;
        let mut records = sector.records_from(offset);
        let item = records.next()?;
        self.offset = Some(records.offset());
        Some(match item {
            Ok(record) => Recovered::Record(record),
            Err(error) => Recovered::Unreadable(error),
        })
    }

    /// Read the next sector; reports it when it is no longer what it was.
    fn load(&mut self, key: SectorKey) -> Option<Recovered> {
        self.announced = false;
        self.previous = Some(key.id);
        let read = self.source.read(key.position, &mut self.block).is_ok();
        if read && Sector::parse(&self.block).is_ok_and(|sector| sector.id() == key.id) {
            self.offset = Some(0);
            return None;
        }
        Some(Recovered::SectorLost(key))
    }
}

impl<S: BlockSource> Iterator for Records<'_, '_, S> {
    type Item = Recovered;

    fn next(&mut self) -> Option<Recovered> {
        loop {
            if let Some(item) = self.offset.and_then(|offset| self.record(offset)) {
                return Some(item);
            }
            self.offset = None;
            let (&key, rest) = self.keys.split_first()?;
            if let Some(item) = self.announce(key.id) {
                return Some(item);
            }
            self.keys = rest;
            if let Some(item) = self.load(key) {
                return Some(item);
            }
        }
    }
}

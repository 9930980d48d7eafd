//! Records into sectors into blocks, in order, each block once.
//!
//! # What is promised
//!
//! [`SectorWriter::durable`] counts a record only when the sector that holds it has been written, synchronised and read
//! back equal, from both of its places on a card. A sector is written to blocks that hold the blank marker of their
//! position and nowhere else, so nothing that was ever written is written over, by this instance or by a later one,
//! whatever it believes. But for one: before a log goes on, a sector of which one copy is spoilt is written over that one again.
//!
//! So a record that is counted survives a power cut at any time on a card that keeps what it has acknowledged, also when
//! the block that is being written is torn, or turns to garbage with the erase block around it; and a second cut at any time
//! after it. A card that acknowledges what it only holds in a cache may lose as much as it held.
//!
//! # Where the log ends
//!
//! After a restart the end of the log is found by bisection. A single block is no good test, since damage would mislead
//! it: a position counts as written when any of the [`WINDOW`] blocks from it on is not blank, and what is unreadable or
//! damaged is not blank. Lost or failed writes leave holes of blank blocks; those shorter than the window do not matter.
//! With a longer hole the log would go on inside it. Even then nothing behind the hole is overwritten, by the rule above;
//! only the order of the sessions could no longer be told from `session_start`. The search reads at most 32 x `WINDOW`
//! blocks, whatever the size of the region.

use super::block::{BLOCK_LEN, BlockBytes, BlockSink, CRC, Region, is_blank_at};
use super::record::{Event, EventKind, Record};
use super::sector::{PAYLOAD_LEN, SectorBuilder, SectorId};

/// Blocks that are read from a position on, to decide whether the log has reached it.
pub const WINDOW: u32 = 32;

/// Blocks that are tried for one sector before the caller is told.
const ATTEMPTS: u32 = 8;

/// Blocks found in use that one call steps over, so that it ends in a second or two even on a swapped card.
const LONGEST_STEP: u32 = 1024;

/// After failures, each call starts further on, up to this many blocks, then again at the first.
const FURTHEST_SKIP: u32 = 1024;

/// Why a record was not taken. Nothing that was taken before is lost by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AppendError<E> {
    /// There is no blank block left in the region.
    Full,
    /// Only blocks in use so far, where blank ones should be: damage, or another card. The next call looks further.
    InUse,
    /// Several blocks in a row failed; the last with this error. Worth trying again.
    Device(E),
    /// Several blocks in a row failed; the last took the sector without an error and gave something else back.
    NotStored,
    /// The record cannot be encoded, or is longer than a sector's payload.
    TooLong,
}

impl<E: core::fmt::Display> core::fmt::Display for AppendError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Full => write!(f, "the log region is full"),
            Self::InUse => write!(f, "the log region holds something where it should be blank"),
            Self::Device(error) => write!(f, "the card does not take the log: {error}"),
            Self::NotStored => write!(f, "the card does not keep what is written to it"),
            Self::TooLong => write!(f, "the record has no place in a sector"),
        }
    }
}

impl<E: core::fmt::Debug + core::fmt::Display> core::error::Error for AppendError<E> {}

/// What is safe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Durable {
    /// Records of this session that would survive a power cut: always the first of those taken.
    pub records: u32,
    /// Sectors that hold them.
    pub sectors: u32,
    /// Tick of the last record among them.
    pub last_tick: Option<u32>,
}

/// Fills sectors and writes them. Holds two blocks of memory.
#[derive(Debug)]
pub struct SectorWriter<D> {
    device: D,
    session: u32,
    session_start: u32,
    /// Of the sector that is being filled.
    sequence: u32,
    /// Records of the caller in it.
    pending: u32,
    /// The first position that is not known to be used up.
    position: u32,
    /// After failures, the next attempt starts this many blocks beyond `position`.
    skip: u32,
    sector: SectorBuilder,
    scratch: BlockBytes,
    taken: u32,
    last_tick: Option<u32>,
    durable: Durable,
    bad: Option<Bad>,
    carried: Option<Filling>,
}

/// A sector from the region before, and how many records of the caller are in it.
#[derive(Clone, Debug)]
struct Filling {
    sector: SectorBuilder,
    records: u32,
    last_tick: Option<u32>,
}

/// Failed attempts not yet in the log.
#[derive(Clone, Copy, Debug)]
struct Bad {
    first_position: u32,
    blocks: u32,
}

/// What became of an attempt at one block.
enum Attempt<E> {
    Stored,
    InUse,
    Failed(AppendError<E>),
}

impl<D: BlockSink> SectorWriter<D> {
    /// Go on after whatever the region holds, as a new session. `session` is a number that no other session is
    /// likely to have. The caller appends a [`Record::Header`] first. Reads up to about a thousand blocks.
    pub fn resume(mut device: D, session: u32) -> Self {
        let position = find_end(&mut device);
        Self {
            device,
            session,
            session_start: position,
            sequence: 0,
            pending: 0,
            position,
            skip: 0,
            sector: SectorBuilder::default(),
            scratch: [0; BLOCK_LEN],
            taken: 0,
            last_tick: None,
            durable: Durable::default(),
            bad: None,
            carried: None,
        }
    }

    /// Make the session's number depend on where the session begins, and in which file: no two sessions begin at the same
    /// place, but two starts of the chip may well take equally long.
    pub fn distinguish(&mut self) {
        let Region { file_number, nonce } = self.device.region();
        let mut digest = CRC.digest();
        digest.update(&self.session.to_le_bytes());
        digest.update(&nonce.to_le_bytes());
        digest.update(&file_number.to_le_bytes());
        digest.update(&self.session_start.to_le_bytes());
        self.session = digest.finalize();
    }

    /// Take a record; writes a sector when it is the first that does not fit. On an error the record was not taken.
    pub fn append(&mut self, record: &Record) -> Result<(), AppendError<D::Error>> {
        let mut encoded = [0; PAYLOAD_LEN];
        let len = record.encode(&mut encoded).ok_or(AppendError::TooLong)?;
        self.append_encoded(encoded.get(..len).unwrap_or_default())?;
        Ok(())
    }

    /// The same with a record that is already encoded.
    pub fn append_encoded(&mut self, record: &[u8]) -> Result<(), AppendError<D::Error>> {
        if self.sector.push_encoded(record).is_err() {
            self.flush()?;
            self.sector.push_encoded(record).map_err(|_| AppendError::TooLong)?;
        }
        self.taken = self.taken.saturating_add(1);
        self.pending += 1;
        if let Ok((decoded, _)) = Record::decode(record) {
            self.last_tick = Some(decoded.tick());
        }
        Ok(())
    }

    /// Write out what has been taken, as a sector that may be short. At the end of a session, or when records must not
    /// wait for a full sector; each call costs a block.
    pub fn flush(&mut self) -> Result<(), AppendError<D::Error>> {
        if self.sector.is_empty() { Ok(()) } else { self.write_out() }
    }

    /// What is safe so far.
    pub fn durable(&self) -> Durable {
        self.durable
    }

    /// Records taken, durable or not.
    pub fn taken(&self) -> u32 {
        self.taken
    }

    /// Blocks that are left at most; one a second at 10 Hz.
    pub fn blocks_left(&self) -> u32 {
        self.device.blocks().saturating_sub(self.position)
    }

    /// The region.
    pub fn device(&self) -> &D {
        &self.device
    }

    /// The region, back from the writer; what has not been flushed is gone.
    pub fn into_device(self) -> D {
        self.device
    }

    /// The region, for what is to be done to it besides.
    pub fn device_mut(&mut self) -> &mut D {
        &mut self.device
    }

    /// Go on in the same region after it was away: the card may have lost what it had acknowledged. The session stays, and
    /// the sector that is being filled.
    pub fn look_again(&mut self) {
        self.position = find_end(&mut self.device);
    }

    /// Go on in another region, which `make` makes of this one. The session stays. The sector that is being filled waits for
    /// [`take_up`](Self::take_up), so that what the region shall begin with comes before it.
    pub fn move_to(self, make: impl FnOnce(D) -> D) -> Self {
        let carried =
            self.carried.or(Some(Filling { sector: self.sector, records: self.pending, last_tick: self.last_tick }));
        let next = Self::resume(make(self.device), self.session);
        Self { taken: self.taken, durable: self.durable, carried, ..next }
    }

    /// After [`move_to`](Self::move_to): write what the region begins with, and go on with the sector from before.
    pub fn take_up(&mut self) -> Result<(), AppendError<D::Error>> {
        if self.carried.is_some() {
            self.flush()?;
        }
        if let Some(Filling { sector, records, last_tick }) = self.carried.take() {
            (self.sector, self.pending, self.last_tick) = (sector, records, last_tick);
        }
        Ok(())
    }

    /// Find a block for the sector. Keeps it when there is none.
    fn write_out(&mut self) -> Result<(), AppendError<D::Error>> {
        let (mut failures, mut in_use) = (0, 0);
        let mut position = self.position.saturating_add(self.skip);
        let mut error = AppendError::Full;
        while position < self.device.blocks() {
            match self.attempt(position) {
                Attempt::Stored => {
                    self.stored_at(position);
                    return Ok(());
                }
                Attempt::InUse => {
                    in_use += 1;
                    self.step_over(position);
                }
                Attempt::Failed(failure) => {
                    self.note_bad(position);
                    failures += 1;
                    error = failure;
                }
            }
            if failures == ATTEMPTS {
                self.skip = (self.skip + ATTEMPTS) % FURTHEST_SKIP;
                return Err(error);
            }
            if in_use == LONGEST_STEP {
                return Err(AppendError::InUse);
            }
            position += 1;
        }
        // The end of the region: next time from the first block again, whose failure may have passed.
        self.skip = 0;
        Err(error)
    }

    /// A block in use never becomes blank again; one that failed may work the next time.
    fn step_over(&mut self, position: u32) {
        if position == self.position {
            self.position += 1;
        }
    }

    fn attempt(&mut self, position: u32) -> Attempt<D::Error> {
        if let Err(error) = self.device.read(position, &mut self.scratch) {
            return Attempt::Failed(AppendError::Device(error));
        }
        if !is_blank_at(self.device.region(), position, &self.scratch) {
            return Attempt::InUse;
        }
        match self.store(position) {
            Ok(true) => Attempt::Stored,
            Ok(false) => Attempt::Failed(AppendError::NotStored),
            Err(error) => Attempt::Failed(AppendError::Device(error)),
        }
    }

    /// Write, synchronise, read back; false when it comes back different.
    fn store(&mut self, position: u32) -> Result<bool, D::Error> {
        let id = SectorId {
            file_number: self.device.region().file_number,
            session_start: self.session_start,
            session: self.session,
            sequence: self.sequence,
        };
        let block = self.sector.seal(id, self.device.region().tag());
        self.device.write(position, block)?;
        self.device.sync()?;
        self.device.holds(position, block)
    }

    fn stored_at(&mut self, position: u32) {
        self.durable.records += core::mem::take(&mut self.pending);
        self.durable.sectors += 1;
        self.sequence += 1;
        self.durable.last_tick = self.last_tick;
        self.position = position + 1;
        self.skip = 0;
        self.sector = SectorBuilder::default();
        if let Some(Bad { first_position, blocks }) = self.bad.take() {
            let kind = EventKind::BadBlocks { first_position, blocks };
            // An empty sector has room for it.
            let _ = self.sector.push(&Record::Event(Event { tick: self.last_tick.unwrap_or(0), kind }));
        }
    }

    fn note_bad(&mut self, position: u32) {
        let bad = self.bad.get_or_insert(Bad { first_position: position, blocks: 0 });
        bad.blocks = bad.blocks.saturating_add(1);
    }
}

/// The first position from which on the region is blank; see the head of this file.
pub(super) fn find_end<D: BlockSink>(device: &mut D) -> u32 {
    first_without(device.blocks(), |position| is_written_from(device, position))
}

/// The first position below `end`, or `end`, that `is_reached` does not hold for, where all before it are: by bisection.
pub(super) fn first_without(end: u32, mut is_reached: impl FnMut(u32) -> bool) -> u32 {
    let (mut low, mut high) = (0, end);
    while low < high {
        let middle = low + (high - low) / 2;
        if is_reached(middle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

/// Whether any block of the window is written. Blocks that cannot be read do not say; if none can, it counts as
/// written.
fn is_written_from<D: BlockSink>(device: &mut D, position: u32) -> bool {
    let mut block = [0; BLOCK_LEN];
    let mut readable = false;
    for position in position..position.saturating_add(WINDOW).min(device.blocks()) {
        if device.read(position, &mut block).is_ok() {
            readable = true;
            if !is_blank_at(device.region(), position, &block) {
                return true;
            }
        }
    }
    !readable
}

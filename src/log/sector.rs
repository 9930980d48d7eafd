//! Sectors: whole records in 512 bytes that stand on their own.
//!
//! | offset | bytes | |
//! |---|---|---|
//! | 0 | 4 | `"TMLS"` |
//! | 4 | 1 | format version, 1 |
//! | 5 | 1 | 0 |
//! | 6 | 2 | payload length |
//! | 8 | 2 | file number |
//! | 10 | 2 | tag of the file; 0 in files of layout version 1 |
//! | 12 | 4 | session |
//! | 16 | 4 | session start |
//! | 20 | 4 | sequence |
//! | 24 | 484 | records, then zeros |
//! | 508 | 4 | CRC-32 (ISO-HDLC) of all before it |

use super::block::{BLOCK_LEN, BlockBytes, crc_fits, put_crc};
use super::record::{DecodeError, Record};
use crate::bytes::{Put, Take};

/// Version of the format of sectors and records. A reader refuses others.
pub const FORMAT_VERSION: u8 = 1;

/// Bytes that a sector has for records.
pub const PAYLOAD_LEN: usize = BLOCK_LEN - HEAD_LEN - 4;

const HEAD_LEN: usize = 24;
const MAGIC: [u8; 4] = *b"TMLS";

/// Where a sector belongs. The order of these is the order in time, within a card that was formatted once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SectorId {
    /// Number of the log file, 1 to 99.
    pub file_number: u16,
    /// Position in the file's region from which the session was written: grows from session to session.
    pub session_start: u32,
    /// Random number of the session, that is of one start of the firmware.
    pub session: u32,
    /// Counts the sectors of the session, from 0.
    pub sequence: u32,
}

/// Why a block is not a sector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectorError {
    /// It does not even begin like one.
    NotASector,
    /// It begins like one, but its CRC does not fit: torn or decayed.
    Damaged,
    /// It is intact, but of another format version.
    Version(u8),
}

/// An intact sector.
#[derive(Clone, Copy, Debug)]
pub struct Sector<'a> {
    id: SectorId,
    tag: u16,
    payload: &'a [u8],
}

impl<'a> Sector<'a> {
    /// Check a block and read its head.
    pub fn parse(block: &'a BlockBytes) -> Result<Self, SectorError> {
        if !block.starts_with(&MAGIC) {
            return Err(SectorError::NotASector);
        }
        if !crc_fits(block) {
            return Err(SectorError::Damaged);
        }
        Self::parse_checked(block)
    }

    /// The same for a block that was parsed before and has not changed since.
    pub(super) fn parse_checked(block: &'a BlockBytes) -> Result<Self, SectorError> {
        let mut take = Take(block.get(MAGIC.len()..).unwrap_or_default());
        match take.u8() {
            Some(FORMAT_VERSION) => Self::parse_head(take).ok_or(SectorError::Damaged),
            version => Err(SectorError::Version(version.unwrap_or(0))),
        }
    }

    fn parse_head(mut take: Take<'a>) -> Option<Self> {
        take.u8()?;
        let payload_len = take.u16()?;
        let file_number = take.u16()?;
        let tag = take.u16()?;
        let (session, session_start, sequence) = (take.u32()?, take.u32()?, take.u32()?);
        let payload = take.bytes(PAYLOAD_LEN)?.get(..usize::from(payload_len))?;
        Some(Self { id: SectorId { file_number, session_start, session, sequence }, tag, payload })
    }

    /// Where it belongs.
    pub fn id(&self) -> SectorId {
        self.id
    }

    /// Of the file that it was written to.
    pub(super) fn tag(&self) -> u16 {
        self.tag
    }

    /// Its records, in order.
    pub fn records(&self) -> SectorRecords<'a> {
        self.records_from(0)
    }

    /// Bytes of records in it, at most [`PAYLOAD_LEN`].
    pub fn payload_len(&self) -> u16 {
        self.payload.len() as u16
    }

    /// Its records from an offset on that [`SectorRecords::offset`] gave.
    pub(super) fn records_from(&self, offset: usize) -> SectorRecords<'a> {
        SectorRecords { payload: self.payload, offset }
    }
}

/// The records of one sector. Steps over records that it cannot read, after reporting them.
#[derive(Clone, Debug)]
pub struct SectorRecords<'a> {
    payload: &'a [u8],
    offset: usize,
}

impl SectorRecords<'_> {
    /// Where the next record starts in the payload, bytes.
    pub(super) fn offset(&self) -> usize {
        self.offset
    }
}

impl Iterator for SectorRecords<'_> {
    type Item = Result<Record, DecodeError>;

    fn next(&mut self) -> Option<Self::Item> {
        let rest = self.payload.get(self.offset..).filter(|rest| !rest.is_empty())?;
        let (item, len) = match Record::decode(rest) {
            Ok((record, len)) => (Ok(record), len),
            Err(error @ DecodeError::Truncated) => (Err(error), rest.len()),
            Err(error @ (DecodeError::UnknownKind { len, .. } | DecodeError::Malformed { len, .. })) => {
                (Err(error), len)
            }
        };
        self.offset += len;
        Some(item)
    }
}

/// There is no room for the record in this sector, or it cannot be encoded at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SectorFull;

/// A sector that is being filled.
#[derive(Clone, Debug)]
pub struct SectorBuilder {
    block: BlockBytes,
    payload_len: usize,
    records: u32,
}

impl Default for SectorBuilder {
    fn default() -> Self {
        Self { block: [0; BLOCK_LEN], payload_len: 0, records: 0 }
    }
}

impl SectorBuilder {
    /// Add a record, whole or not at all.
    pub fn push(&mut self, record: &Record) -> Result<(), SectorFull> {
        let len = self.free().and_then(|free| record.encode(free));
        // An encoding that broke off has left bytes behind.
        if len.is_none() {
            self.clear_free();
        }
        self.took(len)
    }

    /// Add a record that is already encoded, whole or not at all.
    pub fn push_encoded(&mut self, record: &[u8]) -> Result<(), SectorFull> {
        let len = self.free().and_then(|free| free.get_mut(..record.len())).map(|place| {
            place.copy_from_slice(record);
            record.len()
        });
        self.took(len)
    }

    /// Records in it.
    pub fn records(&self) -> u32 {
        self.records
    }

    /// Whether it holds no record.
    pub fn is_empty(&self) -> bool {
        self.records == 0
    }

    /// The finished block. Records may still be added; the block must then be sealed again.
    pub(super) fn seal(&mut self, id: SectorId, tag: u16) -> &BlockBytes {
        let mut put = Put::new(&mut self.block);
        put.bytes(&MAGIC);
        put.u8(FORMAT_VERSION);
        put.u8(0);
        put.u16(self.payload_len as u16); // at most PAYLOAD_LEN
        put.u16(id.file_number);
        put.u16(tag);
        put.u32(id.session);
        put.u32(id.session_start);
        put.u32(id.sequence);
        put_crc(&mut self.block);
        &self.block
    }

    fn free(&mut self) -> Option<&mut [u8]> {
        self.block.get_mut(HEAD_LEN..HEAD_LEN + PAYLOAD_LEN)?.get_mut(self.payload_len..)
    }

    fn clear_free(&mut self) {
        if let Some(free) = self.free() {
            free.fill(0);
        }
    }

    fn took(&mut self, len: Option<usize>) -> Result<(), SectorFull> {
        self.payload_len += len.ok_or(SectorFull)?;
        self.records += 1;
        Ok(())
    }
}

//! What the log can hold, and how one record looks in bytes.
//!
//! A record is a kind, the length of its body (both one byte) and the body. A reader that does not know a kind can
//! step over it. The layouts of the bodies are in the documentation of the types; they are those of
//! [`FORMAT_VERSION`](super::FORMAT_VERSION) 1, and a change to any of them needs a new version.

mod epoch;
mod event;
mod fluxgate_axes;
mod header;
mod information;
mod kind;
#[cfg(test)]
mod tests;

use crate::bytes::{Put, Take};
pub use epoch::EpochRecord;
pub use event::{Event, EventKind, ResetCause, TEXT_LEN};
pub use fluxgate_axes::FluxgateAxes;
pub use header::{Header, VERSION_LEN};
pub use information::{InformationPart, InformationParts};
use kind::{EPOCH, EVENT, HEADER, LOSS};

/// One entry of the log.
#[derive(Clone, Debug, PartialEq)]
// Records are encoded where they are made; the only copies of this enum are on the stack.
#[allow(clippy::large_enum_variant)]
pub enum Record {
    /// What wrote the records after it, with which settings. First in every session. Kind 1.
    Header(Header),
    /// One tick: inputs, answer, and what was measured beside them. Kind 2.
    Epoch(EpochRecord),
    /// Something that happened. Kind 3.
    Event(Event),
    /// Records that should be here and are not. Kind 4.
    Loss(Loss),
}

/// Records that were made but could not be kept, because the card did not take them in time.
///
/// Body: `first_tick u32, epochs u32, others u32`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Loss {
    /// Tick of the first record that was lost.
    pub first_tick: u32,
    /// Number of epoch records lost; not necessarily of consecutive ticks.
    pub epochs: u32,
    /// Number of records of other kinds lost.
    pub others: u32,
}

/// Why bytes are not a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DecodeError {
    /// The bytes end before the record does.
    Truncated,
    /// The kind is not known to this version; the next record starts `len` bytes on.
    UnknownKind {
        /// The kind.
        kind: u8,
        /// Length of the whole record, bytes.
        len: usize,
    },
    /// The body is not what its kind must be; the next record starts `len` bytes on.
    Malformed {
        /// The kind.
        kind: u8,
        /// Length of the whole record, bytes.
        len: usize,
    },
}

impl core::fmt::Display for DecodeError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Truncated => write!(f, "record is cut off"),
            Self::UnknownKind { kind, len } => write!(f, "record of unknown kind {kind}, {len} bytes"),
            Self::Malformed { kind, len } => write!(f, "malformed record of kind {kind}, {len} bytes"),
        }
    }
}

impl core::error::Error for DecodeError {}

/// Bytes before the body: kind and length.
const FRAME_LEN: usize = 2;

impl Record {
    /// Longest record, bytes.
    pub const MAX_LEN: usize = FRAME_LEN + u8::MAX as usize;

    /// Write the record to the front of `out` and return its length in bytes. `None` when `out` is too short, or when
    /// a value has no place in the format (a band-pass order above 255); `out` is then of no use.
    pub fn encode(&self, out: &mut [u8]) -> Option<usize> {
        let (frame, body) = out.split_first_chunk_mut::<FRAME_LEN>()?;
        let mut put = Put::new(body);
        let kind = match self {
            Self::Header(header) => header.put(&mut put),
            Self::Epoch(epoch) => epoch.put(&mut put),
            Self::Event(event) => event.put(&mut put),
            Self::Loss(loss) => loss.put(&mut put),
        };
        let body_len = put.finish()?;
        *frame = [kind, u8::try_from(body_len).ok()?];
        Some(FRAME_LEN + body_len)
    }

    /// Read the record at the front of `bytes`, and its length in bytes. Never panics, whatever the bytes.
    pub fn decode(bytes: &[u8]) -> Result<(Self, usize), DecodeError> {
        let (&[kind, body_len], rest) = bytes.split_first_chunk::<FRAME_LEN>().ok_or(DecodeError::Truncated)?;
        let body = rest.get(..usize::from(body_len)).ok_or(DecodeError::Truncated)?;
        let len = FRAME_LEN + body.len();
        let mut take = Take(body);
        let record = match kind {
            HEADER => Header::take(&mut take).map(Self::Header),
            EPOCH => EpochRecord::take(&mut take).map(Self::Epoch),
            EVENT => Event::take(&mut take).map(Self::Event),
            LOSS => Loss::take(&mut take).map(Self::Loss),
            _ => return Err(DecodeError::UnknownKind { kind, len }),
        };
        // A body that is longer than it should be is not of this version.
        record.filter(|_| take.is_empty()).map(|record| (record, len)).ok_or(DecodeError::Malformed { kind, len })
    }

    /// The tick of an epoch or event, of the start of a session, or of the first record that was lost.
    pub fn tick(&self) -> u32 {
        match self {
            Self::Header(header) => header.start_tick,
            Self::Epoch(record) => record.epoch.tick,
            Self::Event(event) => event.tick,
            Self::Loss(loss) => loss.first_tick,
        }
    }
}

impl Loss {
    fn put(&self, put: &mut Put<'_>) -> u8 {
        put.u32(self.first_tick);
        put.u32(self.epochs);
        put.u32(self.others);
        LOSS
    }

    fn take(take: &mut Take<'_>) -> Option<Self> {
        Some(Self { first_tick: take.u32()?, epochs: take.u32()?, others: take.u32()? })
    }
}

/// As much of `text` as `N` bytes hold, cut between two characters.
pub fn truncated<const N: usize>(text: &str) -> heapless::String<N> {
    let mut kept = heapless::String::new();
    for character in text.chars() {
        if kept.push(character).is_err() {
            break;
        }
    }
    kept
}

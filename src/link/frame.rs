//! Frames on the tow cable, body to ship.
//!
//! ```text
//! 0x00 | COBS( kind u8 | body 0 to 120 bytes | CRC-32 u32, little-endian, of kind and body ) | 0x00
//! ```
//!
//! COBS (Cheshire, Baker, "Consistent Overhead Byte Stuffing", 1999) leaves no zero inside a frame, for one more byte. The
//! zero in front makes that whatever came before, however long and however cut, ends there and costs nothing but itself.
//! The CRC is that of Ethernet and zip (CRC-32/ISO-HDLC).

use crc::{CRC_32_ISO_HDLC, Crc};

/// Longest body, bytes.
pub const MAX_BODY: usize = 120;

/// Kind, body and CRC.
const MAX_CONTENT: usize = 1 + MAX_BODY + CRC_LEN;
const CRC_LEN: usize = 4;

/// The content with the byte that COBS adds to less than 255.
const MAX_STUFFED: usize = MAX_CONTENT + 1;

/// Longest frame with both its zeros, bytes: a little more than 9,600 baud carry in an epoch of 100 ms.
pub const MAX_FRAME: usize = MAX_STUFFED + 2;

/// Bytes that a frame adds to its body.
pub const FRAME_OVERHEAD: usize = MAX_FRAME - MAX_BODY;

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// A frame as it goes over the wire.
pub type Frame = heapless::Vec<u8, MAX_FRAME>;

/// What is in a frame. A new layout of a body gets a new kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    /// 1: a [`Telemetry`](super::Telemetry) message.
    Telemetry,
    /// 2: one line of text in UTF-8, without a line end: an answer of the console.
    Text,
    /// 3: what the program counts and costs, u32 each, in an order that is that of the version.
    Figures,
    /// 4: a [`NavigationMessage`](super::NavigationMessage), at most twice a second.
    Navigation,
    /// 5: a [`HousekeepingMessage`](super::HousekeepingMessage), every five seconds, and when a leak begins or ends.
    Housekeeping,
}

impl FrameKind {
    fn code(self) -> u8 {
        match self {
            Self::Telemetry => 1,
            Self::Text => 2,
            Self::Figures => 3,
            Self::Navigation => 4,
            Self::Housekeeping => 5,
        }
    }

    fn of(code: u8) -> Option<Self> {
        match code {
            1 => Some(Self::Telemetry),
            2 => Some(Self::Text),
            3 => Some(Self::Figures),
            4 => Some(Self::Navigation),
            5 => Some(Self::Housekeeping),
            _ => None,
        }
    }
}

/// The frame around a body; `None` when the body is longer than [`MAX_BODY`].
pub fn frame(kind: FrameKind, body: &[u8]) -> Option<Frame> {
    let mut content: heapless::Vec<u8, MAX_CONTENT> = heapless::Vec::new();
    content.push(kind.code()).ok()?;
    content.extend_from_slice(body).ok()?;
    let crc = CRC.checksum(&content);
    content.extend_from_slice(&crc.to_le_bytes()).ok()?;
    let mut stuffed = [0; MAX_STUFFED];
    let len = cobs::try_encode(&content, &mut stuffed).ok()?;
    let mut frame = Frame::new();
    frame.push(0).ok()?;
    frame.extend_from_slice(stuffed.get(..len)?).ok()?;
    frame.push(0).ok()?;
    Some(frame)
}

/// The frame of a line of text. What is beyond [`MAX_BODY`] bytes is cut off, at the end of a character.
pub fn text_frame(line: &str) -> Frame {
    let end = line.floor_char_boundary(MAX_BODY);
    // Never too long after the cut; an empty frame is nothing to the receiver.
    frame(FrameKind::Text, line.get(..end).unwrap_or_default().as_bytes()).unwrap_or_default()
}

/// A frame that came in whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Received<'a> {
    /// What is in it.
    pub kind: FrameKind,
    /// Its body, at most [`MAX_BODY`] bytes.
    pub body: &'a [u8],
}

/// What came in since the start. Full counters stay full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameCounters {
    /// Frames of a known kind.
    pub good: u32,
    /// Stretches between two zeros that are no frame: damaged, cut, too long, or rubbish.
    pub bad: u32,
    /// Bytes in them.
    pub bad_bytes: u32,
    /// Whole frames of a kind that this version does not know.
    pub unknown: u32,
}

/// Picks frames out of a stream of bytes. It needs no set-up and cannot be led astray: the frame after any rubbish is read.
#[derive(Clone, Debug)]
pub struct FrameReader {
    stuffed: [u8; MAX_STUFFED],
    content: [u8; MAX_CONTENT],
    /// Bytes since the last zero, those that had no room included.
    len: usize,
    counters: FrameCounters,
}

impl Default for FrameReader {
    fn default() -> Self {
        Self {
            stuffed: [0; MAX_STUFFED],
            content: [0; MAX_CONTENT],
            len: 0,
            counters: FrameCounters { good: 0, bad: 0, bad_bytes: 0, unknown: 0 },
        }
    }
}

impl FrameReader {
    /// One byte. A frame comes out with the zero that ends it.
    pub fn push(&mut self, byte: u8) -> Option<Received<'_>> {
        if byte != 0 {
            if let Some(place) = self.stuffed.get_mut(self.len) {
                *place = byte;
            }
            self.len = self.len.saturating_add(1);
            return None;
        }
        let len = core::mem::take(&mut self.len);
        if len == 0 {
            return None;
        }
        let Some(content_len) = self.unpack(len) else {
            count(&mut self.counters.bad, 1);
            count(&mut self.counters.bad_bytes, len);
            return None;
        };
        let (&code, body) = self.content.get(..content_len)?.split_first()?;
        let Some(kind) = FrameKind::of(code) else {
            count(&mut self.counters.unknown, 1);
            return None;
        };
        count(&mut self.counters.good, 1);
        Some(Received { kind, body })
    }

    /// What came in since the start.
    pub fn counters(&self) -> FrameCounters {
        self.counters
    }

    /// Length of kind and body, if the bytes are a frame's.
    fn unpack(&mut self, len: usize) -> Option<usize> {
        let decoded = cobs::decode(self.stuffed.get(..len)?, &mut self.content).ok()?.frame_size();
        let (content, crc) = self.content.get(..decoded)?.split_last_chunk::<CRC_LEN>()?;
        (!content.is_empty() && CRC.checksum(content).to_le_bytes() == *crc).then_some(content.len())
    }
}

fn count(counter: &mut u32, more: usize) {
    *counter = counter.saturating_add(u32::try_from(more).unwrap_or(u32::MAX));
}

//! Leak and battery, for the people on the ship.

use super::frame::{Frame, FrameKind, frame};
use crate::bytes::{Put, Take};
use crate::housekeeping::Housekeeping;

/// Longest body of the message, bytes: with its frame 17.
const MAX_BODY: usize = 4 + Housekeeping::MAX_LEN;

/// Leak contact and battery as of an epoch.
///
/// Body, little-endian: `tick u32`, then [`Housekeeping`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HousekeepingMessage {
    /// Tick of the epoch.
    pub tick: u32,
    /// Leak contact and battery.
    pub housekeeping: Housekeeping,
}

impl HousekeepingMessage {
    /// The message in its frame, 13 or 17 bytes.
    pub fn frame(&self) -> Frame {
        let mut body = [0; MAX_BODY];
        let mut put = Put::new(&mut body);
        put.u32(self.tick);
        self.housekeeping.put(&mut put);
        // The body has room for every field: neither step fails, and an empty frame would be nothing to the receiver.
        let len = put.finish().unwrap_or(0);
        frame(FrameKind::Housekeeping, body.get(..len).unwrap_or_default()).unwrap_or_default()
    }

    /// Read a body; `None` when it is none.
    pub fn decode(body: &[u8]) -> Option<Self> {
        let mut take = Take(body);
        let (tick, housekeeping) = (take.u32()?, Housekeeping::take(&mut take)?);
        take.is_empty().then_some(Self { tick, housekeeping })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_comes_back_and_nothing_else_does() {
        let housekeeping = Housekeeping { battery_v: Some(12.5), has_leak: Some(true) };
        let message = HousekeepingMessage { tick: 7, housekeeping };
        let frame = message.frame();
        let mut reader = crate::link::FrameReader::default();
        let (last, before) = frame.split_last().unwrap();
        assert!(before.iter().all(|&byte| reader.push(byte).is_none()));
        let received = reader.push(*last).unwrap();
        assert_eq!((frame.len(), received.kind), (17, FrameKind::Housekeeping));
        assert_eq!(HousekeepingMessage::decode(received.body), Some(message));
        for end in 0..received.body.len() {
            assert_eq!(HousekeepingMessage::decode(&received.body[..end]), None);
        }
    }
}

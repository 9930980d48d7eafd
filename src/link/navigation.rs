//! Where the body is, for the people on the ship.

use super::frame::{Frame, FrameKind, frame};
use crate::bytes::{Put, Take};
use crate::navigation::Navigation;

/// Longest body of the message, bytes: with its frame 34.
const MAX_BODY: usize = 4 + Navigation::MAX_LEN;

/// What is known at an epoch; what is not in it is not known, or no longer.
///
/// Body, little-endian: `tick u32`, then [`Navigation`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavigationMessage {
    /// Tick of the epoch.
    pub tick: u32,
    /// Where the body is.
    pub navigation: Navigation,
}

impl NavigationMessage {
    /// The message in its frame, 13 to 34 bytes.
    pub fn frame(&self) -> Frame {
        let mut body = [0; MAX_BODY];
        let mut put = Put::new(&mut body);
        put.u32(self.tick);
        self.navigation.put(&mut put);
        // The body has room for every field: neither step fails, and an empty frame would be nothing to the receiver.
        let len = put.finish().unwrap_or(0);
        frame(FrameKind::Navigation, body.get(..len).unwrap_or_default()).unwrap_or_default()
    }

    /// Read a body; `None` when it is none.
    pub fn decode(body: &[u8]) -> Option<Self> {
        let mut take = Take(body);
        let (tick, navigation) = (take.u32()?, Navigation::take(&mut take)?);
        take.is_empty().then_some(Self { tick, navigation })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::navigation::Position;

    #[test]
    fn a_message_comes_back_and_nothing_else_does() {
        let position = Some(Position { latitude_e7: 1, longitude_e7: -1, fix: 1 });
        let navigation = Navigation { depth_m: Some(12.5), position, ..Navigation::default() };
        let message = NavigationMessage { tick: 7, navigation };
        let mut reader = crate::link::FrameReader::default();
        for byte in message.frame() {
            if let Some(received) = reader.push(byte) {
                assert_eq!(
                    (received.kind, NavigationMessage::decode(received.body)),
                    (FrameKind::Navigation, Some(message))
                );
                for end in 0..received.body.len() {
                    assert_eq!(NavigationMessage::decode(&received.body[..end]), None);
                }
                return;
            }
        }
        unreachable!("the frame is whole");
    }
}

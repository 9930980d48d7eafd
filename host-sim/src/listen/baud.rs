//! Which baud rate the body talks at.

use std::io::{self, ErrorKind, Read};
use std::time::{Duration, Instant};

use towmag::link::FrameReader;
use towmag::store::CABLE_BAUD;

/// What is tried, the likely ones first.
const RATES: [u32; 9] = [CABLE_BAUD, 19_200, 38_400, 9_600, 57_600, 230_400, 460_800, 921_600, 14_400];

/// How long each is listened to: a dozen of the body's messages.
const EACH: Duration = Duration::from_millis(1_200);

/// Whole frames that show that a rate is right; none comes out of noise but once in four thousand million.
const FRAMES: u32 = 2;

/// Something that can be listened to at one baud rate or another.
pub(super) trait Tunable: Read {
    /// Change the rate; what came at the old one is dropped.
    fn tune(&mut self, baud: u32) -> io::Result<()>;
}

impl Tunable for Box<dyn serialport::SerialPort> {
    fn tune(&mut self, baud: u32) -> io::Result<()> {
        self.set_baud_rate(baud)?;
        Ok(self.clear(serialport::ClearBuffer::Input)?)
    }
}

/// Try every rate once, listening for `each`. The one at which frames come, and what was heard at it.
pub(super) fn find(port: &mut impl Tunable, each: Duration) -> io::Result<Option<(u32, Vec<u8>)>> {
    for baud in RATES {
        port.tune(baud)?;
        if let Some(heard) = frames(port, each)? {
            return Ok(Some((baud, heard)));
        }
    }
    Ok(None)
}

/// Try until frames come; `tell` is called once when the first round was in vain.
pub(super) fn find_patiently(port: &mut impl Tunable, tell: impl FnOnce()) -> io::Result<(u32, Vec<u8>)> {
    if let Some(found) = find(port, EACH)? {
        return Ok(found);
    }
    tell();
    loop {
        if let Some(found) = find(port, EACH)? {
            return Ok(found);
        }
    }
}

/// Nothing came for a while, or a signal came in between.
pub(super) fn is_pause(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

/// What was heard, if it holds frames.
fn frames(port: &mut impl Read, patience: Duration) -> io::Result<Option<Vec<u8>>> {
    let (begin, mut reader, mut heard, mut bytes) = (Instant::now(), FrameReader::default(), Vec::new(), [0; 1024]);
    while begin.elapsed() < patience {
        match port.read(&mut bytes) {
            Ok(0) => break,
            Ok(count) => {
                heard.extend_from_slice(&bytes[..count]);
                bytes[..count].iter().for_each(|&byte| _ = reader.push(byte));
            }
            Err(error) if is_pause(&error) => {}
            Err(error) => return Err(error),
        }
        if reader.counters().good >= FRAMES {
            return Ok(Some(heard));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use towmag::link::text_frame;

    /// A body at one rate: at any other it is rubbish, for so many reads after each change.
    struct Body {
        talks_at: u32,
        is_at: u32,
        rubbish: usize,
        left: usize,
    }

    impl Body {
        fn new(talks_at: u32, rubbish: usize) -> Self {
            Self { talks_at, is_at: 0, rubbish, left: rubbish }
        }
    }

    impl Read for Body {
        fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
            let frame = text_frame("tick 12");
            let is_right = self.is_at == self.talks_at;
            if !is_right && self.left == 0 {
                return Ok(0);
            }
            self.left -= usize::from(!is_right);
            let distortion = if is_right { 0 } else { 0x5a };
            bytes.iter_mut().zip(&frame).for_each(|(byte, sent)| *byte = sent ^ distortion);
            Ok(frame.len())
        }
    }

    impl Tunable for Body {
        fn tune(&mut self, baud: u32) -> io::Result<()> {
            (self.is_at, self.left) = (baud, self.rubbish);
            Ok(())
        }
    }

    #[test]
    fn every_rate_is_found() {
        for talks_at in RATES {
            // The rubbish ends by itself, so that the answer hangs on no clock.
            let mut body = Body::new(talks_at, 5);
            let (found, heard) = find(&mut body, Duration::from_secs(60)).unwrap().unwrap();
            assert_eq!(found, talks_at);
            assert!(heard.len() >= 2 * text_frame("tick 12").len(), "what was heard is not lost");
        }
        let mut strange = Body::new(31_250, usize::MAX);
        assert!(find(&mut strange, Duration::from_millis(2)).unwrap().is_none());
    }
}

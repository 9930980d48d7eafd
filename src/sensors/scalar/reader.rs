//! From a serial port to the parser.

use super::{Reading, ScalarFaults, ScalarParser};
use embedded_hal_nb::nb;
use embedded_hal_nb::serial::{Error, Read};

/// Most bytes and errors taken in one call, so that a port that never runs dry cannot hold its caller.
const LONGEST_BURST: usize = 64;

/// A serial port and the parser of what comes from it.
#[derive(Clone, Debug)]
pub struct ScalarReader<Port> {
    port: Port,
    parser: ScalarParser,
}

impl<Port: Read<u8>> ScalarReader<Port> {
    /// Reader on a port that is set to the sensor's baud rate.
    pub fn new(port: Port, parser: ScalarParser) -> Self {
        Self { port, parser }
    }

    /// Take what the port holds, up to the end of one sentence. All bytes of one call get the same stamp: call it at
    /// each receive interrupt, and again as long as it returns a reading. A receiver's error is counted, and the
    /// sentence that it falls into given up; no error stops the reader.
    pub fn poll(&mut self, now_us: u32) -> Option<Reading> {
        for _ in 0..LONGEST_BURST {
            match self.port.read() {
                Ok(byte) => {
                    if let Some(reading) = self.parser.push(byte, now_us) {
                        return Some(reading);
                    }
                }
                Err(nb::Error::Other(error)) => self.parser.receive_error(error.kind()),
                Err(nb::Error::WouldBlock) => return None,
            }
        }
        None
    }

    /// Whether a sentence is under way.
    pub fn is_in_sentence(&self) -> bool {
        self.parser.is_in_sentence()
    }

    /// What went wrong since the start.
    pub fn faults(&self) -> &ScalarFaults {
        self.parser.faults()
    }

    /// Port and parser again.
    pub fn release(self) -> (Port, ScalarParser) {
        (self.port, self.parser)
    }
}

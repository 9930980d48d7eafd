//! What goes up the cable: `A5 5A`, length, content, CRC-16. The content is a log record, or 0x80 and the status values.

use crate::board;
use crate::status::{Count, Status};
use crc::{CRC_16_IBM_3740, Crc};
use heapless::spsc::{Producer, Queue};
use towmag::logbook::Record;

/// Bytes that wait for the cable: 1.5 s of epochs.
pub type OutboxQueue = Queue<u8, 1024>;

const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);
const LONGEST: usize = 128;
const STATUS_KIND: u8 = 0x80;

/// Puts messages into the queue of the cable, whole or not at all.
pub struct Outbox<'a> {
    queue: Producer<'a, u8>,
}

impl<'a> Outbox<'a> {
    pub fn new(queue: Producer<'a, u8>) -> Self {
        Self { queue }
    }

    /// A record of the log.
    pub fn record(&mut self, record: &Record) {
        let mut content = [0; LONGEST];
        let len = record.encode(&mut content).unwrap_or(0);
        self.send(content.get(..len).unwrap_or_default());
    }

    /// Counters and costs.
    pub fn status(&mut self, status: &Status) {
        let mut content: heapless::Vec<u8, LONGEST> = heapless::Vec::new();
        _ = content.push(STATUS_KIND);
        for value in status.values(board::most_stack_used()) {
            _ = content.extend_from_slice(&value.to_le_bytes());
        }
        self.send(&content);
    }

    fn send(&mut self, content: &[u8]) {
        let room = self.queue.capacity() - self.queue.len();
        if content.is_empty() || content.len() + 5 > room {
            return Count::CableBytesLost.add(content.len() as u32 + 5);
        }
        let crc = CRC.checksum(content).to_le_bytes();
        let head = [0xA5, 0x5A, content.len() as u8];
        for byte in head.iter().chain(content).chain(&crc) {
            Count::CableBytesLost.unless(self.queue.enqueue(*byte).is_ok());
        }
    }
}

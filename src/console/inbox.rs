//! The ship's bytes on their way to the console.

use crate::hardware::System;
use crate::health::{Count, Health};
use embedded_hal_nb::nb;
use embedded_hal_nb::serial::Read;
use heapless::spsc::{Producer, Queue};

/// What has come from the ship.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// A byte.
    Byte(u8),
    /// A byte that ends a line, and the timer when it came, microseconds.
    LineEnd(u8, u32),
    /// Bytes are missing here.
    Loss,
}

/// On its way to the console: a screenful that somebody pastes, and two calls of the console at 115,200 baud.
pub type InboxQueue = Queue<Arrival, 1024>;

/// The way in for what the ship sends.
pub struct Inbox<'a> {
    queue: Producer<'a, Arrival>,
    /// The last bytes found no room, and the queue does not tell yet.
    has_lost: bool,
}

impl<'a> Inbox<'a> {
    /// Fill the queue.
    pub fn new(queue: Producer<'a, Arrival>) -> Self {
        Self { queue, has_lost: false }
    }

    /// False when there is no room. Where bytes are lost the queue gets a [`Arrival::Loss`] before the next one, so that
    /// what stood before and after is never read as one line.
    fn put(&mut self, arrival: Arrival) -> bool {
        if self.has_lost && self.queue.enqueue(Arrival::Loss).is_err() {
            return false;
        }
        self.has_lost = self.queue.enqueue(arrival).is_err();
        !self.has_lost
    }
}

/// Bytes taken in one call of [`receive`].
const LONGEST_BURST: usize = 16;

/// Take what the ship has sent. Errors, and bytes that find the queue full, are counted.
pub fn receive(port: &mut impl Read<u8>, inbox: &mut Inbox<'_>, health: &Health, system: &impl System) {
    for _ in 0..LONGEST_BURST {
        let arrival = match port.read() {
            Ok(byte @ (b'\r' | b'\n')) => Arrival::LineEnd(byte, system.now_us()),
            Ok(byte) => Arrival::Byte(byte),
            Err(nb::Error::WouldBlock) => break,
            Err(nb::Error::Other(_)) => {
                health.counts.add(Count::CableOverruns, 1);
                Arrival::Loss
            }
        };
        health.counts.add_if(!inbox.put(arrival), Count::CableOverruns);
    }
}

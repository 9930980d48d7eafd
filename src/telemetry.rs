//! What goes up the cable: frames of `towmag::link`, whole or not at all.

use crate::status::{Count, Status};
use heapless::spsc::{Producer, Queue};
use towmag::link::{FaultCounters, FrameKind, MAX_BODY, MAX_FRAME, ProgramFaults, Telemetry, frame, text_frame};
use towmag::sensors::ads131m04::AdcFaults;
use towmag::sensors::grid::{GridCounters, MarkedEpoch};
use towmag::sensors::scalar::ScalarFaults;
use towmag::{Output, link::Activity};

/// Bytes that wait for the cable: two seconds of epochs.
pub type OutboxQueue = Queue<u8, 1024>;

/// What the drivers have counted, as of the latest epoch.
#[derive(Default)]
pub struct DriverFaults {
    pub scalar: ScalarFaults,
    pub converter: AdcFaults,
    pub grid: GridCounters,
}

impl DriverFaults {
    /// Every counter of the body.
    pub fn all(&self, program: &ProgramFaults) -> FaultCounters {
        FaultCounters::new(&self.scalar, &self.converter, &self.grid, program)
    }
}

/// Puts frames into the queue of the cable.
pub struct Outbox<'a> {
    queue: Producer<'a, u8>,
}

impl<'a> Outbox<'a> {
    pub fn new(queue: Producer<'a, u8>) -> Self {
        Self { queue }
    }

    /// An epoch and what became of it.
    pub fn epoch(
        &mut self,
        marked: &MarkedEpoch,
        output: &Output,
        unix_ms: Option<u64>,
        activity: Activity,
        faults: &FaultCounters,
    ) {
        let slice = faults.slice(marked.epoch.tick);
        self.send(&Telemetry::new(marked, output, unix_ms, activity, slice).frame());
    }

    /// Counters and costs of the program.
    pub fn figures(&mut self, status: &Status) {
        let mut body: heapless::Vec<u8, MAX_BODY> = heapless::Vec::new();
        for value in status.values() {
            _ = body.extend_from_slice(&value.to_le_bytes());
        }
        self.send(&frame(FrameKind::Figures, &body).unwrap_or_default());
    }

    /// A line of text, if that leaves room for what cannot wait.
    pub fn text(&mut self, line: &str) -> bool {
        let frame = text_frame(line);
        let fits = self.room() >= frame.len() + MAX_FRAME;
        if fits {
            self.send(&frame);
        }
        fits
    }

    /// Whether all has left.
    pub fn is_empty(&self) -> bool {
        self.queue.len() == 0
    }

    fn room(&self) -> usize {
        self.queue.capacity() - self.queue.len()
    }

    fn send(&mut self, frame: &[u8]) {
        if frame.is_empty() || frame.len() > self.room() {
            return Count::FramesDropped.add(1);
        }
        for byte in frame {
            // There is room.
            _ = self.queue.enqueue(*byte);
        }
    }
}

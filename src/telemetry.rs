//! What goes up the cable: frames of [`link`](crate::link), whole or not at all.

use crate::body::UnixTime;
use crate::epoch::Output;
use crate::hardware::CableTransmitter;
use crate::health::{Count, FIGURES, Health};
use crate::housekeeping::{Alarm, Housekeeping, LONGEST_ALARM};
use crate::link::{
    Activity, FaultCounters, FrameKind, HousekeepingMessage, MAX_BODY, MAX_FRAME, NavigationMessage, Telemetry, frame,
    text_frame,
};
use crate::navigation::Navigation;
use crate::sensors::grid::MarkedEpoch;
use core::fmt::Write as _;
use embedded_hal_nb::nb;
use heapless::spsc::{Producer, Queue};

/// Bytes that wait for the cable: two seconds of epochs.
pub type OutboxQueue = Queue<u8, 1024>;

/// Ticks between two messages of where the body is: with every epoch's own, 9,600 baud carry two of them a second.
const NAVIGATION_TICKS: u32 = 5;

/// Ticks between two messages of leak and battery that tell nothing new: they change slowly, and 9,600 baud carry little
/// more than the epochs.
const HOUSEKEEPING_TICKS: u32 = 50;

/// Room that lines of text leave for what an epoch brings at most: its message, where and how the body is, and figures.
const CANNOT_WAIT: usize = 2 * MAX_FRAME;

/// Puts frames into the queue of the cable.
pub struct Outbox<'a> {
    queue: Producer<'a, u8>,
    health: &'a Health,
    /// The latest message of where the body is.
    navigation: Option<NavigationMessage>,
    /// The latest message of leak and battery.
    housekeeping: Option<HousekeepingMessage>,
}

impl<'a> Outbox<'a> {
    /// Fill the queue; what finds no room in it is counted.
    pub fn new(queue: Producer<'a, u8>, health: &'a Health) -> Self {
        Self { queue, health, navigation: None, housekeeping: None }
    }

    /// An epoch and what became of it.
    pub fn epoch(
        &mut self,
        marked: &MarkedEpoch,
        output: &Output,
        time: Option<UnixTime>,
        activity: Activity,
        faults: &FaultCounters,
    ) {
        let slice = faults.slice(marked.epoch.tick);
        self.send(&Telemetry::new(marked, output, time, activity, slice).frame());
    }

    /// Where the body is, twice a second while anything is known of it, and once when nothing is any more.
    pub fn navigation(&mut self, tick: u32, navigation: Navigation) {
        let (last_tick, was_empty) =
            self.navigation.map_or((None, true), |last| (Some(last.tick), last.navigation.is_empty()));
        let is_due = last_tick.is_none_or(|last_tick| tick.wrapping_sub(last_tick) >= NAVIGATION_TICKS);
        if is_due && !(was_empty && navigation.is_empty()) {
            let message = NavigationMessage { tick, navigation };
            self.navigation = Some(message);
            self.send(&message.frame());
        }
    }

    /// Leak contact and battery, every five seconds, and at once when a leak begins or ends.
    pub fn housekeeping(&mut self, tick: u32, housekeeping: Housekeeping) {
        let is_old = |last: HousekeepingMessage| {
            let has_changed = last.housekeeping.has_leak != housekeeping.has_leak;
            has_changed || tick.wrapping_sub(last.tick) >= HOUSEKEEPING_TICKS
        };
        if self.housekeeping.is_none_or(is_old) {
            let message = HousekeepingMessage { tick, housekeeping };
            self.housekeeping = Some(message);
            self.send(&message.frame());
        }
    }

    /// Counters and costs of the program.
    pub fn figures(&mut self, figures: &[u32; FIGURES]) {
        let mut body: heapless::Vec<u8, MAX_BODY> = heapless::Vec::new();
        for value in figures {
            _ = body.extend_from_slice(&value.to_le_bytes());
        }
        self.send(&frame(FrameKind::Figures, &body).unwrap_or_default());
    }

    /// A line of text, if that leaves room for what cannot wait.
    pub fn text(&mut self, line: &str) -> bool {
        let frame = text_frame(line);
        let fits = self.room() >= frame.len() + CANNOT_WAIT;
        if fits {
            self.send(&frame);
        }
        fits
    }

    /// An alarm as a line of text.
    pub fn alarm(&mut self, alarm: &Alarm) -> bool {
        let mut line = heapless::String::<LONGEST_ALARM>::new();
        // No text of an alarm is longer.
        _ = write!(line, "{alarm}");
        self.text(&line)
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
            return self.health.counts.add(Count::FramesDropped, 1);
        }
        for byte in frame {
            // There is room.
            _ = self.queue.enqueue(*byte);
        }
    }
}

/// Empties the queue into the transmitter.
pub struct CableSender<T> {
    transmitter: T,
    /// Taken from the queue, but not yet by the transmitter.
    waiting: Option<u8>,
}

impl<T: CableTransmitter> CableSender<T> {
    /// A transmitter that nothing has been given to.
    pub fn new(transmitter: T) -> Self {
        Self { transmitter, waiting: None }
    }

    /// Have the task of the cable run: there is something to send.
    pub fn wake(&mut self) {
        self.transmitter.wake();
    }

    /// Send until the transmitter is busy or nothing is left; only in the first case it calls again.
    pub fn send(&mut self, mut next: impl FnMut() -> Option<u8>) {
        while let Some(byte) = self.waiting.take().or_else(&mut next) {
            if let Err(nb::Error::WouldBlock) = self.transmitter.write(byte) {
                self.waiting = Some(byte);
                return self.transmitter.listen();
            }
        }
        self.transmitter.unlisten();
    }
}

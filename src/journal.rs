//! What becomes a record of the log, epoch by epoch.

use crate::status::{Count, STATUS};
use towmag::Output;
use towmag::body::Recorder;
use towmag::log::{Event, EventKind, Feeder, Record};
use towmag::sensors::grid::MarkedEpoch;

/// Ticks between two records of the time of day: an hour. The ticks follow the scalar sensor's clock, which drifts.
const TIME_AGAIN_TICKS: u32 = 36_000;

/// Feeds the queue of the log.
pub struct Journal<'a> {
    log: Feeder<'a>,
    recorder: Recorder,
    is_on: bool,
    /// Tick of the latest record of the time.
    timed: Option<u32>,
}

impl<'a> Journal<'a> {
    pub fn new(log: Feeder<'a>) -> Self {
        Self { log, recorder: Recorder::default(), is_on: STATUS.log_is_wanted(), timed: None }
    }

    /// An epoch, what became of it, and its time, milliseconds since 1970-01-01 UTC, if that is known.
    pub fn write(&mut self, marked: &MarkedEpoch, output: Output, unix_ms: Option<u64>) {
        let MarkedEpoch { epoch, marks } = marked;
        let is_on = STATUS.log_is_wanted();
        if is_on != self.is_on {
            self.is_on = is_on;
            self.recorder = Recorder::default();
            self.event(epoch.tick, if is_on { EventKind::LogStart } else { EventKind::LogStop });
        }
        if !is_on {
            return;
        }
        if let Some(unix_ms) = unix_ms.filter(|_| self.is_time_due(epoch.tick)) {
            self.timed = Some(epoch.tick);
            self.event(epoch.tick, EventKind::TimeSet { unix_ms });
        }
        let record = Record::Epoch(self.recorder.record(*epoch, marks, output));
        Count::RecordsLost.unless(self.log.push(&record));
    }

    fn is_time_due(&self, tick: u32) -> bool {
        self.timed.is_none_or(|timed| tick.wrapping_sub(timed) >= TIME_AGAIN_TICKS)
    }

    fn event(&mut self, tick: u32, kind: EventKind) {
        Count::RecordsLost.unless(self.log.push(&Record::Event(Event { tick, kind })));
    }
}

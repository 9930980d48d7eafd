//! What becomes a record of the log, epoch by epoch.

use crate::body::{RecordBuilder, UnixTime};
use crate::epoch::Output;
use crate::health::{Count, Health};
use crate::housekeeping::{Alarm, HousekeepingNews};
use crate::log::{Event, EventKind, Record, RecordProducer, TEXT_LEN};
use crate::navigation::Navigation;
use crate::sensors::grid::MarkedEpoch;
use core::fmt::Write as _;

/// Ticks between two records of the time of day: a minute. The ticks follow the scalar sensor's clock, which drifts, and
/// the time is corrected meanwhile.
const TIME_AGAIN_TICKS: u32 = 600;

/// What the log is told with an epoch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EpochNews<'a> {
    /// Its time, if that is known.
    pub(crate) time: Option<UnixTime>,
    /// What is new of where the body is.
    pub(crate) navigation: Navigation,
    /// What is new of leak and battery.
    pub(crate) housekeeping: Option<&'a HousekeepingNews>,
}

/// Puts epochs into the queue of the log while it is switched on, and the time of day every minute.
pub(crate) struct EpochProducer<'a> {
    queue: RecordProducer<'a>,
    builder: RecordBuilder,
    health: &'a Health,
    is_on: bool,
    /// Tick of the latest record of the time.
    timed: Option<u32>,
}

impl<'a> EpochProducer<'a> {
    /// Nothing has been recorded yet.
    pub(crate) fn new(queue: RecordProducer<'a>, health: &'a Health) -> Self {
        Self { queue, builder: RecordBuilder::default(), health, is_on: health.log.is_wanted(), timed: None }
    }

    /// An epoch, what became of it, and what the log is told with it.
    pub(crate) fn write(&mut self, marked: &MarkedEpoch, output: Output, news: &EpochNews<'_>) {
        let MarkedEpoch { epoch, marks } = marked;
        let is_on = self.health.log.is_wanted();
        if is_on != self.is_on {
            self.is_on = is_on;
            self.builder = RecordBuilder::default();
            self.event(epoch.tick, if is_on { EventKind::LogStart } else { EventKind::LogStop });
        }
        if !is_on {
            return;
        }
        if let Some(time) = news.time.filter(|_| self.is_time_due(epoch.tick)) {
            self.timed = Some(epoch.tick);
            self.event(epoch.tick, EventKind::Time(time));
        }
        if !news.navigation.is_empty() {
            self.event(epoch.tick, EventKind::Navigation(news.navigation));
        }
        if let Some(news) = news.housekeeping {
            self.housekeeping(epoch.tick, news);
        }
        let record = Record::Epoch(self.builder.record(*epoch, marks, output));
        self.push(&record);
    }

    fn housekeeping(&mut self, tick: u32, news: &HousekeepingNews) {
        self.event(tick, EventKind::Housekeeping(news.housekeeping));
        for alarm in [news.leak, news.battery].into_iter().flatten().filter(Alarm::is_change) {
            let mut text = heapless::String::<TEXT_LEN>::new();
            // Its longest text is far shorter.
            _ = write!(text, "{alarm}");
            self.event(tick, EventKind::Notice(text));
        }
    }

    fn is_time_due(&self, tick: u32) -> bool {
        self.timed.is_none_or(|timed| tick.wrapping_sub(timed) >= TIME_AGAIN_TICKS)
    }

    fn event(&mut self, tick: u32, kind: EventKind) {
        self.push(&Record::Event(Event { tick, kind }));
    }

    fn push(&mut self, record: &Record) {
        let is_queued = self.queue.push(record);
        self.health.counts.add_if(!is_queued, Count::RecordsLost);
    }
}

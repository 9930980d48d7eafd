//! The queues between the tasks, all of them.

use crate::assemble::{ConversionQueue, EpochQueue, ReadingQueue};
use crate::console::{InboxQueue, NoticeQueue};
use crate::log::RecordQueue;
use crate::navigation::NavigationQueue;
use crate::telemetry::OutboxQueue;

/// The queues between the tasks, about 22 kB in static memory. Each is split into its two ends once.
pub struct Queues {
    /// `scalar` to `assemble`.
    pub readings: ReadingQueue,
    /// `nmea` to `compensate`.
    pub navigation: NavigationQueue,
    /// `fluxgate` to `assemble`.
    pub conversions: ConversionQueue,
    /// `assemble` to `compensate`.
    pub epochs: EpochQueue,
    /// `compensate` to `storage`.
    pub records: RecordQueue,
    /// `compensate` and `console` to `cable`.
    pub outbox: OutboxQueue,
    /// `cable` to `console`.
    pub inbox: InboxQueue,
    /// `console` to `storage`.
    pub notices: NoticeQueue,
}

impl Default for Queues {
    fn default() -> Self {
        Self::new()
    }
}

impl Queues {
    /// All empty.
    pub const fn new() -> Self {
        Self {
            readings: ReadingQueue::new(),
            navigation: NavigationQueue::new(),
            conversions: ConversionQueue::new(),
            epochs: EpochQueue::new(),
            records: RecordQueue::new(),
            outbox: OutboxQueue::new(),
            inbox: InboxQueue::new(),
            notices: NoticeQueue::new(),
        }
    }
}

//! What ran.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Calls of `assemble` without a conversion until the converter counts as silent: 1 s.
const SILENT_CALLS: u32 = 25;

/// Tasks that the watchdog waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Readings and conversions to epochs.
    Assemble = 1,
    /// Epochs to outputs.
    Compensate = 2,
    /// The log to the card.
    Storage = 4,
}

const ALL_TASKS: u32 = 7;

/// Signs of life.
#[derive(Debug)]
pub struct Tasks {
    ran: AtomicU32,
    epochs: AtomicU32,
    calls_without_conversion: AtomicU32,
}

impl Tasks {
    pub(super) const fn new() -> Self {
        Self { ran: AtomicU32::new(0), epochs: AtomicU32::new(0), calls_without_conversion: AtomicU32::new(0) }
    }

    /// Another epoch.
    pub fn epoch_made(&self) {
        self.epochs.fetch_add(1, Relaxed);
    }

    /// Epochs made so far.
    pub fn epochs(&self) -> u32 {
        self.epochs.load(Relaxed)
    }

    /// A task is alive.
    pub fn ran(&self, task: Task) {
        self.ran.fetch_or(task as u32, Relaxed);
    }

    /// Whether every task has run since this was last true.
    pub fn all_ran(&self) -> bool {
        let all = self.ran.load(Relaxed) == ALL_TASKS;
        if all {
            self.ran.store(0, Relaxed);
        }
        all
    }

    /// The converter is not silent.
    pub fn conversion_came(&self) {
        self.calls_without_conversion.store(0, Relaxed);
    }

    /// True about once a second when no conversion comes.
    pub fn converter_is_silent(&self) -> bool {
        self.calls_without_conversion.fetch_add(1, Relaxed) % SILENT_CALLS == SILENT_CALLS - 1
    }
}

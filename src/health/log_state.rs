//! How the log is, between the task that writes it and those that tell of it.

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

/// In place of the room that is left, while no log is open.
const NO_LOG: u32 = u32::MAX;

/// How the log is, and how it is wanted.
#[derive(Debug)]
pub struct LogState {
    is_open: AtomicBool,
    fails: AtomicBool,
    is_wanted: AtomicBool,
    sectors_left: AtomicU32,
}

impl LogState {
    pub(super) const fn new() -> Self {
        Self {
            is_open: AtomicBool::new(false),
            fails: AtomicBool::new(false),
            is_wanted: AtomicBool::new(true),
            sectors_left: AtomicU32::new(NO_LOG),
        }
    }

    /// How the log is: open on a card, and whether that failed the last time.
    pub fn set(&self, is_open: bool, fails: bool) {
        self.is_open.store(is_open, Relaxed);
        self.fails.store(fails, Relaxed);
    }

    /// Whether the operator wants epochs on the card.
    pub fn want(&self, is_wanted: bool) {
        self.is_wanted.store(is_wanted, Relaxed);
    }

    /// See [`want`](Self::want).
    pub fn is_wanted(&self) -> bool {
        self.is_wanted.load(Relaxed)
    }

    /// Room in the log, sectors.
    pub fn set_sectors_left(&self, sectors: u32) {
        self.sectors_left.store(sectors, Relaxed);
    }

    /// No log is open.
    pub fn set_no_log(&self) {
        self.set_sectors_left(NO_LOG);
    }

    /// Room in the log, sectors; `None` while none is open.
    pub fn sectors_left(&self) -> Option<u32> {
        Some(self.sectors_left.load(Relaxed)).filter(|&sectors| sectors != NO_LOG)
    }

    /// Whether epochs go to the card.
    pub fn is_logging(&self) -> bool {
        self.is_open.load(Relaxed) && self.is_wanted()
    }

    /// Whether the card did not take the log the last time.
    pub fn is_failing(&self) -> bool {
        self.fails.load(Relaxed)
    }
}

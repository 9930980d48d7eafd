//! A chip that knows the time and nothing else: for tests of the storage alone.

use std::rc::Rc;

use towmag::body::UnixTime;
use towmag::hardware::{LastWords, Stamp, System};
use towmag::log::ResetCause;

/// A timer, and a number that differs from start to start.
#[derive(Clone)]
pub struct BareChip {
    now_us: Rc<dyn Fn() -> u32>,
    start: u32,
}

impl BareChip {
    /// Its timer shows what `now_us` says.
    pub fn new(now_us: impl Fn() -> u32 + 'static, start: u32) -> Self {
        Self { now_us: Rc::new(now_us), start }
    }
}

impl System for BareChip {
    fn now_us(&self) -> u32 {
        (self.now_us)()
    }

    fn stamp_us(&self, _: Stamp) -> u32 {
        self.now_us()
    }

    fn random(&self, now_us: u32) -> u32 {
        (now_us ^ self.start.rotate_left(16)).wrapping_mul(2_654_435_761)
    }

    fn wake_fluxgate(&self) {}

    fn reset_cause(&self) -> ResetCause {
        ResetCause::PowerOn
    }

    fn restarts_by_fault(&self) -> u32 {
        0
    }

    fn last_words(&self) -> Option<LastWords> {
        None
    }

    fn keep_time(&self, _: Option<UnixTime>) {}

    fn kept_time(&self) -> Option<UnixTime> {
        None
    }

    fn restart(&self) {}

    fn most_stack_used(&self) -> u32 {
        0
    }

    fn ticks_of_known_loop(&self) -> u32 {
        0
    }
}

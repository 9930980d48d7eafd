//! The time, which the tests make themselves.

use std::time::{Duration, Instant};

/// A clock.
pub trait Clock {
    /// Since some moment.
    fn now(&self) -> Duration;

    /// Wait.
    fn sleep(&self, pause: Duration);
}

/// That of the computer.
#[derive(Clone, Copy, Debug)]
pub struct RealClock(Instant);

impl Default for RealClock {
    fn default() -> Self {
        Self(Instant::now())
    }
}

impl Clock for RealClock {
    fn now(&self) -> Duration {
        self.0.elapsed()
    }

    fn sleep(&self, pause: Duration) {
        std::thread::sleep(pause);
    }
}

//! A recording at its own speed, or at another.

use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::recording::EPOCH_S;

/// Holds a recording back.
#[derive(Debug)]
pub(crate) struct Pace {
    begin: Instant,
    speed: f64,
    ticks: u64,
    due_s: f64,
}

/// A gap in a recording is no longer than this, s: nobody wants to wait for what was not heard.
const LONGEST_GAP_S: f64 = 2.0;

impl Pace {
    /// So many times as fast as it was.
    pub(crate) fn new(speed: f64) -> Self {
        Self { begin: Instant::now(), speed, ticks: 0, due_s: 0.0 }
    }

    /// Wait until as many ticks of the recording have passed.
    pub(crate) fn wait(&mut self, ticks: u64) {
        let step_s = EPOCH_S * (ticks.saturating_sub(self.ticks)) as f64;
        self.ticks = ticks;
        self.due_s += step_s.min(LONGEST_GAP_S) / self.speed;
        let due = Duration::try_from_secs_f64(self.due_s).unwrap_or(Duration::ZERO);
        if let Some(rest) = due.checked_sub(self.begin.elapsed()) {
            sleep(rest);
        }
    }
}

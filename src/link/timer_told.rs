//! What the ship's clock is set against: the answer to `time ask`.

/// What the body's timer showed when the line came, and when the answer went, microseconds; it wraps after 71.6 minutes.
///
/// The ship knows when it sent the line and when the answer came, and so how long both were on their way together: as with
/// NTP (RFC 5905, section 8), half of that is what the time that follows from them may be off at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimerTold {
    /// When the line's last byte came.
    pub came_us: u32,
    /// When the answer was put into the queue of the cable.
    pub goes_us: u32,
}

impl core::fmt::Display for TimerTold {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "timer: came {}, goes {}", self.came_us, self.goes_us)
    }
}

impl TimerTold {
    /// What [`Display`](core::fmt::Display) has written.
    pub fn parse(line: &str) -> Option<Self> {
        let (came, goes) = line.strip_prefix("timer: came ")?.split_once(", goes ")?;
        Some(Self { came_us: came.parse().ok()?, goes_us: goes.parse().ok()? })
    }
}

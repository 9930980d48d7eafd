//! When to look for a card again.

/// The first pause, microseconds.
const FIRST_US: u32 = 1_000_000;

/// The longest: a card that is back is found within it, and the queue holds a little more.
const LONGEST_US: u32 = 8_000_000;

/// Growing pauses between attempts at a card that is not there, or does not work.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pauses {
    last: Option<(u32, u32)>,
}

impl Pauses {
    /// Whether it is time for another attempt.
    pub(super) fn are_over(&self, now_us: u32) -> bool {
        self.last.is_none_or(|(tried_us, pause_us)| now_us.wrapping_sub(tried_us) >= pause_us)
    }

    /// An attempt has just failed.
    pub(super) fn grow(&mut self, now_us: u32) {
        let pause_us = self.last.map_or(FIRST_US, |(_, pause_us)| (2 * pause_us).min(LONGEST_US));
        self.last = Some((now_us, pause_us));
    }

    /// The card works.
    pub(super) fn end(&mut self) {
        self.last = None;
    }
}

//! The 32-bit microsecond timer, extended to 64 bits.

/// The latest time seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExtendedTimer {
    now_us: Option<i64>,
}

impl ExtendedTimer {
    pub(super) const fn new() -> Self {
        Self { now_us: None }
    }

    pub(super) fn now_us(&self) -> i64 {
        self.now_us.unwrap_or(0)
    }

    /// The stamp in 64 bits: the time nearest to the latest one that has these lower 32 bits. Right as long as no two
    /// calls of [`advance`](Self::advance) are more than 35 minutes apart.
    pub(super) fn at(&self, stamp_us: u32) -> i64 {
        let now_us = self.now_us.unwrap_or(i64::from(stamp_us));
        now_us + i64::from(stamp_us.wrapping_sub(now_us as u32) as i32)
    }

    /// Go on to the stamp and return the time; a stamp that is not later changes nothing, as stamps of several interrupts
    /// may come in another order.
    pub(super) fn advance(&mut self, stamp_us: u32) -> i64 {
        let now_us = self.at(stamp_us).max(self.now_us.unwrap_or(i64::MIN));
        self.now_us = Some(now_us);
        now_us
    }
}

//! Time of day.

/// Time of day, told by the free-running timer from when it was set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeOfDay {
    unix_us: u64,
    stamp_us: u32,
}

impl TimeOfDay {
    /// It is `unix_ms` milliseconds since 1970-01-01 UTC when the timer shows `stamp_us`.
    pub fn set(unix_ms: u64, stamp_us: u32) -> Self {
        Self { unix_us: unix_ms.saturating_mul(1_000), stamp_us }
    }

    /// The time at a stamp, milliseconds since 1970-01-01 UTC. The timer wraps: the stamp may be half an hour from that
    /// of the latest call, which the firmware makes at every epoch.
    pub fn unix_ms(&mut self, stamp_us: u32) -> u64 {
        let ahead_us = stamp_us.wrapping_sub(self.stamp_us) as i32;
        self.unix_us = self.unix_us.saturating_add_signed(ahead_us.into());
        self.stamp_us = stamp_us;
        self.unix_us / 1_000
    }
}

#[cfg(test)]
mod tests {
    use super::TimeOfDay;

    #[test]
    fn the_time_outlives_the_wrap_of_its_timer() {
        let mut time = TimeOfDay::set(1_800_000_000_000, u32::MAX - 99_999);
        // The epoch under way when it was set began before.
        assert_eq!(time.unix_ms(u32::MAX - 149_999), 1_799_999_999_950);
        for epoch in 0..100_000_u32 {
            let stamp_us = (u32::MAX - 49_999).wrapping_add(epoch.wrapping_mul(100_000));
            assert_eq!(time.unix_ms(stamp_us), 1_800_000_000_050 + u64::from(epoch) * 100);
        }
    }
}

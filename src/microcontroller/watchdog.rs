//! How long the independent watchdog waits. Its oscillator is anywhere from 17 to 47 kHz (data sheet DS8626).

/// The oscillator at its slowest and its fastest, Hz.
const SLOWEST_HZ: u64 = 17_000;
const FASTEST_HZ: u64 = 47_000;

/// The coarsest of the prescalers, and what selects it.
const DIVIDER: u64 = 256;
const DIVIDER_CODE: u8 = 0b110;

/// Largest value of the 12-bit counter.
const MOST_TICKS: u64 = 0x1000;

/// How the watchdog is set, and what comes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WatchdogPeriod {
    /// For IWDG_PR.
    pub prescaler: u8,
    /// For IWDG_RLR.
    pub reload: u16,
    /// It resets no later than this after it was last fed, milliseconds.
    pub longest_ms: u32,
}

/// The body's. Erasing a sector of the settings stalls the program for up to four seconds, and a call of the card may take two:
/// never earlier than after six.
pub const WATCHDOG: WatchdogPeriod = match watchdog_period(6_000) {
    Some(period) => period,
    None => panic!("the watchdog's counter is too short"),
};

/// The shortest setting that never resets earlier than `shortest_ms` after it was last fed; `None` when the counter does not
/// reach so far.
pub const fn watchdog_period(shortest_ms: u32) -> Option<WatchdogPeriod> {
    let ticks = (shortest_ms as u64 * FASTEST_HZ).div_ceil(1_000 * DIVIDER);
    if ticks == 0 || ticks > MOST_TICKS {
        return None;
    }
    let longest_ms = (ticks * DIVIDER * 1_000).div_ceil(SLOWEST_HZ) as u32;
    Some(WatchdogPeriod { prescaler: DIVIDER_CODE, reload: (ticks - 1) as u16, longest_ms })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Time until a reset with an oscillator of `hz`, milliseconds.
    fn period_ms(period: WatchdogPeriod, hz: f64) -> f64 {
        (f64::from(period.reload) + 1.0) * 256.0 / hz * 1e3
    }

    #[test]
    fn it_is_never_shorter_than_asked_for_and_never_longer_than_told() {
        for shortest_ms in [1, 10, 500, 6_000, 22_300] {
            let period = watchdog_period(shortest_ms).unwrap();
            for hz in [17e3, 32e3, 47e3] {
                let ms = period_ms(period, hz);
                assert!(ms >= f64::from(shortest_ms) && ms <= f64::from(period.longest_ms), "{shortest_ms}: {ms}");
            }
        }
    }

    #[test]
    fn what_the_counter_cannot_hold_is_refused() {
        assert_eq!(watchdog_period(22_311), None);
        assert_eq!(watchdog_period(0), None);
    }
}

//! The time of day after a reset.

use super::time_of_day::UnixTime;
use crate::log::ResetCause;
use crate::microcontroller::WATCHDOG;

/// In the middle between at once and the longest wait.
const WATCHDOG_HALF_US: u32 = WATCHDOG.longest_ms * 1_000 / 2;

/// What is left after a reset of the time that was kept at the latest epoch, when the program runs again. The timer starts
/// anew with the chip, so that nothing tells how long the reset took: that is in the error.
///
/// | reset | since the time was kept |
/// |---|---|
/// | by the program: command or panic | up to an epoch, and the start, which takes some milliseconds: 0 to 0.16 s |
/// | by the watchdog | up to what it waits at the longest ([`WATCHDOG`]), if that long the epochs had stopped too |
/// | by the pin, or for a mode that must not be | as long as the pin is held: up to a minute is taken for granted |
/// | by the supply | nobody knows: `None` |
pub fn after_reset(kept: UnixTime, cause: ResetCause) -> Option<UnixTime> {
    let (later_us, error_us) = match cause {
        ResetCause::Software => (80_000, 80_000),
        ResetCause::Watchdog => (WATCHDOG_HALF_US, WATCHDOG_HALF_US),
        ResetCause::Pin | ResetCause::LowPower | ResetCause::Unknown => (1_000_000, 60_000_000),
        ResetCause::PowerOn | ResetCause::BrownOut => return None,
    };
    Some(UnixTime { unix_us: kept.unix_us + u64::from(later_us), error_us: kept.error_us.saturating_add(error_us) })
}

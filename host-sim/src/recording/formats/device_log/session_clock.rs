//! The time of every epoch of a session, from what its events say of the clock.

use towmag::RATE_HZ;
use towmag::body::UnixTime;
use towmag::log::EventKind;

/// How fast ticks may gain or lose, s a second: those of the scalar sensor's clock.
const DRIFT: f64 = 50e-6;

/// Error of a time in a log of an earlier program: it was typed, in whole seconds.
const TYPED_ERROR_US: u32 = 1_000_000;

/// A time, and by how much it may be off, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Utc {
    /// Seconds since 1970-01-01 UTC.
    pub(super) utc_s: f64,
    pub(super) error_s: f64,
}

/// The times that a session's events tell, by tick.
#[derive(Clone, Debug, Default)]
pub(super) struct SessionClock(Vec<(u32, Utc)>);

impl SessionClock {
    /// Take over what an event tells, if that is the time.
    pub(super) fn hear(&mut self, tick: u32, event: &EventKind) {
        match event {
            EventKind::Time(time) => self.add(tick, *time),
            EventKind::TimeSet { unix_ms } => {
                let unix_us = unix_ms.saturating_mul(1_000);
                self.add(tick, UnixTime { unix_us, error_us: TYPED_ERROR_US });
            }
            _ => {}
        }
    }

    fn add(&mut self, tick: u32, time: UnixTime) {
        let utc = Utc { utc_s: time.unix_us as f64 * 1e-6, error_s: f64::from(time.error_us) * 1e-6 };
        let place = self.0.partition_point(|(told, _)| *told <= tick);
        self.0.insert(place, (tick, utc));
    }

    /// All times have been told: those that cannot be right beside a later one have been put right, and count no more.
    pub(super) fn settle(&mut self) {
        let agree = |pair: &[(u32, Utc)]| {
            let ((told, before), (tick, after)) = (pair[0], pair[1]);
            let (by_before, _) = extrapolated(told, before, tick);
            (after.utc_s - by_before.utc_s).abs() <= after.error_s + by_before.error_s
        };
        if let Some(last_wrong) = self.0.windows(2).rposition(|pair| !agree(pair)) {
            self.0.drain(..=last_wrong);
        }
    }

    /// The time of a tick: between two that are told, by both; before the first and after the last, by that one.
    pub(super) fn at(&self, tick: u32) -> Option<Utc> {
        let next = self.0.partition_point(|(told, _)| *told <= tick);
        let by = |place: usize| self.0.get(place).map(|(told, utc)| extrapolated(*told, *utc, tick));
        let (before, after) = (next.checked_sub(1).and_then(by), by(next));
        let (Some((before, since_s)), Some((after, until_s))) = (before, after) else {
            return before.or(after).map(|(utc, _)| utc);
        };
        let share = since_s / (since_s + until_s);
        let utc_s = before.utc_s + share * (after.utc_s - before.utc_s);
        Some(Utc { utc_s, error_s: before.error_s.min(after.error_s) })
    }
}

/// A time at another tick, and how far that is from it, s.
fn extrapolated(told: u32, utc: Utc, tick: u32) -> (Utc, f64) {
    let ahead_s = f64::from(tick.wrapping_sub(told) as i32) / RATE_HZ;
    (Utc { utc_s: utc.utc_s + ahead_s, error_s: utc.error_s + DRIFT * ahead_s.abs() }, ahead_s.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOON_US: u64 = 1_790_000_000_000_000;

    fn clock(times: &[(u32, u64, u32)]) -> SessionClock {
        let mut clock = SessionClock::default();
        for &(tick, since_noon_us, error_us) in times {
            clock.add(tick, UnixTime { unix_us: NOON_US + since_noon_us, error_us });
        }
        clock.settle();
        clock
    }

    fn since_noon_s(utc: Utc) -> f64 {
        utc.utc_s - NOON_US as f64 * 1e-6
    }

    #[test]
    fn between_two_times_both_count() {
        // A minute of the ticks takes 3 ms longer.
        let clock = clock(&[(1_000, 0, 4_000), (1_600, 60_003_000, 2_000)]);
        let middle = clock.at(1_300).unwrap();
        assert!((since_noon_s(middle) - 30.0015).abs() < 1e-6, "{middle:?}");
        assert!((middle.error_s - 0.0035).abs() < 1e-9, "{middle:?}");
        assert!((since_noon_s(clock.at(990).unwrap()) + 1.0).abs() < 1e-6);
        let hour = clock.at(1_600 + 36_000).unwrap();
        assert!((since_noon_s(hour) - 3_660.003).abs() < 1e-6 && (hour.error_s - 0.182).abs() < 1e-9, "{hour:?}");
        assert_eq!(SessionClock::default().at(5), None);
    }

    #[test]
    fn a_time_that_was_put_right_does_not_bend_the_time_before_it() {
        let clock = clock(&[(0, 500_000_000, 1_000_000), (600, 60_000_000, 5_000)]);
        assert!((since_noon_s(clock.at(300).unwrap()) - 30.0).abs() < 1e-6);
        // Nor what it was before it was told at all, or between two times that were both wrong.
        let wrong = [
            (100, 500_000_000, 5_000),
            (200, 510_000_000, 5_000),
            (600, 60_000_000, 5_000),
            (1_200, 120_000_000, 5_000),
        ];
        let clock = self::clock(&wrong);
        for tick in [0, 100, 150, 300, 600, 900] {
            assert!((since_noon_s(clock.at(tick).unwrap()) - f64::from(tick) * 0.1).abs() < 1e-6, "{tick}");
        }
    }
}

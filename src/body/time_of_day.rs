//! Time of day, and how good it is.

/// How fast the crystal may be off, parts in a million, its ageing and temperature included: what a time that nobody
/// corrects may gain or lose.
const DRIFT_PPM: u64 = 50;

/// Two pulses are whole seconds apart, give or take this many parts in a million...
const PULSE_TOLERANCE_PPM: u32 = 200;

/// ...and this many microseconds: anything else is noise on the wire.
const PULSE_TOLERANCE_US: u32 = 5;

/// Longest time between two pulses that are held against each other, s.
const LONGEST_PULSE_GAP_S: u32 = 300;

/// A time that may be off by more does not tell which second a pulse begins.
const SURE_OF_THE_SECOND_US: u64 = 400_000;

/// What a pulse leaves: a GPS receiver's is within a microsecond, the timer's step is one.
const PULSE_ERROR_US: u64 = 2;

const PS_PER_US: u64 = 1_000_000;

/// A time, and by how much it may be off at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnixTime {
    /// Microseconds since 1970-01-01 UTC.
    pub unix_us: u64,
    /// By how much it may be off, microseconds. Full where it would be more.
    pub error_us: u32,
}

/// Time of day, told by the free-running timer from when it was set, corrected by the pulses of a GPS receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeOfDay {
    unix_us: u64,
    stamp_us: u32,
    /// Grows with the time since it was set, picoseconds.
    error_ps: u64,
    /// Stamp of the latest pulse, which the next is held against.
    pulse_us: Option<u32>,
}

impl TimeOfDay {
    /// It is `time` when the timer shows `stamp_us`.
    pub fn set(time: UnixTime, stamp_us: u32) -> Self {
        Self { unix_us: time.unix_us, stamp_us, error_ps: u64::from(time.error_us) * PS_PER_US, pulse_us: None }
    }

    /// Somebody says that it was `time` when the timer showed `stamp_us`; the better of both holds, and where they cannot
    /// both be right, what is said.
    pub fn correct(&mut self, time: UnixTime, stamp_us: u32) {
        let own = self.at(stamp_us);
        let agree = own.unix_us.abs_diff(time.unix_us) <= u64::from(own.error_us) + u64::from(time.error_us);
        if !agree || time.error_us < own.error_us {
            *self = Self { pulse_us: self.pulse_us, ..Self::set(time, stamp_us) };
        }
    }

    /// The time at a stamp. The timer wraps: the stamp may be half an hour from that of the latest call, which the firmware
    /// makes at every epoch.
    pub fn at(&mut self, stamp_us: u32) -> UnixTime {
        let ahead_us = stamp_us.wrapping_sub(self.stamp_us) as i32;
        self.unix_us = self.unix_us.saturating_add_signed(ahead_us.into());
        self.stamp_us = stamp_us;
        self.error_ps = self.error_ps.saturating_add(u64::from(ahead_us.unsigned_abs()) * DRIFT_PPM);
        let error_us = u32::try_from(self.error_ps / PS_PER_US).unwrap_or(u32::MAX);
        UnixTime { unix_us: self.unix_us, error_us }
    }

    /// A pulse came when the timer showed `stamp_us`: a second begins. It counts when it is whole seconds after the one
    /// before and the time is sure of the second; whether it did.
    pub fn pulse(&mut self, stamp_us: u32) -> bool {
        let before = self.pulse_us.replace(stamp_us);
        let time = self.at(stamp_us);
        let counts = before.is_some_and(|before| are_whole_seconds(stamp_us.wrapping_sub(before)))
            && u64::from(time.error_us) < SURE_OF_THE_SECOND_US;
        if counts {
            self.unix_us = (time.unix_us + 500_000) / 1_000_000 * 1_000_000;
            self.error_ps = PULSE_ERROR_US * PS_PER_US;
        }
        counts
    }
}

fn are_whole_seconds(apart_us: u32) -> bool {
    let seconds = (apart_us.saturating_add(500_000)) / 1_000_000;
    let allowed_us = seconds * PULSE_TOLERANCE_PPM + PULSE_TOLERANCE_US;
    (1..=LONGEST_PULSE_GAP_S).contains(&seconds) && apart_us.abs_diff(seconds * 1_000_000) <= allowed_us
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOON_US: u64 = 1_800_000_000_000_000;

    fn noon(error_us: u32) -> UnixTime {
        UnixTime { unix_us: NOON_US, error_us }
    }

    #[test]
    fn the_time_outlives_the_wrap_of_its_timer() {
        let mut time = TimeOfDay::set(noon(0), u32::MAX - 99_999);
        // The epoch under way when it was set began before.
        assert_eq!(time.at(u32::MAX - 149_999).unix_us, NOON_US - 50_000);
        for epoch in 0..100_000_u32 {
            let stamp_us = (u32::MAX - 49_999).wrapping_add(epoch.wrapping_mul(100_000));
            assert_eq!(time.at(stamp_us).unix_us, NOON_US + 50_000 + u64::from(epoch) * 100_000);
        }
    }

    #[test]
    fn what_nobody_corrects_gets_worse() {
        let mut time = TimeOfDay::set(noon(1_000), 0);
        assert_eq!(time.at(1_000_000_000).error_us, 1_000 + 50_000);
        time.correct(UnixTime { unix_us: NOON_US + 1_000_020_000, error_us: 5_000 }, 1_000_000_000);
        assert_eq!(time.at(1_000_000_000), UnixTime { unix_us: NOON_US + 1_000_020_000, error_us: 5_000 });
        // Worse than what is known, and no contradiction.
        time.correct(UnixTime { unix_us: NOON_US + 1_000_030_000, error_us: 50_000 }, 1_000_000_000);
        assert_eq!(time.at(1_000_000_000).unix_us, NOON_US + 1_000_020_000);
        // It cannot be that time: whoever says so knows better.
        time.correct(UnixTime { unix_us: NOON_US, error_us: 50_000 }, 1_000_000_000);
        assert_eq!(time.at(1_000_000_000), noon(50_000));
    }

    #[test]
    fn pulses_set_the_second_and_noise_does_not() {
        let mut time = TimeOfDay::set(noon(30_000), 0);
        // The first is held against nothing, the second is a second later by a timer that is 40 ppm fast.
        assert!(!time.pulse(980_000));
        assert!(!time.pulse(1_500_000), "half a second later");
        assert!(!time.pulse(1_980_040), "held against that");
        assert!(time.pulse(2_980_080));
        assert_eq!(time.at(2_980_080), UnixTime { unix_us: NOON_US + 3_000_000, error_us: 2 });
        // Two are lost.
        assert!(time.pulse(5_980_200));
        assert_eq!(time.at(5_980_200).unix_us, NOON_US + 6_000_000);
    }

    #[test]
    fn a_time_that_may_be_half_a_second_off_is_not_pulled_to_the_wrong_second() {
        let mut time = TimeOfDay::set(noon(500_000), 0);
        assert!(!time.pulse(900_000) && !time.pulse(1_900_000));
        assert_eq!(time.at(1_900_000).unix_us, NOON_US + 1_900_000);
        time.correct(UnixTime { unix_us: NOON_US + 1_990_000, error_us: 20_000 }, 1_900_000);
        assert!(time.pulse(2_900_000));
        assert_eq!(time.at(2_900_000).unix_us, NOON_US + 3_000_000);
    }
}

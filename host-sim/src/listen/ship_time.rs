//! The body's clock set by the ship's: asked for its timer, told the time.
//!
//! As with NTP (RFC 5905, section 8): the ship notes when its question went and when the answer came, the body when the
//! question came and the answer went. Of a few exchanges the one that was on its way for the shortest time counts, for the
//! others have waited somewhere; half of that time is what the result may be off at most.

use std::time::{SystemTime, UNIX_EPOCH};

use towmag::link::{FRAME_OVERHEAD, TimerTold, acknowledgement};

/// Between two settings, microseconds: a minute, in which a crystal is off by 3 ms.
const PERIOD_US: u64 = 60_000_000;

/// Exchanges behind a setting.
const EXCHANGES: u32 = 8;

/// What is added to half the way, microseconds: this program's own delays.
const OWN_ERROR_US: u64 = 1_000;

/// What the body answers to a setting.
const SET: &str = "time set";

/// The ship's time, microseconds since 1970-01-01 UTC.
pub(super) fn unix_us() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_micros() as u64)
}

/// A time of the ship and the body's timer at that time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Exchange {
    unix_us: u64,
    stamp_us: u32,
    error_us: u64,
}

/// A question that is on its way.
#[derive(Clone, Copy, Debug)]
struct Asked {
    unix_us: u64,
    number: u16,
    bytes: usize,
}

/// Sets the clock every minute. Times are the ship's, microseconds since 1970-01-01 UTC.
#[derive(Debug)]
pub(super) struct ShipTime {
    /// How long a byte takes on the line, microseconds; 0 where that is not known.
    byte_us: f64,
    next_us: u64,
    /// Exchanges until the clock is set.
    left: u32,
    asked: Option<Asked>,
    best: Option<Exchange>,
    /// Whether the next "time set" is the answer to this.
    sets: bool,
}

impl ShipTime {
    /// Sets for the first time as soon as it is asked.
    pub(super) fn new(baud: Option<u32>) -> Self {
        let byte_us = baud.map_or(0.0, |baud| 10e6 / f64::from(baud));
        Self { byte_us, next_us: 0, left: EXCHANGES, asked: None, best: None, sets: false }
    }

    /// The body has started anew, and may not know the time.
    pub(super) fn restart(&mut self) {
        (self.next_us, self.left, self.best, self.asked) = (0, EXCHANGES, None, None);
    }

    /// The command that is due at `now_us`, if any is.
    pub(super) fn due(&mut self, now_us: u64) -> Option<String> {
        // A ship's clock that was set back does not stop this.
        let waits = now_us < self.next_us && self.next_us - now_us <= 2 * PERIOD_US;
        if waits {
            return None;
        }
        if self.left > 0 {
            self.left -= 1;
            return Some("time ask".into());
        }
        (self.left, self.next_us) = (EXCHANGES, now_us + PERIOD_US);
        let Exchange { unix_us, stamp_us, error_us } = self.best.take()?;
        self.sets = true;
        Some(format!("{SET} {}.{:06}@{stamp_us}+-{error_us}", unix_us / 1_000_000, unix_us % 1_000_000))
    }

    /// A command of `bytes` with this number goes at `now_us`.
    pub(super) fn goes(&mut self, number: u16, bytes: usize, now_us: u64) {
        self.asked = Some(Asked { unix_us: now_us, number, bytes });
    }

    /// A line of text that came at `now_us`: whether it is an answer to this, and not for the operator.
    pub(super) fn heard(&mut self, text: &str, now_us: u64) -> bool {
        if self.sets && text == SET {
            self.sets = false;
            return true;
        }
        let Some(told) = TimerTold::parse(text) else { return false };
        if let Some(exchange) = self.asked.take().and_then(|asked| self.exchange(asked, told, text.len(), now_us)) {
            self.best = Some(self.best.filter(|best| best.error_us <= exchange.error_us).unwrap_or(exchange));
        }
        true
    }

    /// `None` where the times make no sense, as when the ship's clock is set meanwhile.
    fn exchange(&self, asked: Asked, told: TimerTold, answer_len: usize, now_us: u64) -> Option<Exchange> {
        let answer_bytes = acknowledgement(asked.number).len() + answer_len + 2 * FRAME_OVERHEAD;
        let bytes_us = |bytes: usize| (bytes as f64 * self.byte_us) as u64;
        let (went_us, came_us) = (asked.unix_us + bytes_us(asked.bytes), now_us.checked_sub(bytes_us(answer_bytes))?);
        let in_body_us = u64::from(told.goes_us.wrapping_sub(told.came_us));
        let on_the_way_us = came_us.checked_sub(went_us)?.checked_sub(in_body_us)?;
        Some(Exchange {
            unix_us: came_us - on_the_way_us / 2,
            stamp_us: told.goes_us,
            error_us: on_the_way_us / 2 + OWN_ERROR_US,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use towmag::body::TimeOfDay;
    use towmag::link::{Command, parse};

    const BEGIN_US: u64 = 1_790_000_000_000_000;
    const DAY_US: u64 = 86_400_000_000;

    /// A body at the end of a cable with 20 ms of jitter each way, whose timer is off.
    struct Body {
        ppm: f64,
        time_of_day: Option<TimeOfDay>,
        random: ChaCha8Rng,
    }

    impl Body {
        fn timer_us(&self, unix_us: u64) -> u32 {
            let since_us = (unix_us - BEGIN_US) as f64 * (1.0 + self.ppm * 1e-6);
            (4_000_000_000.0 + since_us).rem_euclid(4_294_967_296.0) as u32
        }

        /// A delay on the cable.
        fn delay_us(&mut self) -> u64 {
            1_000 + self.random.random_range(0..20_000)
        }

        /// The time that the body takes it for, and its error by its own account.
        fn time(&mut self, unix_us: u64) -> (i64, u32) {
            let stamp_us = self.timer_us(unix_us);
            let time = self.time_of_day.as_mut().unwrap().at(stamp_us);
            (time.unix_us as i64 - unix_us as i64, time.error_us)
        }
    }

    /// A day of settings at `baud`; the worst error of the body's clock, microseconds.
    fn day(ppm: f64, baud: u32, pulses: bool) -> i64 {
        let mut body = Body { ppm, time_of_day: None, random: ChaCha8Rng::seed_from_u64(7) };
        let (mut ship, mut now_us, mut worst_us) = (ShipTime::new(Some(baud)), BEGIN_US, 0);
        let byte_us = 10_000_000 / u64::from(baud);
        while now_us < BEGIN_US + DAY_US {
            if let Some(line) = ship.due(now_us) {
                let sent = line.len() + 18;
                ship.goes(1, sent, now_us);
                let came_us = now_us + sent as u64 * byte_us + body.delay_us();
                // The console looks every 40 ms, then the telemetry under way comes first.
                let goes_us = came_us + body.random.random_range(0..40_000);
                let queued_us = body.random.random_range(0..50) * byte_us;
                let answer = match parse(&line).unwrap() {
                    Command::TimeAsk => {
                        TimerTold { came_us: body.timer_us(came_us), goes_us: body.timer_us(goes_us) }.to_string()
                    }
                    Command::TimeSet { time, stamp_us } => {
                        let stamp_us = stamp_us.unwrap();
                        body.time_of_day.get_or_insert(TimeOfDay::set(time, stamp_us)).correct(time, stamp_us);
                        SET.to_string()
                    }
                    command => panic!("{command:?}"),
                };
                let bytes = (answer.len() + acknowledgement(1).len() + 2 * FRAME_OVERHEAD) as u64;
                now_us = goes_us + queued_us + bytes * byte_us + body.delay_us();
                assert!(ship.heard(&answer, now_us));
            }
            now_us += 100_000;
            if body.time_of_day.is_some() {
                if pulses && now_us / 100_000 % 10 == 0 {
                    let stamp_us = body.timer_us(now_us / 1_000_000 * 1_000_000);
                    body.time_of_day.as_mut().unwrap().pulse(stamp_us);
                }
                let (error_us, told_us) = body.time(now_us);
                assert!(error_us.unsigned_abs() <= u64::from(told_us) + 2, "{error_us} us, told {told_us}");
                worst_us = worst_us.max(if pulses && now_us < BEGIN_US + 60_000_000 { 0 } else { error_us.abs() });
            }
        }
        worst_us
    }

    /// `cargo test -p host-sim-library ship_time -- --nocapture` prints the figures.
    #[test]
    fn a_day_of_time() {
        for ppm in [-50.0, 0.0, 50.0] {
            for baud in [115_200, 9_600] {
                let (ship_us, pulses_us) = (day(ppm, baud, false), day(ppm, baud, true));
                println!(
                    "24 h, {ppm:+} ppm, {baud} baud: at most {ship_us} us off by the ship, {pulses_us} us with pulses"
                );
                assert!(ship_us < 50_000 && pulses_us < 10_000, "{ship_us} {pulses_us}");
            }
        }
    }

    #[test]
    fn a_clock_that_is_set_back_meanwhile_makes_no_exchange() {
        let mut ship = ShipTime::new(None);
        assert_eq!(ship.due(BEGIN_US).as_deref(), Some("time ask"));
        ship.goes(1, 20, BEGIN_US);
        assert!(ship.heard("timer: came 5, goes 90", BEGIN_US - 1_000_000));
        assert_eq!(ship.best, None);
        assert!(!ship.heard("settings: intact", BEGIN_US));
    }
}

//! Where on the strip a message belongs.

use crate::recording::EPOCH_S;

/// The ticks lead, for they do not jitter as arrivals do; where they and the clock part by more than this, s, the clock
/// does: a body that was started anew, a clock that was set, a crystal after hours.
const LONGEST_DRIFT_S: f64 = 0.5;

/// Places messages on the strip: by the ship's clock at which they come, or by the body's in what was recorded, or, where
/// nobody knows the time, from 0 on. Never backwards.
#[derive(Debug)]
pub(super) struct StripTime {
    /// A tick and its place, s.
    anchor: Option<(u32, f64)>,
    last_s: f64,
}

impl StripTime {
    pub(super) fn new() -> Self {
        Self { anchor: None, last_s: 0.0 }
    }

    /// The latest place, s.
    pub(super) fn last_s(&self) -> f64 {
        self.last_s
    }

    /// The place of a message, s.
    pub(super) fn place(&mut self, tick: u32, unix_ms: Option<u64>, ship_us: Option<u64>) -> f64 {
        let clock_s = ship_us.map(|us| us as f64 / 1e6).or(unix_ms.map(|ms| ms as f64 / 1e3));
        let by_ticks_s = self.anchor.map(|(first, at_s)| at_s + EPOCH_S * f64::from(tick.wrapping_sub(first) as i32));
        let next_s = self.last_s + EPOCH_S;
        let wanted_s = match (by_ticks_s, clock_s) {
            (Some(ticks_s), Some(clock_s)) if (ticks_s - clock_s).abs() <= LONGEST_DRIFT_S => ticks_s,
            (_, Some(clock_s)) => clock_s,
            // The ticks go back at each start of the body.
            (Some(ticks_s), None) if ticks_s > self.last_s => ticks_s,
            (_, None) => next_s,
        };
        if by_ticks_s != Some(wanted_s) || wanted_s <= self.last_s {
            let place_s = if wanted_s > self.last_s { wanted_s } else { next_s };
            self.anchor = Some((tick, place_s));
            self.last_s = place_s;
        } else {
            self.last_s = wanted_s;
        }
        self.last_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrivals_that_jitter_do_not_bend_the_strip() {
        let mut time = StripTime::new();
        let at = |tick: u32, late_ms: u64| Some(1_767_225_600_000_000 + u64::from(tick) * 100_000 + late_ms * 1_000);
        let places: Vec<f64> =
            (5..100).map(|tick| time.place(tick, None, at(tick, u64::from(tick) * 37 % 200))).collect();
        assert!(places.windows(2).all(|pair| (pair[1] - pair[0] - 0.1).abs() < 1e-6));
        // A cable that was cut for ten seconds, and a body that was started anew.
        let later = time.place(200, None, at(200, 0));
        assert!((later - places[94] - 10.1).abs() < 0.3, "{later}");
        let anew = time.place(3, None, at(300, 0));
        assert!((9.0..11.0).contains(&(anew - later)) && (time.place(4, None, at(301, 0)) - anew - 0.1).abs() < 1e-6);
    }

    #[test]
    fn without_clocks_it_begins_at_nothing_and_never_goes_back() {
        let mut time = StripTime::new();
        let places: Vec<f64> = [7, 8, 9, 12, 1, 2].into_iter().map(|tick| time.place(tick, None, None)).collect();
        let steps: Vec<i64> = places.windows(2).map(|pair| ((pair[1] - pair[0]) * 10.0).round() as i64).collect();
        assert_eq!(steps, [1, 1, 3, 1, 1]);
        // The clock is set, and then set back.
        assert_eq!(time.place(3, Some(1_767_225_600_000), None), 1_767_225_600.0);
        assert!(time.place(4, Some(1_767_225_000_000), None) > 1_767_225_600.0);
        assert!(time.place(5, Some(1_767_225_000_100), None) > 1_767_225_600.1);
    }
}

//! Times of RTKLIB's solutions: GPS time or UTC or Japan's, as a date or as a week and its seconds.

use super::civil;
use super::leap_seconds::{GPS_EPOCH_S, gps_ahead_s};

/// What the line of columns says of the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TimeSystem {
    /// GPS time, ahead of UTC.
    Gps,
    /// UTC.
    Utc,
    /// Japan's civil time, 9 h ahead of UTC.
    Japan,
}

impl TimeSystem {
    /// By the word that RTKLIB puts over the time.
    pub(super) fn of(word: &str) -> Option<Self> {
        match word {
            "GPST" => Some(Self::Gps),
            "UTC" => Some(Self::Utc),
            "JST" => Some(Self::Japan),
            _ => None,
        }
    }

    /// By how much it is ahead of UTC at a time of its own.
    pub(super) fn ahead_s(self, time_s: f64) -> f64 {
        match self {
            Self::Gps => gps_ahead_s(time_s),
            Self::Utc => 0.0,
            Self::Japan => 9.0 * 3600.0,
        }
    }

    /// Seconds since 1970, UTC, from the two fields of a row.
    pub(super) fn utc_s(self, first: &str, second: &str) -> Option<f64> {
        let time_s = match civil::date(first) {
            Some(date) => civil::midnight_s(date)? + civil::clock(second)?,
            None => week_s(first, second)?,
        };
        Some(time_s - self.ahead_s(time_s))
    }
}

/// The week has at most five digits: eight would be a date.
fn week_s(week: &str, seconds: &str) -> Option<f64> {
    let week = Some(week).filter(|week| week.len() <= 5 && !week.contains('.')).and_then(civil::unsigned)?;
    let seconds = civil::unsigned(seconds).filter(|seconds| *seconds <= 604_800.0)?;
    Some(GPS_EPOCH_S + week * 604_800.0 + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_time_in_four_forms() {
        // 2023-06-24 20:22:50.402 GPS time, week 2267 and 591770.402 s: date -u -d '2023-06-24 20:22:32' +%s
        let utc_s = 1_687_638_152.402;
        let forms = [
            (TimeSystem::Gps, "2023/06/24", "20:22:50.402"),
            (TimeSystem::Gps, "2267", "591770.402"),
            (TimeSystem::Utc, "2023/06/24", "20:22:32.402"),
            (TimeSystem::Japan, "2023/06/25", "05:22:32.402"),
        ];
        for (system, first, second) in forms {
            let found = system.utc_s(first, second).unwrap();
            assert!((found - utc_s).abs() < 1e-6, "{system:?} {first} {second}: {found}");
        }
    }

    #[test]
    fn what_is_no_time_is_none() {
        for (first, second) in
            [("", ""), ("2267", "700000"), ("22.5", "1"), ("2023/06/24", "1"), ("2023/02/30", "00:00:00")]
        {
            assert_eq!(TimeSystem::Utc.utc_s(first, second), None, "{first} {second}");
        }
    }
}

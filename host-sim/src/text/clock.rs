//! Seconds since 1970 as a date and a time of the clock, UTC.

use jiff::Timestamp;

/// `14:03:21`.
pub fn seconds(utc_s: f64) -> String {
    written(utc_s.round(), "%H:%M:%S")
}

/// `14:03`.
pub fn minutes(utc_s: f64) -> String {
    written(utc_s.round(), "%H:%M")
}

/// `2026-05-12`.
pub fn date(utc_s: f64) -> String {
    written(utc_s, "%Y-%m-%d")
}

fn written(utc_s: f64, format: &str) -> String {
    // A cast of a float saturates; what no calendar holds is a dash.
    Timestamp::from_millisecond((1000.0 * utc_s) as i64).map_or("–".into(), |time| time.strftime(format).to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clock_and_date() {
        let utc_s = 1_780_300_900.4;
        assert_eq!([date(utc_s), seconds(utc_s), minutes(utc_s)], ["2026-06-01", "08:01:40", "08:01"]);
        assert_eq!(date(f64::MAX), "–");
    }
}

//! Seconds since 1970 as a date and a time of the clock, UTC.

use jiff::Timestamp;

/// Times later than this many seconds are of the clock, whatever their column is called: 2001, and 30 years of a recording.
const UNIX_S: f64 = 1e9;

/// What makes seconds since 1970 of a recording's `time_s`: from its own column of clock times, else none where the times
/// are of the clock already. `None` where neither is known.
pub fn utc_offset_s(time_s: &[f64], utc_s: Option<&[f64]>) -> Option<f64> {
    let pairs = utc_s.unwrap_or_default().iter().zip(time_s);
    let mut offsets: Vec<f64> = pairs.map(|(utc, time)| utc - time).filter(|offset| offset.is_finite()).collect();
    if !offsets.is_empty() {
        let middle = offsets.len() / 2;
        return Some(*offsets.select_nth_unstable_by(middle, f64::total_cmp).1);
    }
    time_s.iter().any(|time_s| *time_s > UNIX_S).then_some(0.0)
}

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

    #[test]
    fn offset_comes_from_the_column_or_from_the_times_themselves() {
        let utc_s = [f64::NAN, 1_780_300_901.0, 1_780_300_902.0, 5.0];
        assert_eq!(utc_offset_s(&[0.0, 1.0, 2.0, 3.0], Some(&utc_s)), Some(1_780_300_900.0));
        assert_eq!(utc_offset_s(&[1_780_300_900.0], None), Some(0.0));
        assert_eq!(utc_offset_s(&[1_780_300_900.0], Some(&[f64::NAN])), Some(0.0));
        assert_eq!(utc_offset_s(&[0.0, 3600.0], None), None);
    }
}

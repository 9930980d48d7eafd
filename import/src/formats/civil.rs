//! Dates and times of day in seconds.

use jiff::civil::Date;

use crate::stamp::{DAY_S, days_since_1970};

/// Year, month, day.
pub(super) type Ymd = (i16, i8, i8);

/// Seconds from 1970-01-01 to the midnight that starts a day; none for a day that no calendar has.
pub(super) fn midnight_s((year, month, day): Ymd) -> Option<f64> {
    days_since_1970(year, month, day).map(|days| days * DAY_S)
}

/// The day that holds these seconds since 1970.
pub(super) fn day_of(time_s: f64) -> Option<Ymd> {
    let days = (time_s / DAY_S).floor();
    let span = jiff::Span::new().try_days(days as i64).ok()?;
    let date = Date::constant(1970, 1, 1).checked_add(span).ok()?;
    days.is_finite().then(|| (date.year(), date.month(), date.day()))
}

/// `2020-01-31` and `2020/01/31`, and `20200131`.
pub(super) fn date(text: &str) -> Option<Ymd> {
    let text = text.trim();
    let ymd = match text.split(['-', '/']).collect::<Vec<_>>()[..] {
        [year, month, day] if year.len() == 4 => (year.parse().ok()?, month.parse().ok()?, day.parse().ok()?),
        [whole] if whole.len() == 8 => {
            let part = |range: std::ops::Range<usize>| whole.get(range);
            (part(0..4)?.parse().ok()?, part(4..6)?.parse().ok()?, part(6..8)?.parse().ok()?)
        }
        _ => return None,
    };
    midnight_s(ymd).map(|_| ymd)
}

/// Seconds of the day. 24:00:00 ends a day, and a minute may have a leap second.
pub(super) fn second_of_day(hour: f64, minute: f64, second: f64) -> Option<f64> {
    let is_whole = hour.fract() == 0.0 && (minute.fract() == 0.0 || second == 0.0);
    let is_time = (0.0..=24.0).contains(&hour) && (0.0..60.0).contains(&minute) && (0.0..61.0).contains(&second);
    let time_s = hour * 3600.0 + minute * 60.0 + second;
    (is_whole && is_time && time_s <= 86_401.0).then_some(time_s)
}

/// `13:37:53.001` in seconds of the day.
pub(super) fn clock(text: &str) -> Option<f64> {
    match text.trim().split(':').collect::<Vec<_>>()[..] {
        [hour, minute, second] => second_of_day(unsigned(hour)?, unsigned(minute)?, unsigned(second)?),
        _ => None,
    }
}

/// A number of digits and a point alone.
pub(super) fn unsigned(text: &str) -> Option<f64> {
    let is_plain =
        !text.is_empty() && text.len() <= 20 && text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
    is_plain.then(|| fast_float2::parse(text).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_counted_from_1970() {
        assert_eq!(midnight_s((1970, 1, 1)), Some(0.0));
        // date -u -d 2020-09-28 +%s
        assert_eq!(midnight_s((2020, 9, 28)), Some(1_601_251_200.0));
        assert_eq!(midnight_s((1969, 12, 31)), Some(-86_400.0));
        assert_eq!(midnight_s((2021, 2, 29)), None);
        assert_eq!(day_of(1_601_251_200.0 + 86_399.9), Some((2020, 9, 28)));
        assert_eq!(day_of(f64::NAN), None);
        assert_eq!(day_of(1e300), None);
    }

    #[test]
    fn dates_have_three_forms() {
        for text in ["2020-01-31", "2020/01/31", " 20200131"] {
            assert_eq!(date(text), Some((2020, 1, 31)));
        }
        assert_eq!(["31/01/2020", "2020-13-01", "2020013", "", "-2020131"].map(date), [None; 5]);
    }

    #[test]
    fn clocks_stop_at_24_hours() {
        assert_eq!(clock("13:37:53.5"), Some(49_073.5));
        assert_eq!(clock("23:59:60.5"), Some(86_400.5));
        assert_eq!(clock("24:00:00"), Some(86_400.0));
        assert_eq!(["24:00:02", "12:60:00", "12:00:61", "12:00", "-1:00:00", "1e1:00:00", "::"].map(clock), [None; 7]);
    }
}

//! Points in time, as spreadsheets have them.

use jiff::SignedDuration;
use jiff::civil::{Date, DateTime};
use jiff::tz::TimeZone;

use super::sheet::Cell;

/// 1970-01-01 in days of the calendar that starts with 1900.
const DAYS_TO_1970: f64 = 25_569.0;
/// Between the calendar that starts with 1900 and the one with 1904.
const DAYS_TO_1904: f64 = 1_462.0;
const DAY_S: f64 = 86_400.0;
/// Serial numbers have some 15 digits: tens of microseconds of a day of this century. Steps a second, to round to.
const STEPS_PER_S: f64 = 10_000.0;

/// A serial number of days; those below one are times of day.
pub(super) fn from_serial(days: f64, is_duration: bool, is_from_1904: bool) -> Cell {
    let rounded = |seconds: f64| (seconds * STEPS_PER_S).round() / STEPS_PER_S;
    if is_duration || (0.0..1.0).contains(&days) {
        return Cell::Time(rounded(days * DAY_S));
    }
    let days = if is_from_1904 { days + DAYS_TO_1904 } else { days };
    Cell::Date(rounded((days - DAYS_TO_1970) * DAY_S))
}

/// A date of ISO 8601, with or without a time of day; without an offset it is taken as UTC.
pub(super) fn from_iso_date(text: &str) -> Option<Cell> {
    let text = text.trim();
    let moment = match text.parse::<jiff::Timestamp>() {
        Ok(moment) => moment,
        Err(_) => {
            let civil = text.parse::<DateTime>().ok();
            let civil = civil.or_else(|| text.parse::<Date>().ok().map(|date| date.at(0, 0, 0, 0)))?;
            TimeZone::UTC.to_timestamp(civil).ok()?
        }
    };
    Some(Cell::Date(moment.as_second() as f64 + f64::from(moment.subsec_nanosecond()) / 1e9))
}

/// A duration of ISO 8601, `PT10H30M0.1S`.
pub(super) fn from_iso_duration(text: &str) -> Option<Cell> {
    text.trim().parse::<SignedDuration>().ok().map(|duration| Cell::Time(duration.as_secs_f64()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn serial_numbers_of_both_calendars_and_iso_dates_are_the_same_moment() {
        let moment = Cell::Date(1_715_990_385.1);
        assert_eq!(from_serial(45_429.999_827_546_3, false, false), moment);
        assert_eq!(from_serial(43_967.999_827_546_3, false, true), moment);
        assert_eq!(from_iso_date("2024-05-17T23:59:45.1"), Some(moment.clone()));
        assert_eq!(from_iso_date("2024-05-18T02:59:45.1+03:00"), Some(moment));
        assert_eq!(from_iso_date("2024-05-17"), Some(Cell::Date(1_715_904_000.0)));
        assert_eq!(from_iso_date("a day in May"), None);
    }

    #[test]
    fn times_of_day_and_durations_are_seconds() {
        assert_eq!(from_serial(0.5, false, false), Cell::Time(43_200.0));
        assert_eq!(from_serial(1.5, true, false), Cell::Time(129_600.0));
        assert_eq!(from_iso_duration("PT10H30M0.1S"), Some(Cell::Time(37_800.1)));
        assert_eq!(from_iso_duration("long"), None);
    }
}

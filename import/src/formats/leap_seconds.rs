//! GPS time is ahead of UTC by the leap seconds since 1980.

use super::civil::{Ymd, midnight_s};

/// The days that began with one second more between GPS time and UTC.
///
/// From IERS Bulletin C (<https://hpiers.obspm.fr/iers/bul/bulc/Leap_Second.dat>); none has been announced since.
const LEAPS: [Ymd; 18] = [
    (1981, 7, 1),
    (1982, 7, 1),
    (1983, 7, 1),
    (1985, 7, 1),
    (1988, 1, 1),
    (1990, 1, 1),
    (1991, 1, 1),
    (1992, 7, 1),
    (1993, 7, 1),
    (1994, 7, 1),
    (1996, 1, 1),
    (1997, 7, 1),
    (1999, 1, 1),
    (2006, 1, 1),
    (2009, 1, 1),
    (2012, 7, 1),
    (2015, 7, 1),
    (2017, 1, 1),
];

/// Where the count of GPS weeks begins, in seconds since 1970.
pub(super) const GPS_EPOCH_S: f64 = 315_964_800.0;

/// By how many seconds GPS time is ahead, at a time in GPS seconds since 1970.
pub(super) fn gps_ahead_s(gps_s: f64) -> f64 {
    let has_come =
        |(index, day): (usize, &Ymd)| midnight_s(*day).is_some_and(|utc_s| gps_s - (index + 1) as f64 >= utc_s);
    LEAPS.iter().enumerate().filter(|leap| has_come(*leap)).count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_difference_grows_at_the_leap_itself() {
        let utc_s = midnight_s((2017, 1, 1)).unwrap();
        assert_eq!([utc_s + 17.9, utc_s + 18.0].map(gps_ahead_s), [17.0, 18.0]);
        assert_eq!([GPS_EPOCH_S, midnight_s((2006, 6, 1)).unwrap(), 4e9].map(gps_ahead_s), [0.0, 14.0, 18.0]);
        assert_eq!(midnight_s((1980, 1, 6)), Some(GPS_EPOCH_S));
    }

    #[test]
    fn every_leap_is_a_day() {
        assert!(LEAPS.iter().all(|day| midnight_s(*day).is_some()) && LEAPS.is_sorted());
    }
}

//! NMEA 0183 sentences: seven kinds that say when and where a ship is.
//! <https://gpsd.gitlab.io/gpsd/NMEA.html>
//!
//! The crate `nmea` is not used: it does not know DBT, keeps speeds in single precision, refuses sentences of more than 102
//! characters, and brings a second library of dates.

use super::civil::{Ymd, midnight_s, second_of_day, unsigned};
use crate::text::number;

/// Metres a second in a knot.
const KNOT: f64 = 1852.0 / 3600.0;

/// What a line of a log is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Parsed<'a> {
    /// A sentence: its address as `GPGGA`, and what follows it.
    Sentence(&'a str, Vec<&'a str>),
    /// A sentence with a wrong checksum.
    Bad,
    /// Something else.
    Other,
}

/// What a sentence says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Reading {
    /// UTC, since midnight.
    pub(super) time_s: Option<f64>,
    pub(super) date: Option<Ymd>,
    pub(super) position_deg: Option<(f64, f64)>,
    pub(super) speed_m_per_s: Option<f64>,
    pub(super) course_deg: Option<f64>,
    pub(super) heading_deg: Option<f64>,
    /// From the surface where the sentence knows how deep the transducer is.
    pub(super) water_depth_m: Option<f64>,
}

/// A sentence of a line, behind a stamp of the logger if there is one. Fields behind a `*` are its checksum.
pub(super) fn parse(line: &str) -> Parsed<'_> {
    let Some((stamp, sentence)) = line.find(['$', '!']).and_then(|at| line.split_at_checked(at)) else {
        return Parsed::Other;
    };
    let body = sentence.get(1..).unwrap_or_default().trim_end();
    let (body, checksum) = body.split_once('*').map_or((body, None), |(body, sum)| (body, Some(sum)));
    let mut fields = body.split(',');
    let address = fields.next().unwrap_or_default();
    if !is_stamp(stamp) || !is_address(address) {
        return Parsed::Other;
    }
    let sum = body.bytes().fold(0, |sum, byte| sum ^ byte);
    match checksum {
        Some(text) if u8::from_str_radix(text.trim(), 16) != Ok(sum) => Parsed::Bad,
        _ => Parsed::Sentence(address, fields.collect()),
    }
}

/// What a sentence of one of the seven kinds says; none for the others.
pub(super) fn reading(address: &str, fields: &[&str]) -> Option<Reading> {
    let field = |index: usize| fields.get(index).map(|field| field.trim()).filter(|field| !field.is_empty());
    let value = |index: usize| field(index).and_then(number);
    let position = |from: usize| {
        Some((angle(field(from)?, field(from + 1)?, 90.0)?, angle(field(from + 2)?, field(from + 3)?, 180.0)?))
    };
    let nothing = Reading::default();
    let kind = address.get(address.len().checked_sub(3)?..)?;
    Some(match kind {
        "GGA" => {
            Reading { time_s: time_s(field(0)), position_deg: position(1).filter(|_| value(5) != Some(0.0)), ..nothing }
        }
        "RMC" => {
            let is_fix = field(1) != Some("V");
            let speed_m_per_s = value(6).map(|knots| knots * KNOT).filter(|_| is_fix);
            let course_deg = value(7).filter(|_| is_fix);
            let position_deg = position(2).filter(|_| is_fix);
            Reading {
                time_s: time_s(field(0)),
                date: short_date(field(8)),
                position_deg,
                speed_m_per_s,
                course_deg,
                ..nothing
            }
        }
        "ZDA" => Reading { time_s: time_s(field(0)), date: long_date([field(1), field(2), field(3)]), ..nothing },
        "VTG" => Reading { course_deg: value(0), speed_m_per_s: value(4).map(|knots| knots * KNOT), ..nothing },
        "HDT" => Reading { heading_deg: value(0), ..nothing },
        // A positive offset is from the surface to the transducer, a negative one from there to the keel.
        "DPT" => Reading { water_depth_m: value(0).map(|depth| depth + value(1).unwrap_or(0.0).max(0.0)), ..nothing },
        "DBT" => Reading { water_depth_m: value(2), ..nothing },
        _ => return None,
    })
}

/// Digits and what parts them, not much of it.
pub(super) fn is_stamp(text: &str) -> bool {
    let is_part = |c: char| c.is_ascii_digit() || " \t:.,;-/_+[]()<>TZ".contains(c);
    text.len() <= 40 && text.chars().all(is_part)
}

fn is_address(text: &str) -> bool {
    (4..=8).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit())
}

/// `133753.000`.
fn time_s(field: Option<&str>) -> Option<f64> {
    let field = field?;
    let part = |range: std::ops::Range<usize>| unsigned(field.get(range)?);
    second_of_day(part(0..2)?, part(2..4)?, unsigned(field.get(4..).filter(|rest| rest.len() >= 2)?)?)
}

/// `280920`; GPS is from 1980.
fn short_date(field: Option<&str>) -> Option<Ymd> {
    let field = field.filter(|field| field.len() == 6)?;
    let part = |range: std::ops::Range<usize>| field.get(range)?.parse::<i8>().ok().filter(|part| *part >= 0);
    let year = i16::from(part(4..6)?);
    let ymd = (year + if year < 80 { 2000 } else { 1900 }, part(2..4)?, part(0..2)?);
    midnight_s(ymd).map(|_| ymd)
}

fn long_date([day, month, year]: [Option<&str>; 3]) -> Option<Ymd> {
    let ymd = (year?.parse().ok()?, month?.parse().ok()?, day?.parse().ok()?);
    midnight_s(ymd).map(|_| ymd)
}

/// Degrees from `5651.737132` and `N`.
fn angle(field: &str, hemisphere: &str, largest: f64) -> Option<f64> {
    let value = unsigned(field)?;
    let degrees = (value / 100.0).floor();
    let minutes = value - 100.0 * degrees;
    let size = Some(degrees + minutes / 60.0).filter(|size| minutes < 60.0 && *size <= largest)?;
    match hemisphere {
        "N" | "E" => Some(size),
        "S" | "W" => Some(-size),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Reading {
        let Parsed::Sentence(address, fields) = parse(line) else { panic!("{line}: {:?}", parse(line)) };
        reading(address, &fields).unwrap()
    }

    #[test]
    fn a_fix_has_time_and_position() {
        let fix = read("$GNGGA,133753.000,5651.737132,N,02406.816782,E,2,12,0.79,8.366,M,23.853,M,,*7E");
        assert_eq!(fix.time_s, Some(13.0 * 3600.0 + 37.0 * 60.0 + 53.0));
        let (lat, lon) = fix.position_deg.unwrap();
        assert!((lat - 56.862_285_533).abs() < 1e-9 && (lon - 24.113_613_033).abs() < 1e-9, "{lat} {lon}");
        assert_eq!(read("$GPGGA,133753,5651.7,N,02406.8,E,0,,,,M,,M,,").position_deg, None);
    }

    #[test]
    fn the_minimum_has_date_speed_and_course() {
        let minimum = read("$GNRMC,133753.000,A,5651.737132,S,02406.816782,W,10.00,252.26,280920,,,D*4D");
        assert_eq!((minimum.date, minimum.course_deg), (Some((2020, 9, 28)), Some(252.26)));
        assert!((minimum.speed_m_per_s.unwrap() - 5.144_444).abs() < 1e-6);
        assert!(minimum.position_deg.unwrap().0 < -56.0 && minimum.position_deg.unwrap().1 < -24.0);
        let void = read("$GNRMC,133753,V,5651.7,N,02406.8,E,10,252,280999,,,N");
        assert_eq!((void.position_deg, void.speed_m_per_s, void.date), (None, None, Some((1999, 9, 28))));
    }

    #[test]
    fn others_have_what_they_have() {
        assert_eq!(read("$GPZDA,000001.5,28,09,2020,00,00").date, Some((2020, 9, 28)));
        assert_eq!(read("$GPHDT,274.07,T").heading_deg, Some(274.07));
        assert_eq!(read("$SDDPT,12.5,0.5").water_depth_m, Some(13.0));
        assert_eq!(read("$SDDPT,12.5,-0.5").water_depth_m, Some(12.5));
        assert_eq!(read("$SDDBT,41.0,f,12.5,M,6.8,F").water_depth_m, Some(12.5));
        let track = read("$GPVTG,220.86,T,,M,10.0,N,18.52,K,A");
        assert!(track.course_deg == Some(220.86) && (track.speed_m_per_s.unwrap() - 5.144_444).abs() < 1e-6);
        assert_eq!(reading("GPGSA", &[]), None);
    }

    #[test]
    fn checksums_and_stamps_are_verified() {
        assert!(matches!(parse("2020-09-28T13:37:53.1Z, $GPHDT,274.07,T*03"), Parsed::Sentence("GPHDT", _)));
        for bad in ["$GPHDT,274.07,T*04", "$GPHDT,274.07,T*", "$GPHDT,274.07,T*xx"] {
            assert_eq!(parse(bad), Parsed::Bad);
        }
        for other in ["", "GPHDT,1", "$ 49895.131,1249", "4689,51383.1,G,\"$GPHDT,274.07,T*03\"", "$gphdt,1", "$€,"] {
            assert_eq!(parse(other), Parsed::Other, "{other}");
        }
    }

    #[test]
    fn what_makes_no_sense_is_missing() {
        let fix = read("$GPGGA,256161,9951.7,N,02406.8,E,1");
        assert_eq!((fix.time_s, fix.position_deg), (None, None));
        assert_eq!(read("$GPGGA,1337,5661.7,N,02406.8,E,1"), Reading::default());
        assert_eq!(read("$GPZDA,000001,30,02,2020,00,00").date, None);
        assert_eq!(read("$GPRMC,,A,,,,,,,-1-2-3"), Reading::default());
    }
}

//! Readings of a magnetometer among sentences of navigation: such a log is two files in one.

use super::nmea_sentence::{Parsed, is_stamp, parse};
use crate::text::number;

/// Total fields on Earth, nT, with some room. Only a number with decimals counts.
const FIELD_NT: std::ops::Range<f64> = 15_000.0..80_000.0;

/// Kinds of navigation, weather and autopilots: their times and counts may look like a field.
const KINDS: [&str; 46] = [
    "GGA", "RMC", "ZDA", "DPT", "DBT", "HDT", "VTG", "GLL", "GSA", "GSV", "GST", "GNS", "GBS", "GRS", "HDG", "HDM",
    "THS", "ROT", "VHW", "VLW", "VBW", "VDR", "MTW", "MWV", "MWD", "MDA", "DBS", "DBK", "DTM", "RTE", "WPL", "APB",
    "APA", "XTE", "BOD", "BWC", "BWR", "RMB", "RSA", "RSD", "TTM", "TLL", "TXT", "VDM", "VDO", "ZTG",
];

/// Makers of receivers, motion sensors, sounders and pressure sensors.
const MAKERS: [&str; 15] = [
    "PASHR", "PUBX", "PGRM", "PSRF", "PSAT", "PTNL", "PMTK", "PFEC", "PQTM", "PSTM", "PSXN", "PKON", "PRVAT", "PIPS",
    "PVIPS",
];

/// How a line with a magnetometer's reading starts, as `$PMAG`.
pub(super) fn magnetic(line: &str) -> Option<&str> {
    let (start, rest) = match parse(line) {
        Parsed::Sentence(address, _) if is_known(address) => return None,
        Parsed::Bad => return None,
        Parsed::Sentence(address, _) => line.split_once(address).map(|(_, rest)| (address, rest))?,
        Parsed::Other => ("", after_stamp(line)?),
    };
    let has_point = |field: &str| field.contains('.');
    let mut fields = rest.split([',', ' ', '\t', ';', '*']).take(32);
    let is_reading =
        fields.any(|field| has_point(field) && number(field).is_some_and(|value| FIELD_NT.contains(&value)));
    is_reading.then_some(start)
}

fn is_known(address: &str) -> bool {
    MAKERS.iter().any(|maker| address.starts_with(maker))
        || address.len() == 5 && KINDS.iter().any(|kind| address.ends_with(kind))
}

/// A line of its own like `$ 49895.131,1249`, or one of numbers alone.
fn after_stamp(line: &str) -> Option<&str> {
    match line.split_once('$') {
        Some((stamp, rest)) => is_stamp(stamp).then_some(rest),
        None => line.trim_start().starts_with(|c: char| c.is_ascii_digit()).then_some(line),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_are_known_by_their_size() {
        assert_eq!(magnetic("$PMAG,49895.131,1249"), Some("PMAG"));
        assert_eq!(magnetic("12:00:01 $MMTFM,49895.131*00"), None);
        assert_eq!(magnetic("12:00:01 $MMTFM,49895.131"), Some("MMTFM"));
        assert_eq!(magnetic("$ 49895.131,1249"), Some(""));
        assert_eq!(magnetic("12:00:01.5, 49895.131"), Some(""));
    }

    #[test]
    fn navigation_is_none() {
        for line in [
            "$GPGGA,033519.00,N",
            "$PUBX,00,033519.00",
            "$PMAG,1.5",
            "$PMAG,49895",
            "",
            "text 49895.131",
            "# $ 49895.1",
        ] {
            assert_eq!(magnetic(line), None, "{line}");
        }
    }
}

//! The header of an IAGA-2002 file: labels in 24 characters, values to column 69, a bar in column 70.
//! <https://www.ngdc.noaa.gov/IAGA/vdat/IAGA2002/iaga2002format.html>

use crate::source::{FindingKind, Note};
use crate::text::{Line, number};

/// What the header says that a person or the importer may want to know.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Header {
    /// Name of the station, else its code.
    pub(super) station: Option<String>,
    /// Three letters that the columns' names start with.
    pub(super) code: String,
    /// Latitude and longitude, -180 to 180, where they are that.
    pub(super) position_deg: Option<(f64, f64)>,
    /// The components, as the line of columns names them without the code.
    pub(super) components: Vec<String>,
    /// What of it could not be used.
    pub(super) notes: Vec<Note>,
}

/// Whether this line starts such a file.
pub(super) fn is_first(line: &str) -> bool {
    let mut words = line.split_ascii_whitespace();
    words.next().is_some_and(|word| word.eq_ignore_ascii_case("format"))
        && words.next().is_some_and(|word| word.to_ascii_uppercase().starts_with("IAGA-2002"))
}

/// The header, read from the lines up to that of the columns, which is taken too; none where that line is missing.
pub(super) fn header<'a>(lines: &mut impl Iterator<Item = Line<'a>>) -> Option<Header> {
    let mut header = Header::default();
    let mut position = [None, None];
    for line in lines {
        if is_columns(line.text) {
            header.components = components(line.text, &header.code);
            header.station = header.station.or(Some(header.code.clone())).filter(|name| !name.is_empty());
            header.place(position);
            return Some(header);
        }
        let Some((label, value)) = labelled(line.text).filter(|(_, value)| !value.is_empty()) else { continue };
        match label.to_ascii_lowercase().as_str() {
            "station name" => header.station = Some(value.to_string()),
            "iaga code" => header.code = value.to_string(),
            "geodetic latitude" => position[0] = Some(value),
            "geodetic longitude" => position[1] = Some(value),
            _ => {}
        }
    }
    None
}

impl Header {
    /// Degrees on a globe, or a note. Some files have a grid's coordinates there.
    fn place(&mut self, position: [Option<&str>; 2]) {
        let [Some(latitude), Some(longitude)] = position else { return };
        let degrees = [latitude, longitude].map(number);
        self.position_deg = match degrees {
            [Some(lat), Some(lon)] if (-90.0..=90.0).contains(&lat) && (-180.0..=360.0).contains(&lon) => {
                Some((lat, if lon > 180.0 { lon - 360.0 } else { lon }))
            }
            _ => None,
        };
        if self.position_deg.is_none() {
            let text = format!("latitude {latitude} and longitude {longitude} of the header are no degrees: not used");
            self.notes.push(Note { kind: FindingKind::Missing, text });
        }
    }
}

fn labelled(line: &str) -> Option<(&str, &str)> {
    let line = line.trim_end().trim_end_matches('|');
    let (label, value) = (line.get(..24)?, line.get(24..)?);
    Some((label.trim(), value.trim()))
}

fn is_columns(line: &str) -> bool {
    let mut words = line.split_ascii_whitespace().take(2);
    words.next().is_some_and(|word| word.eq_ignore_ascii_case("date"))
        && words.next().is_some_and(|word| word.eq_ignore_ascii_case("time"))
}

/// What stands after DATE, TIME and DOY. The standard has four; a line of more is no such header.
fn components(line: &str, code: &str) -> Vec<String> {
    let names = line.trim_end().trim_end_matches('|').split_ascii_whitespace().skip(3).take(16);
    let bare = |name: &str| {
        match name.get(..code.len()) {
            Some(start) if start.eq_ignore_ascii_case(code) && name.len() > code.len() => name.get(code.len()..),
            _ => None,
        }
        .unwrap_or(name)
        .to_string()
    };
    names.map(bare).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::lines;

    fn of(latitude: &str, longitude: &str) -> Header {
        let labels = [("Format", "IAGA-2002"), ("Station Name", "Boulder"), ("IAGA CODE", "BOU")];
        let position = [("Geodetic Latitude", latitude), ("Geodetic Longitude", longitude), ("# a remark", "")];
        let labels = labels.into_iter().chain(position);
        let mut text: String = labels.map(|(label, value)| format!(" {label:23}{value:45}|\r\n")).collect();
        text.push_str("DATE       TIME         DOY     BOUH      BOUD      bouZ      LLONUL|\r\nrest");
        assert!(is_first(text.lines().next().unwrap()));
        header(&mut lines(&text)).unwrap()
    }

    #[test]
    fn components_lose_the_code() {
        let header = of("40.137", "254.764");
        assert_eq!(header.components, ["H", "D", "Z", "LLONUL"]);
        assert_eq!((header.station.as_deref(), &header.code[..]), (Some("Boulder"), "BOU"));
        let (lat, lon) = header.position_deg.unwrap();
        assert!(lat == 40.137 && (lon + 105.236).abs() < 1e-9, "{lat} {lon}");
    }

    #[test]
    fn a_grid_is_no_position() {
        let header = of("310086.6051", "-34833.41399");
        assert_eq!(header.position_deg, None);
        let text = "latitude 310086.6051 and longitude -34833.41399 of the header are no degrees: not used";
        assert_eq!(header.notes[0].text, text);
        assert_eq!(of("", "").notes, []);
    }

    #[test]
    fn without_its_columns_it_is_none() {
        assert_eq!(header(&mut lines(" Format                 IAGA-2002       |\n")), None);
        assert!(!is_first("Format"));
    }
}

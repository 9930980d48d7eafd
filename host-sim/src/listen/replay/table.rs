//! The table of `listen --csv`, row by row.

use std::fs::File;
use std::path::Path;

use csv::StringRecord;
use towmag_live::Sample;

use super::shown::Shown;
use crate::error::HostError;
use crate::recording::EPOCH_S;

/// Columns that are shown, in the order of [`Place`].
const COLUMNS: [&str; 12] = [
    "tick",
    "time_s",
    "ship_time_s",
    "scalar_nT",
    "compensated_nT",
    "residual_nT",
    "valid",
    "depth_m",
    "altitude_m",
    "latitude_deg",
    "longitude_deg",
    "battery_V",
];

/// Whether a file begins as such a table does.
pub(super) fn is_start(start: &[u8]) -> bool {
    start.starts_with(b"tick,time_s,time_error_s,")
}

/// The rows of such a table.
pub(super) struct ListenTable {
    file: String,
    rows: csv::StringRecordsIntoIter<File>,
    places: [Option<usize>; COLUMNS.len()],
    leak: Option<usize>,
    notes: Option<usize>,
    last_s: f64,
}

impl ListenTable {
    pub(super) fn open(path: &Path) -> Result<Self, HostError> {
        // A last line that was cut has fewer fields.
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_path(path)?;
        let header = reader.headers()?.clone();
        let place = |name: &str| header.iter().position(|column| column == name);
        Ok(Self {
            file: path.display().to_string(),
            places: COLUMNS.map(place),
            leak: place("leak"),
            notes: place("notes"),
            rows: reader.into_records(),
            last_s: f64::NEG_INFINITY,
        })
    }

    fn shown(&mut self, row: &StringRecord) -> Option<Shown> {
        let numbers = self.places.map(|place| row.get(place?)?.parse::<f64>().ok());
        let [
            tick,
            sent_s,
            ship_s,
            raw_nt,
            compensated_nt,
            residual_nt,
            valid,
            depth_m,
            altitude_m,
            latitude,
            longitude,
            battery_v,
        ] = numbers;
        let time_s = ship_s.or(sent_s).or(tick.map(|tick| EPOCH_S * tick))?;
        // Messages that came in one piece have one time of the ship: they were a tenth of a second apart.
        let time_s = if time_s > self.last_s { time_s } else { self.last_s + EPOCH_S };
        self.last_s = time_s;
        let sample = Sample {
            time_s,
            sent_s,
            heard_s: None,
            raw_nt,
            compensated_nt,
            residual_nt,
            depth_m,
            altitude_m,
            position_deg: latitude.zip(longitude).map(|(latitude, longitude)| [latitude, longitude]),
            has_leak: self
                .leak
                .and_then(|place| row.get(place))
                .filter(|leak| !leak.is_empty())
                .map(|leak| leak == "1"),
            battery_v,
        };
        let notes = self.notes.and_then(|place| row.get(place)).unwrap_or_default();
        let notes = notes.split("; ").filter(|note| !note.is_empty()).map(str::to_string).collect();
        Some(Shown { sample, is_valid: valid == Some(1.0), notes })
    }
}

impl Iterator for ListenTable {
    type Item = Result<Shown, HostError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.rows.next()? {
                Ok(row) => match self.shown(&row) {
                    Some(shown) => return Some(Ok(shown)),
                    None => continue,
                },
                Err(error) => return Some(Err(HostError::NotEnough(format!("{}: {error}", self.file)))),
            }
        }
    }
}

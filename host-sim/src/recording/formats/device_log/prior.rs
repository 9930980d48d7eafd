//! What the body has started from, as its log says.

use std::path::Path;

use towmag::estimate::Prior;
use towmag::log::{Event, EventKind, InformationParts, Record, Records, Recovered};

use super::blocks::{FileBlocks, survey};
use super::told::told_in_time;
use crate::recording::error::RecordingError;

/// What the first session of a log started from, as far as the log says it; `None` for what holds no header.
///
/// # Errors
///
/// When the file cannot be read.
pub fn prior_from_log(path: &Path) -> Result<Option<Prior>, RecordingError> {
    let io = |source| RecordingError::Io { path: path.display().to_string(), source };
    let mut blocks = FileBlocks::open(path).map_err(io)?;
    let (mut keys, _) = survey(&mut blocks);
    // Of several files the first need not have the lowest number.
    if keys.first().map(|key| key.id.file_number) != keys.last().map(|key| key.id.file_number) {
        told_in_time(&mut blocks, &mut keys);
    }
    let mut coefficients = None;
    let [mut information, mut level] = [InformationParts::default(); 2];
    for item in Records::new(&mut blocks, &keys) {
        match item {
            Recovered::Record(Record::Header(header)) if coefficients.is_none() => {
                coefficients = Some(header.coefficients);
            }
            Recovered::Record(Record::Event(Event { kind: EventKind::Information(part), .. })) => {
                information.add(&part)
            }
            Recovered::Record(Record::Event(Event { kind: EventKind::Level(part), .. })) => level.add(&part),
            Recovered::Record(Record::Epoch(_)) => break,
            _ => {}
        }
    }
    let [information, level] = [information, level].map(|parts| parts.information());
    Ok(coefficients.map(|coefficients| Prior { coefficients, information, level }))
}

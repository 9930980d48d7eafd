//! A log of NMEA 0183 sentences, with or without stamps of the logger.

use super::format::{Input, SourceFormat};
use super::nmea_epochs::{Epochs, WATER_DEPTH};
use super::nmea_foreign::magnetic;
use super::nmea_sentence::{Parsed, parse, reading};
use crate::error::ImportError;
use crate::source::{FindingKind, Note, Source, SourceTable};
use crate::text::{Line, Tally, decoded, lines};

/// A log of NMEA 0183 sentences.
#[derive(Debug)]
pub(super) struct NmeaLog;

/// Fewer lines with a field's size in them than this are accidents.
const FEWEST_MAGNETIC: usize = 3;

impl SourceFormat for NmeaLog {
    fn name(&self) -> &'static str {
        "NMEA 0183 log"
    }

    /// By one sentence of navigation, and most lines being sentences or a magnetometer's readings beside them.
    fn recognises(&self, first: &[u8]) -> bool {
        let text = decoded(first);
        let (mut navigation, mut like, mut all) = (0, 0, 0_usize);
        for line in lines(&text).filter(|line| !line.text.trim().is_empty()) {
            all += 1;
            match parse(line.text) {
                Parsed::Sentence(address, fields) => {
                    like += 1;
                    navigation += usize::from(reading(address, &fields).is_some());
                }
                Parsed::Bad => like += 1,
                Parsed::Other => like += usize::from(magnetic(line.text).is_some()),
            }
        }
        navigation > 0 && 2 * like > all
    }

    fn read(&self, input: &Input<'_>) -> Result<Source, ImportError> {
        let text = decoded(input.bytes);
        if let Some(refusal) = mixed(input.file, lines(&text)) {
            return Err(refusal);
        }
        let table = table(lines(&text));
        if table.rows == 0 {
            let what =
                "NMEA sentences without a time, or with nothing else: a log of navigation needs GGA or RMC sentences";
            return Err(ImportError::file(input.file, what));
        }
        Ok(Source { file: input.file.into(), format: self.name(), tables: vec![table] })
    }
}

fn table<'a>(lines: impl Iterator<Item = Line<'a>>) -> SourceTable {
    let (mut epochs, mut bad, mut cut) = (Epochs::default(), Tally::default(), None);
    for line in lines {
        match parse(line.text) {
            // A last line without its checksum may have lost digits too.
            Parsed::Sentence(_, _) if !line.is_ended && !line.text.contains('*') => cut = Some(line.number),
            Parsed::Bad if !line.is_ended => cut = Some(line.number),
            Parsed::Sentence(address, fields) => {
                if let Some(reading) = reading(address, &fields) {
                    epochs.add(line.number, reading);
                }
            }
            Parsed::Bad => bad.add(line.number),
            Parsed::Other => {}
        }
    }
    let mut table = epochs.table();
    table.notes.extend(notes(bad, cut));
    table.notes.extend(depth_note(&table));
    table
}

/// A ship's log tells the water's depth, a body's may tell its own.
fn depth_note(table: &SourceTable) -> Option<Note> {
    let has_depth = table.columns.iter().any(|column| column.name == WATER_DEPTH);
    let text = format!(
        "DPT and DBT are carried as {WATER_DEPTH}, a ship's echo sounder: a pressure sensor's of the body is to be named"
    );
    has_depth.then_some(Note { kind: FindingKind::Choice, text })
}

fn notes(bad: Tally, cut: Option<u32>) -> impl Iterator<Item = Note> {
    let one = "sentence with a wrong checksum is left out";
    let bad = bad.note(FindingKind::Dummies, one, "sentences with a wrong checksum are left out");
    let text = |line| format!("the file ends within line {line}, which is left out");
    bad.into_iter().chain(cut.map(|line| Note { kind: FindingKind::Truncated, text: text(line) }))
}

/// The refusal of a log with a magnetometer's readings in it.
fn mixed<'a>(file: &str, lines: impl Iterator<Item = Line<'a>>) -> Option<ImportError> {
    let found = lines.filter_map(|line| magnetic(line.text).map(|start| (line.number, start)));
    let mut count = Tally::default();
    let mut first = None;
    for (number, start) in found {
        count.add(number);
        first.get_or_insert((number, start));
    }
    let (line, start) = first.filter(|_| count.count() >= FEWEST_MAGNETIC)?;
    let what = format!(
        "a magnetometer's readings among sentences of navigation, here and on {} other lines: write the lines with `${start}` \
         into a file of their own, and give both files to the import",
        count.count() - 1
    );
    Some(ImportError::at(file, line.into(), what))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Values;

    const LOG: &str = "\
$GNGGA,133753.000,5651.737132,N,02406.816782,E,2,12,0.79,8.366,M,23.853,M,,*7E\r
$GNRMC,133753.000,A,5651.737132,N,02406.816782,E,0.29,252.26,280920,,,D*78\r
$GPHDT,274.07,T*04\r
$GPHDT,274.07,T*03\r
$GPGSA,A,3\r
$GNGGA,133754.000,5651.737132,N,02406.816782,E,2,12,0.79,8.366,M,23.853,M,,*79\r
$GPHDT,275.0";

    fn read(text: &str) -> Result<Source, ImportError> {
        NmeaLog.read(&Input { file: "nav.log", bytes: text.as_bytes(), companions: &[], part: None })
    }

    #[test]
    fn a_log_becomes_rows_of_navigation() {
        let table = read(LOG).unwrap().tables.remove(0);
        let day = 1_601_251_200.0 + 49_073.0;
        assert_eq!(table.columns[0].values, Values::Times(vec![day, day + 1.0]));
        let heading = table.columns.iter().find(|column| column.name == "heading_deg").unwrap();
        assert_eq!(format!("{:?}", heading.as_numbers().unwrap()), "[274.07, NaN]");
        let notes: Vec<_> = table.notes.iter().map(|note| (note.kind, &note.text[..])).collect();
        let wanted = [
            (FindingKind::Dummies, "1 sentence with a wrong checksum is left out: in line 3"),
            (FindingKind::Truncated, "the file ends within line 7, which is left out"),
        ];
        assert_eq!(notes, wanted);
    }

    #[test]
    fn whose_depth_it_is_is_told() {
        let table = read("$GPGGA,133753,5651.7,N,02406.8,E,1\n$SDDPT,12.5,0.5\n").unwrap().tables.remove(0);
        assert_eq!((table.notes.len(), table.notes[0].kind), (1, FindingKind::Choice));
        assert_eq!(table.columns.last().map(|column| &column.name[..]), Some("water_depth_m"));
    }

    #[test]
    fn stamps_of_the_logger_are_no_matter() {
        let stamped: String = LOG.lines().map(|line| format!("[2020-09-28 13:37:53.1] {line}\n")).collect();
        assert!(NmeaLog.recognises(stamped.as_bytes()));
        assert_eq!(read(&stamped).unwrap().tables[0].columns[..2], read(LOG).unwrap().tables[0].columns[..2]);
    }

    #[test]
    fn mixed_logs_are_refused() {
        for reading in ["$PMAG,49895.131,1249", "$ 49895.131,1249"] {
            let log = format!("{}\n{reading}\n{reading}\n{reading}\n", LOG.lines().next().unwrap());
            assert!(NmeaLog.recognises(log.as_bytes()));
            let refusal = read(&log).unwrap_err().to_string();
            assert!(refusal.starts_with("nav.log:2: a magnetometer's readings among"), "{refusal}");
            assert!(refusal.contains("on 2 other lines"), "{refusal}");
        }
    }

    #[test]
    fn it_is_known_by_its_sentences() {
        assert!(NmeaLog.recognises(LOG.as_bytes()));
        for text in ["", "$PMAG,49895.131\n", "a,b\n1,2\n$GPHDT,274.07,T*03\n", "1,\"$GPHDT,274.07,T*03\"\n"] {
            assert!(!NmeaLog.recognises(text.as_bytes()), "{text}");
        }
        assert!(read("$GPHDT,274.07,T*03\n").unwrap_err().to_string().contains("without a time"));
    }
}

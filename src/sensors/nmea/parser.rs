//! Bytes to sentences whose checksum is right.

use super::decode::{Malformed, decode};
use super::settings::NmeaSettings;
use crate::navigation::NavigationReport;
use crate::sensors::count;
use embedded_hal_nb::serial::ErrorKind;

/// Longest sentence between `$` and line end, bytes: the standard's 79, and room for what some sensors add.
pub const LONGEST_NMEA: usize = 120;

/// What went wrong on the line since the start. Full counters stay full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NmeaFaults {
    /// Sentences without a checksum, or with a wrong one.
    pub bad_checksum: u32,
    /// Sentences that are cut or too long, and those with a right checksum that are not of their own form.
    pub malformed: u32,
    /// Bytes outside any sentence.
    pub rubbish_bytes: u32,
    /// Bytes lost, or with a wrong stop bit or noise: wrong baud rate or a bad cable.
    pub receive_errors: u32,
}

/// Byte-wise parser, with its counters. A `$` begins a sentence wherever it comes, so that after any rubbish the next whole
/// sentence is read.
#[derive(Clone, Debug)]
pub struct NmeaParser {
    settings: NmeaSettings,
    place: Place,
    text: heapless::Vec<u8, LONGEST_NMEA>,
    first_byte_us: u32,
    faults: NmeaFaults,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Between,
    Sentence,
    /// A line that is no sentence but is allowed to be there: `!` begins those of an AIS.
    OtherLine,
}

impl NmeaParser {
    pub(super) fn new(settings: NmeaSettings) -> Self {
        let text = heapless::Vec::new();
        Self { settings, place: Place::Between, text, first_byte_us: 0, faults: NmeaFaults::default() }
    }

    /// One byte, received when the timer stood at `now_us`. A report comes out with the byte that ends its sentence.
    pub fn push(&mut self, byte: u8, now_us: u32) -> Option<NavigationReport> {
        match (self.place, byte) {
            (_, b'$') => {
                self.break_off();
                (self.place, self.first_byte_us) = (Place::Sentence, now_us);
            }
            (Place::Sentence, b'\r' | b'\n') => {
                self.place = Place::Between;
                return self.sentence();
            }
            (Place::Sentence, b' '..=b'~') => {
                if self.text.push(byte).is_err() {
                    self.break_off();
                }
            }
            (Place::Sentence, _) => self.break_off(),
            (Place::OtherLine, b'\r' | b'\n') => self.place = Place::Between,
            (Place::Between, b'!') => self.place = Place::OtherLine,
            (Place::Between, b'\r' | b'\n') | (Place::OtherLine, _) => {}
            (Place::Between, _) => count(&mut self.faults.rubbish_bytes),
        }
        None
    }

    /// The receiver reports an error: count it, and give up the sentence that it falls into.
    pub fn receive_error(&mut self, _: ErrorKind) {
        count(&mut self.faults.receive_errors);
        self.break_off();
    }

    /// What went wrong since the start.
    pub fn faults(&self) -> &NmeaFaults {
        &self.faults
    }

    /// Give up the sentence under way, if there is one.
    fn break_off(&mut self) {
        if self.place == Place::Sentence {
            count(&mut self.faults.malformed);
        }
        self.place = Place::Between;
        self.text.clear();
    }

    fn sentence(&mut self) -> Option<NavigationReport> {
        let decoded = checked(&self.text).map(|text| decode(&self.settings, text));
        self.text.clear();
        match decoded {
            Some(Ok(navigation)) => {
                let report = NavigationReport { navigation, stamp_us: self.first_byte_us };
                return (!navigation.is_empty()).then_some(report);
            }
            Some(Err(Malformed)) => count(&mut self.faults.malformed),
            None => count(&mut self.faults.bad_checksum),
        }
        None
    }
}

/// What stands before `*hh`, if the two hexadecimal digits are the exclusive or of its bytes.
fn checked(text: &[u8]) -> Option<&[u8]> {
    let (content, &[b'*', high, low]) = text.split_last_chunk()? else { return None };
    let told = char::from(high).to_digit(16)? << 4 | char::from(low).to_digit(16)?;
    let sum = content.iter().fold(0, |sum, byte| sum ^ byte);
    (told == u32::from(sum)).then_some(content)
}

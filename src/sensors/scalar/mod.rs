//! Scalar sensors: bytes in, readings out.
//!
//! All three formats are lines of ASCII text without a checksum, so that a byte lost in the middle of a number can leave
//! a plausible wrong one. Three things stand against it: the receiver's own errors discard the sentence they fall
//! into ([`ScalarParser::receive_error`]), every sentence must have its format's exact form, and the accepted range of
//! the field can be narrowed to what the survey area holds ([`ScalarSettings::lowest_nt`]).

mod count_scale;
mod faults;
mod fields;
mod g882;
mod line;
mod qtfm_gen1;
mod qtfm_gen2;
mod reader;

pub use faults::{LONGEST_SENTENCE, ScalarFaults};
pub use qtfm_gen2::{Magdata, QtfmGen2Settings};
pub use reader::ScalarReader;

use super::{check, count};
use crate::settings::SettingsError;
use count_scale::CountScale;
use embedded_hal_nb::serial::ErrorKind;
use fields::{Decoded, Defect, Marker};
use line::{Framing, Line};

/// What the sensor sends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScalarFormat {
    /// Geometrics G-882, G-822A and G-823 with the CM-221 counter, ASCII, 9600 8N1 by default.
    G882,
    /// QuSpin QTFM Gen-1, 115200 8N1.
    QtfmGen1 {
        /// Counts per nanotesla, 1 to 1,000,000. The maker's figure is [`ScalarFormat::GEN1_COUNTS_PER_NT`].
        counts_per_nt: f64,
    },
    /// QuSpin QTFM Gen-2, 115200 8N1 by default.
    QtfmGen2(QtfmGen2Settings),
}

impl ScalarFormat {
    /// Scale of the QTFM Gen-1 (<http://quspin.com/qtfm/qtfm-serial-communication/>, 2017).
    pub const GEN1_COUNTS_PER_NT: f64 = 6009.342147;
}

/// Settings of the scalar sensor. `build` turns them into a parser, once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScalarSettings {
    /// What the sensor sends.
    pub format: ScalarFormat,
    /// Least total field of a valid reading, nT; 1,000 to 100,000 and not above `highest_nt`.
    pub lowest_nt: f64,
    /// Greatest total field of a valid reading, nT; 1,000 to 100,000.
    pub highest_nt: f64,
    /// Least signal of a valid reading, in the sensor's own units. A reading that carries no signal passes.
    pub weakest_signal: u32,
    /// Greatest signal of a valid reading, in the sensor's own units.
    pub strongest_signal: u32,
}

impl ScalarSettings {
    /// G-882. The weakest signal is the manual's limit for a sensor that is well oriented, 800 (G-882 manual p. 94); in
    /// poor orientation the sensor may go on working below it.
    pub const G882: Self = Self { format: ScalarFormat::G882, weakest_signal: 800, ..Self::ANY_SIGNAL };

    /// QTFM Gen-1 with the maker's scale. No source gives limits of its signal: any passes.
    pub const QTFM_GEN1: Self =
        Self { format: ScalarFormat::QtfmGen1 { counts_per_nt: ScalarFormat::GEN1_COUNTS_PER_NT }, ..Self::ANY_SIGNAL };

    /// QTFM Gen-2 as recorded. No source gives limits of its signal: any passes.
    pub const QTFM_GEN2: Self = Self { format: ScalarFormat::QtfmGen2(QtfmGen2Settings::RECORDED), ..Self::ANY_SIGNAL };

    const ANY_SIGNAL: Self = Self {
        format: ScalarFormat::G882,
        lowest_nt: 1_000.0,
        highest_nt: 100_000.0,
        weakest_signal: 0,
        strongest_signal: u32::MAX,
    };

    /// The parser, or which setting is wrong.
    pub fn build(&self) -> Result<ScalarParser, SettingsError> {
        check("lowest_nt", self.lowest_nt, 1_000.0..=self.highest_nt, "1000 to highest_nt")?;
        check("highest_nt", self.highest_nt, 1_000.0..=100_000.0, "1000 to 100000")?;
        check("weakest_signal", self.weakest_signal.into(), 0.0..=self.strongest_signal.into(), "0 to strongest")?;
        let decoder = match self.format {
            ScalarFormat::G882 => Decoder::G882,
            ScalarFormat::QtfmGen1 { counts_per_nt } => Decoder::QtfmGen1(CountScale::new(counts_per_nt)?),
            ScalarFormat::QtfmGen2(settings) => Decoder::QtfmGen2(qtfm_gen2::QtfmGen2::new(settings)?),
        };
        Ok(ScalarParser {
            decoder,
            field_range_pt: (libm::round(self.lowest_nt * 1e3) as i32)..=(libm::round(self.highest_nt * 1e3) as i32),
            signal_range: self.weakest_signal..=self.strongest_signal,
            line: Line::new(),
            faults: ScalarFaults::default(),
        })
    }
}

/// One sentence of the scalar sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Total field, picotesla. When `valid` is false it is what the sensor sent nonetheless, for the log.
    pub scalar_pt: i32,
    /// Signal strength in the sensor's own units, if the sentence carries it: A/D channel 0 of the G-882 (9999 is 5 V),
    /// `@` of the QTFM Gen-1, `s` (scalar sensitivity) of the Gen-2.
    pub signal: Option<u32>,
    /// The sensor's own count of sentences, if it sends one: `^` of the QTFM Gen-1, `@` of the Gen-2.
    pub counter: Option<u32>,
    /// Whether field and signal are within their limits and the sensor does not flag the reading itself.
    pub valid: bool,
    /// Timer at the sentence's first byte, microseconds.
    pub first_byte_us: u32,
    /// Timer at the byte that ended the sentence (carriage return, or line feed if that one was lost), microseconds.
    pub last_byte_us: u32,
}

#[derive(Clone, Copy, Debug)]
enum Decoder {
    G882,
    QtfmGen1(CountScale),
    QtfmGen2(qtfm_gen2::QtfmGen2),
}

impl Decoder {
    fn framing(&self) -> Framing {
        match self {
            Self::G882 => g882::FRAMING,
            Self::QtfmGen1(_) => qtfm_gen1::FRAMING,
            Self::QtfmGen2(_) => qtfm_gen2::FRAMING,
        }
    }

    fn decode(&self, text: &[u8]) -> Result<Decoded, Defect> {
        match self {
            Self::G882 => g882::decode(text),
            Self::QtfmGen1(scale) => qtfm_gen1::decode(*scale, text),
            Self::QtfmGen2(format) => format.decode(text),
        }
    }
}

/// Byte-wise parser of one scalar sensor, with its counters.
///
/// The start byte of a sentence begins one wherever it comes, so that after any rubbish the next whole sentence is read.
#[derive(Clone, Debug)]
pub struct ScalarParser {
    decoder: Decoder,
    field_range_pt: core::ops::RangeInclusive<i32>,
    signal_range: core::ops::RangeInclusive<u32>,
    line: Line,
    faults: ScalarFaults,
}

impl ScalarParser {
    /// One byte, received when the timer stood at `now_us`. A reading comes out with the byte that ends its sentence.
    pub fn push(&mut self, byte: u8, now_us: u32) -> Option<Reading> {
        if !self.line.push(byte, now_us, &self.decoder.framing(), &mut self.faults) {
            return None;
        }
        match self.decoder.decode(self.line.text()) {
            Ok(decoded) => Some(self.judge(decoded, now_us)),
            Err(Defect::Cut) => self.refuse(|faults| &mut faults.cut_lines),
            Err(Defect::BadNumber) => self.refuse(|faults| &mut faults.bad_number),
            Err(Defect::Malformed) => self.refuse(|faults| &mut faults.malformed),
        }
    }

    /// The receiver reports an error: count it, and give up the sentence that it falls into.
    pub fn receive_error(&mut self, kind: ErrorKind) {
        count(match kind {
            ErrorKind::Overrun => &mut self.faults.overruns,
            ErrorKind::FrameFormat => &mut self.faults.framing_errors,
            _ => &mut self.faults.other_receive_errors,
        });
        self.line.break_off(&mut self.faults);
    }

    /// What went wrong since the start.
    pub fn faults(&self) -> &ScalarFaults {
        &self.faults
    }

    fn refuse(&mut self, counter: impl FnOnce(&mut ScalarFaults) -> &mut u32) -> Option<Reading> {
        count(counter(&mut self.faults));
        None
    }

    /// Hold a decoded sentence against the limits; each that it breaks is counted.
    fn judge(&mut self, decoded: Decoded, now_us: u32) -> Reading {
        let Decoded { scalar_pt, signal, counter, marker } = decoded;
        let in_range = self.field_range_pt.contains(&scalar_pt);
        let strong = signal.is_none_or(|signal| self.signal_range.contains(&signal));
        let unflagged = marker == Marker::Valid;
        for (passed, counter) in [
            (in_range, &mut self.faults.out_of_range),
            (strong, &mut self.faults.signal_out_of_limits),
            (unflagged, &mut self.faults.flagged_invalid),
        ] {
            if !passed {
                count(counter);
            }
        }
        Reading {
            scalar_pt,
            signal,
            counter,
            valid: in_range && strong && unflagged,
            first_byte_us: self.line.first_byte_us(),
            last_byte_us: now_us,
        }
    }
}

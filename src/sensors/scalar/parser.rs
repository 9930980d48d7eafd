//! One sensor's bytes to its readings.

use super::faults::ScalarFaults;
use super::fields::{CHANNELS, Decoded, Defect, Marker};
use super::format::Sensor;
use super::line::Line;
use crate::sensors::count;
use core::ops::RangeInclusive;
use embedded_hal_nb::serial::ErrorKind;

/// One sentence of the scalar sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Total field, picotesla. When `valid` is false it is what the sensor sent nonetheless, for the log.
    pub scalar_pt: i32,
    /// Signal strength in the sensor's own units, if the sentence carries it.
    pub signal: Option<u32>,
    /// The sensor's own count of sentences, if it sends one.
    pub counter: Option<u32>,
    /// Analogue channels beyond the signal, raw, as far as the sentence carries them.
    pub channels: [Option<u16>; CHANNELS],
    /// Whether field and signal are within their limits and the sensor does not flag the reading itself.
    pub valid: bool,
    /// Timer at the sentence's first byte, microseconds.
    pub first_byte_us: u32,
    /// Timer at the byte that ended the sentence (carriage return, or line feed if that one was lost), microseconds.
    pub last_byte_us: u32,
}

/// Byte-wise parser of one scalar sensor, with its counters.
///
/// The start byte of a sentence begins one wherever it comes, so that after any rubbish the next whole sentence is read.
#[derive(Clone, Debug)]
pub struct ScalarParser {
    sensor: Sensor,
    field_range_pt: RangeInclusive<i32>,
    signal_range: RangeInclusive<u32>,
    line: Line,
    faults: ScalarFaults,
}

impl ScalarParser {
    pub(super) fn new(sensor: Sensor, field_range_pt: RangeInclusive<i32>, signal_range: RangeInclusive<u32>) -> Self {
        Self { sensor, field_range_pt, signal_range, line: Line::new(), faults: ScalarFaults::default() }
    }

    /// One byte, received when the timer stood at `now_us`. A reading comes out with the byte that ends its sentence.
    pub fn push(&mut self, byte: u8, now_us: u32) -> Option<Reading> {
        if !self.line.push(byte, now_us, self.sensor.framing(), &mut self.faults) {
            return None;
        }
        match self.sensor.decode(self.line.text()) {
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

    /// Whether a sentence is under way.
    pub fn is_in_sentence(&self) -> bool {
        self.line.is_in_sentence()
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
        let Decoded { scalar_pt, signal, counter, channels, marker } = decoded;
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
            channels,
            valid: in_range && strong && unflagged,
            first_byte_us: self.line.first_byte_us(),
            last_byte_us: now_us,
        }
    }
}

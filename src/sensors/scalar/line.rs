//! Cuts the byte stream into sentences.

use super::super::count;
use super::faults::{LONGEST_SENTENCE, ScalarFaults};

/// How a format's lines begin.
#[derive(Clone, Copy, Debug)]
pub struct Framing {
    /// First byte of a data sentence; it occurs nowhere else in one.
    pub start: u8,
    /// First bytes of lines that are no data but belong to the format: passed over without being counted.
    pub other_lines: &'static [u8],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    LineStart,
    OtherLine,
    Rubbish,
    Sentence,
}

/// The sentence under way.
#[derive(Clone, Debug)]
pub(super) struct Line {
    place: Place,
    text: [u8; LONGEST_SENTENCE],
    length: usize,
    first_byte_us: u32,
}

impl Line {
    pub(super) const fn new() -> Self {
        Self { place: Place::LineStart, text: [0; LONGEST_SENTENCE], length: 0, first_byte_us: 0 }
    }

    /// Text of the sentence, without start byte and line end.
    pub(super) fn text(&self) -> &[u8] {
        self.text.get(..self.length).unwrap_or(&[])
    }

    pub(super) fn is_in_sentence(&self) -> bool {
        self.place == Place::Sentence
    }

    pub(super) fn first_byte_us(&self) -> u32 {
        self.first_byte_us
    }

    /// One byte; true when it ends a sentence. Either line end will do, as the other may have been lost.
    pub(super) fn push(&mut self, byte: u8, now_us: u32, framing: &Framing, faults: &mut ScalarFaults) -> bool {
        if byte == framing.start {
            self.break_off(faults);
            *self = Self { place: Place::Sentence, first_byte_us: now_us, length: 0, text: self.text };
            return false;
        }
        match (self.place, byte) {
            (place, b'\r' | b'\n') => {
                self.place = Place::LineStart;
                return place == Place::Sentence;
            }
            (Place::Sentence, b' '..=b'~') => self.append(byte, faults),
            (Place::Sentence, _) => {
                count(&mut faults.rubbish_bytes);
                self.break_off(faults);
            }
            (Place::OtherLine, _) => {}
            (Place::LineStart, _) if framing.other_lines.contains(&byte) => self.place = Place::OtherLine,
            // Stray zeros come between lines: what follows them still stands at the start of one.
            (Place::LineStart, 0) => count(&mut faults.rubbish_bytes),
            (Place::LineStart | Place::Rubbish, _) => {
                count(&mut faults.rubbish_bytes);
                self.place = Place::Rubbish;
            }
        }
        false
    }

    /// Give up the sentence under way, if there is one; what is left of its line is rubbish.
    pub(super) fn break_off(&mut self, faults: &mut ScalarFaults) {
        if self.place == Place::Sentence {
            count(&mut faults.cut_lines);
            self.place = Place::Rubbish;
        }
    }

    fn append(&mut self, byte: u8, faults: &mut ScalarFaults) {
        match self.text.get_mut(self.length) {
            Some(end) => {
                *end = byte;
                self.length += 1;
            }
            None => {
                count(&mut faults.overlong);
                self.place = Place::Rubbish;
            }
        }
    }
}

//! What people and this program add to what the body tells: marks, contacts, alarms that were seen. All of it goes into the
//! files that are written, between the frames of the one and in a column of the other.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Write};

use towmag::link::text_frame;
use towmag_live::{Contact, Mark};

use crate::message::on_one_line;

/// How such a line of text begins: the body has none like it.
const OWN: &str = "ship: ";

/// How a mark begins behind that.
const MARK: &str = "mark ";

/// A mark as a line of text. Its time is that on the strip, s, in the last three digits what a person can hit.
pub(super) fn of_mark(mark: &Mark) -> String {
    format!("{OWN}{MARK}{:.3} {}", mark.time_s, on_one_line(&mark.label))
}

/// A contact as a line of text.
pub(super) fn of_contact(contact: &Contact) -> String {
    let Contact { number, time_s, peak_nt, width_s, snr, .. } = contact;
    format!("{OWN}contact {number} at {time_s:.1}: {peak_nt:+.2} nT, {width_s:.1} s wide, signal to noise {snr:.1}")
}

/// Anything else as a line of text.
pub(super) fn of_text(text: &str) -> String {
    format!("{OWN}{}", on_one_line(text))
}

/// Whether a line of text is no word of the body.
pub(super) fn is_own(text: &str) -> bool {
    text.starts_with(OWN)
}

/// The mark that a line of text is, if it is one: how long before the latest epoch it was is not known of a recording,
/// so its time is what was written.
pub(super) fn mark_of(text: &str) -> Option<Mark> {
    let (time_s, label) = text.strip_prefix(OWN)?.strip_prefix(MARK)?.split_once(' ')?;
    let time_s: f64 = time_s.parse().ok()?;
    time_s.is_finite().then(|| Mark { time_s, label: label.trim().into() })
}

/// The bytes of the cable as they come, and notes between its frames.
pub(super) struct Record<W: Write = File> {
    writer: W,
    /// Whether a frame has just ended, or none has begun.
    is_between: bool,
    notes: VecDeque<String>,
}

impl<W: Write> Record<W> {
    pub(super) fn new(writer: W) -> Self {
        Self { writer, is_between: true, notes: VecDeque::new() }
    }

    /// Keep a note, as soon as no frame is cut by it.
    pub(super) fn note(&mut self, note: &str) -> io::Result<()> {
        self.notes.push_back(note.into());
        if self.is_between { self.write_notes() } else { Ok(()) }
    }

    /// Keep what came.
    pub(super) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let end = bytes.iter().position(|&byte| byte == 0).map_or(0, |zero| zero + 1);
        let (first, rest) = if self.notes.is_empty() { (&[][..], bytes) } else { bytes.split_at(end) };
        if !first.is_empty() {
            self.writer.write_all(first)?;
            self.write_notes()?;
        }
        self.writer.write_all(rest)?;
        if let Some(last) = bytes.last() {
            self.is_between = *last == 0;
        }
        Ok(())
    }

    /// The end: what waits for a frame to end waits no longer.
    pub(super) fn finish(&mut self) -> io::Result<()> {
        self.write_notes()
    }

    fn write_notes(&mut self) -> io::Result<()> {
        for note in self.notes.drain(..) {
            self.writer.write_all(&text_frame(&note))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use towmag::link::{FrameKind, FrameReader};

    /// The texts in some bytes, and how many frames are damaged.
    fn texts(bytes: &[u8]) -> (Vec<String>, u32) {
        let (mut reader, mut texts) = (FrameReader::default(), Vec::new());
        for &byte in bytes {
            if let Some(received) = reader.push(byte).filter(|received| received.kind == FrameKind::Text) {
                texts.push(String::from_utf8(received.body.to_vec()).unwrap());
            }
        }
        (texts, reader.counters().bad)
    }

    #[test]
    fn notes_cut_no_frame_however_the_bytes_come() {
        let wire: Vec<u8> = (0..20).flat_map(|k| text_frame(&format!("answer {k}"))).collect();
        for step in 1..40 {
            let mut record = Record::new(Vec::new());
            for (count, bytes) in wire.chunks(step).enumerate() {
                if count % 7 == 3 {
                    record.note(&of_text(&count.to_string())).unwrap();
                }
                record.write(bytes).unwrap();
            }
            record.note("the last").unwrap();
            record.finish().unwrap();
            let (texts, bad) = texts(&record.writer);
            let notes = wire.chunks(step).count().div_ceil(7).saturating_sub(1)
                + usize::from(wire.chunks(step).count() % 7 > 3 || wire.chunks(step).count() % 7 == 0);
            assert_eq!((texts.iter().filter(|text| text.starts_with("answer")).count(), bad), (20, 0), "{step}");
            assert_eq!(texts.iter().filter(|text| is_own(text)).count(), notes, "{step}");
            assert_eq!(texts.last().map(String::as_str), Some("the last"));
            let rest: Vec<u8> =
                texts.iter().filter(|text| text.starts_with("answer")).flat_map(|text| text_frame(text)).collect();
            assert_eq!(rest, wire, "what came is there, byte for byte");
        }
    }

    #[test]
    fn a_mark_comes_back() {
        let mark = Mark { time_s: 1_767_225_600.125, label: "wreck\u{e4}".into() };
        assert_eq!(mark_of(&of_mark(&mark)), Some(Mark { label: on_one_line(&mark.label).to_string(), ..mark }));
        let none = Mark { time_s: 3.0, label: String::new() };
        assert_eq!(mark_of(&of_mark(&none)), Some(none));
        for text in ["mark 3 a", "ship: mark x a", "ship: mark inf a", "ship: contact 3"] {
            assert_eq!(mark_of(text), None);
        }
    }
}

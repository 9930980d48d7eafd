//! Bytes from the ship to commands, whatever comes.

use super::command::{Command, CommandError, LONGEST_LINE, parse};
use super::numbered::unpack;

/// What a finished line was.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    /// A command.
    Command(Command),
    /// Text, but no command; to be answered with its display.
    Refused(CommandError),
    /// A line with a [number](super::numbered()), whole: to be acknowledged, and done unless it was the last one.
    Numbered {
        /// Its number.
        number: u16,
        /// What it says.
        command: Result<Command, CommandError>,
    },
    /// A line that was dropped; to be answered with its display. Comes once, then not again before the next line of
    /// text: noise on the cable must not fill it with answers.
    Dropped(Dropped),
}

/// Why a line was dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dropped {
    /// Longer than [`LONGEST_LINE`].
    Overlong,
    /// It holds bytes that nobody types, or the receiver reported an error in it.
    Damaged,
}

impl core::fmt::Display for Dropped {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Overlong => write!(f, "error: line longer than {LONGEST_LINE} characters dropped: type help"),
            Self::Damaged => f.write_str("error: damaged line dropped: type it again"),
        }
    }
}

/// What came in since the start. Full counters stay full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConsoleCounters {
    /// Commands.
    pub commands: u32,
    /// Lines of text that are no command.
    pub refused: u32,
    /// Lines dropped because they were overlong.
    pub overlong: u32,
    /// Lines dropped because they were damaged.
    pub damaged: u32,
    /// Errors that the receiver reported.
    pub receive_errors: u32,
}

/// Takes the console's bytes one by one. Lines end with a carriage return, a line feed or both; empty ones are nothing.
/// Backspace and delete take back a character, Ctrl-U and Ctrl-C the line.
#[derive(Clone, Debug, Default)]
pub struct LineReader {
    text: heapless::Vec<u8, LONGEST_LINE>,
    /// Why the line under way is lost.
    lost: Option<Dropped>,
    /// A dropped line was reported, and nothing readable came since.
    reported: bool,
    counters: ConsoleCounters,
}

impl LineReader {
    /// One byte. Something comes out with the byte that ends a line.
    pub fn push(&mut self, byte: u8) -> Option<Input> {
        match byte {
            b'\r' | b'\n' => return self.finish(),
            0x08 | 0x7f => {
                self.text.pop();
            }
            0x03 | 0x15 => {
                self.text.clear();
                self.lost = None;
            }
            b'\t' | b' '..=b'~' => {
                if self.text.push(byte).is_err() {
                    self.lost.get_or_insert(Dropped::Overlong);
                }
            }
            _ => {
                self.lost.get_or_insert(Dropped::Damaged);
            }
        }
        None
    }

    /// The receiver reports an error: the line that it falls into is lost.
    pub fn receive_error(&mut self) {
        count(&mut self.counters.receive_errors);
        self.lost.get_or_insert(Dropped::Damaged);
    }

    /// What came in since the start.
    pub fn counters(&self) -> ConsoleCounters {
        self.counters
    }

    fn finish(&mut self) -> Option<Input> {
        let text = core::mem::take(&mut self.text);
        if let Some(dropped) = self.lost.take() {
            return self.drop_line(dropped);
        }
        // Nothing but ASCII was let in.
        let line = core::str::from_utf8(&text).unwrap_or_default().trim_ascii();
        if line.is_empty() {
            return None;
        }
        match line.strip_prefix('#').map(unpack) {
            Some(None) => self.drop_line(Dropped::Damaged),
            // No command has an asterisk: it is the end of a numbered line, of which a byte became the key that clears a line.
            None if line.bytes().any(|byte| byte == b'*') => self.drop_line(Dropped::Damaged),
            Some(Some((number, command))) => Some(Input::Numbered { number, command: self.parse(command) }),
            None => Some(self.parse(line).map_or_else(Input::Refused, Input::Command)),
        }
    }

    fn parse(&mut self, line: &str) -> Result<Command, CommandError> {
        self.reported = false;
        let command = parse(line);
        count(if command.is_ok() { &mut self.counters.commands } else { &mut self.counters.refused });
        command
    }

    fn drop_line(&mut self, dropped: Dropped) -> Option<Input> {
        count(match dropped {
            Dropped::Overlong => &mut self.counters.overlong,
            Dropped::Damaged => &mut self.counters.damaged,
        });
        let first = !core::mem::replace(&mut self.reported, true);
        first.then_some(Input::Dropped(dropped))
    }
}

fn count(counter: &mut u32) {
    *counter = counter.saturating_add(1);
}

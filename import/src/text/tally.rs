//! How often something was met.

use crate::source::{FindingKind, Note};

/// No more of a cell is repeated to the user, characters.
const SHOWN: usize = 20;

/// How often something was met, and on which line first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    count: usize,
    first: u32,
    /// What was met first; empty where the line says it all.
    example: String,
}

impl Tally {
    /// Once more.
    pub(crate) fn add(&mut self, line: u32) {
        if self.count == 0 {
            self.first = line;
        }
        self.count += 1;
    }

    /// Once more, with what stood there.
    pub(super) fn add_cell(&mut self, line: u32, cell: &str) {
        if self.count == 0 {
            self.example = cell.chars().take(SHOWN).collect();
        }
        self.add(line);
    }

    /// How often.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// A sentence from what one is and what several are, if there was any: `3 cells are no numbers ...: first "x" in line 7`.
    pub(crate) fn note(&self, kind: FindingKind, one: &str, several: &str) -> Option<Note> {
        let (what, first) = if self.count == 1 { (one, "") } else { (several, "first ") };
        let example = if self.example.is_empty() { String::new() } else { format!("\"{}\" ", self.example) };
        let text = format!("{} {what}: {first}{example}in line {}", self.count, self.first);
        (self.count > 0).then_some(Note { kind, text })
    }
}

//! What an import has found out, and the option that would have it otherwise.

use serde::Serialize;

use crate::source::{FindingKind, Note};

/// One thing that was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Which sort.
    pub kind: FindingKind,
    /// One sentence.
    pub text: String,
    /// The option that mends it or has it otherwise.
    pub option: Option<String>,
    /// Whether something may be wrong; else it only tells what was done.
    #[serde(skip)]
    pub is_warning: bool,
}

impl Finding {
    /// Something that was done.
    pub fn new(kind: FindingKind, text: impl Into<String>) -> Self {
        Self { kind, text: text.into(), option: None, is_warning: false }
    }

    /// Something that may be wrong.
    pub fn warning(kind: FindingKind, text: impl Into<String>) -> Self {
        Self { is_warning: true, ..Self::new(kind, text) }
    }

    /// The same with the option.
    pub fn with(self, option: impl Into<String>) -> Self {
        Self { option: Some(option.into()), ..self }
    }
}

impl From<Note> for Finding {
    fn from(note: Note) -> Self {
        Self::new(note.kind, note.text)
    }
}

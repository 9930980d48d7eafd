//! What is wrong with a file.

/// What is wrong with a file, in a sentence that says where and what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: line {line}: {reason}")]
pub struct EffectFileError {
    /// The file as the user named it.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub reason: String,
}

/// The same without the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Wrong {
    /// Where in the text, byte.
    pub(crate) at: usize,
    pub(crate) reason: String,
}

impl Wrong {
    pub(crate) fn new(at: usize, reason: impl Into<String>) -> Self {
        Self { at, reason: reason.into() }
    }

    pub(crate) fn in_file(self, text: &str, file: &str) -> EffectFileError {
        let line = line_of(text, self.at);
        // One line, and nothing that a terminal takes for an order.
        let reason = self.reason.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        EffectFileError { file: file.into(), line, reason }
    }
}

/// The line of a byte, from 1.
fn line_of(text: &str, at: usize) -> usize {
    text.as_bytes()[..at.min(text.len())].iter().filter(|&&byte| byte == b'\n').count() + 1
}

/// What a user wrote, for a message: quoted, and not longer than a message should be.
pub(crate) fn quoted(text: &str) -> String {
    let short: String = text.chars().take(40).collect();
    let more = if text.chars().nth(40).is_some() { "..." } else { "" };
    format!("{:?}", format!("{short}{more}"))
}

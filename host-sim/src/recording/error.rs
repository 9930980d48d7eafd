//! What can be wrong with a recording, told in one line that names file, line and column.

use std::io;

/// Why a recording cannot be read on.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The operating system does not give the file's bytes.
    #[error("{}: cannot be read: {source}", on_one_line(path))]
    Io {
        /// The file as the user named it.
        path: String,
        /// The system's own words.
        source: io::Error,
    },
    /// The bytes are there, but are no recording.
    #[error("{}:{line}: {}{what}", on_one_line(file), in_front(column))]
    Bad {
        /// The file as the user named it.
        file: String,
        /// Physical line in the file, from 1.
        line: u64,
        /// Column, or columns, at fault; `None` when the line as a whole is.
        column: Option<String>,
        /// What is wrong and what is expected.
        what: String,
    },
}

impl RecordingError {
    /// Whether what the user gave is at fault (exit code 2) and not the machine (exit code 1).
    /// A file that is not there, is a directory or may not be read is the user's too.
    pub fn is_bad_input(&self) -> bool {
        use io::ErrorKind::{IsADirectory, NotADirectory, NotFound, PermissionDenied};
        match self {
            Self::Io { source, .. } => {
                matches!(source.kind(), NotFound | IsADirectory | NotADirectory | PermissionDenied)
            }
            Self::Bad { .. } => true,
        }
    }
}

/// What is wrong, before it is known in which file and line.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) column: Option<String>,
    pub(super) what: String,
}

impl Fault {
    pub(super) fn of(column: &[u8], what: String) -> Self {
        Self { column: Some(shortened(column, LONGEST_VALUE)), what }
    }
}

fn in_front(column: &Option<String>) -> String {
    column.as_ref().map(|column| format!("{column}: ")).unwrap_or_default()
}

/// File names may hold line breaks; the message may not.
fn on_one_line(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { c.escape_default().to_string() } else { c.to_string() }).collect()
}

/// Longest rendering of a value, in characters of the escaped text between the quotation marks.
const LONGEST_VALUE: usize = 32;

/// A field for a message: in quotation marks, on one line, never longer than a reader wants to read.
pub(super) fn quoted(field: &[u8]) -> String {
    format!("\"{}\"", shortened(field, LONGEST_VALUE))
}

/// At most `longest` characters of the escaped text, with dots in place of the rest.
pub(super) fn shortened(text: &[u8], longest: usize) -> String {
    // A character has at most four bytes, and a broken one is replaced byte by byte: this much always suffices.
    let start = String::from_utf8_lossy(&text[..text.len().min(4 * longest + 4)]);
    let mut rendered = String::new();
    let mut length = 0;
    for character in start.chars() {
        let escaped: String = character.escape_debug().collect();
        length += escaped.chars().count();
        if length > longest {
            rendered.push_str("...");
            break;
        }
        rendered.push_str(&escaped);
    }
    rendered
}

/// A number for a message: as a person writes it, or in powers of ten when that would be a line of zeros.
pub(super) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 || (1e-6..1e15).contains(&magnitude) { format!("{value}") } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_stays_short_and_on_one_line() {
        assert_eq!(quoted(b"5o123.4"), "\"5o123.4\"");
        assert_eq!(quoted(b"a\0\nb"), r#""a\0\nb""#);
        for bytes in [&[0xff; 1000][..], &[0; 1000], "\u{1F980}".repeat(500).as_bytes(), b"9".repeat(41).as_slice()] {
            let text = quoted(bytes);
            assert!(text.chars().count() <= 40 && text.ends_with("...\"") && !text.contains('\n'), "{text}");
        }
    }

    #[test]
    fn numbers_stay_short() {
        for (value, text) in [(12.3, "12.3"), (0.0, "0"), (-1e300, "-1e300"), (1e-300, "1e-300"), (1.7e9, "1700000000")]
        {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn a_file_name_with_a_line_break_stays_on_one_line() {
        let what = "has no rows".to_string();
        let error = RecordingError::Bad { file: "a\nb.csv".into(), line: 1, column: None, what };
        assert_eq!(error.to_string(), "a\\nb.csv:1: has no rows");
    }
}

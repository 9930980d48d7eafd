//! Foreign text in messages: on one line, and never longer than a reader wants to read.

use std::path::Path;

/// The file name without its folders, for what is shown.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// File names may hold line breaks; the message may not.
pub(crate) fn on_one_line(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { c.escape_default().to_string() } else { c.to_string() }).collect()
}

/// Longest rendering of a value, in characters of the escaped text between the quotation marks.
pub(crate) const LONGEST_VALUE: usize = 32;

/// A field for a message: in quotation marks, on one line, never longer than a reader wants to read.
pub(crate) fn quoted(field: &[u8]) -> String {
    format!("\"{}\"", shortened(field, LONGEST_VALUE))
}

/// At most `longest` characters of the escaped text, with dots in place of the rest.
pub(crate) fn shortened(text: &[u8], longest: usize) -> String {
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
pub(crate) fn number(value: f64) -> String {
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
    fn names_stay_on_one_line() {
        assert_eq!(on_one_line("a\nb.csv"), "a\\nb.csv");
    }
}

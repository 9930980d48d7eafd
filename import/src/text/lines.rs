//! Lines of text, and the fields of a line.

use super::dialect::Delimiter;

/// A line and where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Line<'a> {
    /// From 1.
    pub(super) number: u64,
    /// Where it begins, bytes.
    pub(super) offset: usize,
    /// Without its end.
    pub(super) text: &'a str,
    /// Whether it has an end: only the last may lack one.
    pub(super) is_ended: bool,
}

/// The lines of a text: ended by `\n`, `\r\n` or `\r`.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let (mut offset, mut number) = (0, 0);
    std::iter::from_fn(move || {
        let rest = text.get(offset..).filter(|rest| !rest.is_empty())?;
        let end = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let after = match rest.as_bytes().get(end..) {
            Some([b'\r', b'\n', ..]) => 2,
            Some([_, ..]) => 1,
            _ => 0,
        };
        number += 1;
        let line = Line { number, offset, text: &rest[..end], is_ended: after > 0 };
        offset += end + after;
        Some(line)
    })
}

/// The fields of a line, trimmed, quotes taken off.
pub(super) fn fields(line: &str, delimiter: Delimiter) -> Vec<&str> {
    match delimiter {
        Delimiter::Blanks => line.split_whitespace().map(unquoted).collect(),
        Delimiter::Byte(byte) => split_quoted(line, byte),
    }
}

fn split_quoted(line: &str, delimiter: u8) -> Vec<&str> {
    let (mut fields, mut begin, mut quoted) = (Vec::new(), 0, false);
    for (at, byte) in line.bytes().enumerate() {
        if byte == b'"' {
            quoted = !quoted;
        } else if byte == delimiter && !quoted {
            fields.push(unquoted(&line[begin..at]));
            begin = at + 1;
        }
    }
    fields.push(unquoted(&line[begin..]));
    fields
}

fn unquoted(field: &str) -> &str {
    let field = field.trim();
    field.strip_prefix('"').and_then(|field| field.strip_suffix('"')).map_or(field, str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_three_ways() {
        let found: Vec<_> = lines("a\r\nb\rc\n\nd").map(|line| (line.number, line.text, line.is_ended)).collect();
        assert_eq!(found, [(1, "a", true), (2, "b", true), (3, "c", true), (4, "", true), (5, "d", false)]);
        assert!(lines("a\r\nb\rc").all(|line| &"a\r\nb\rc"[line.offset..][..1] == line.text));
    }

    #[test]
    fn a_delimiter_in_quotes_is_none() {
        assert_eq!(fields("1, \"a,b\" ,3,", Delimiter::Byte(b',')), ["1", "a,b", "3", ""]);
        assert_eq!(fields("  1   2\t3 ", Delimiter::Blanks), ["1", "2", "3"]);
    }
}

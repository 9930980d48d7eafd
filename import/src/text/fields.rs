//! The fields of a line.

use super::signs::Delimiter;

/// The fields of a line, trimmed, quotes taken off.
pub(super) fn fields(line: &str, delimiter: Delimiter) -> Vec<&str> {
    match delimiter {
        Delimiter::Blanks => Fields { rest: line.trim(), may_be_commas: false, is_owed: false }.collect(),
        Delimiter::Byte(byte) => split_quoted(line, byte),
    }
}

/// Fields between blanks, with at most one comma among them: two commas have an empty field between them. A field in
/// quotes may hold both.
pub(crate) fn loose_fields(line: &str) -> Fields<'_> {
    Fields { rest: line.trim(), may_be_commas: true, is_owed: false }
}

/// Fields between blanks: see [`loose_fields`].
#[derive(Clone, Debug)]
pub(crate) struct Fields<'a> {
    rest: &'a str,
    may_be_commas: bool,
    /// A comma was the last that was seen: a field follows it, be it empty.
    is_owed: bool,
}

impl<'a> Iterator for Fields<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        if self.rest.is_empty() {
            return std::mem::take(&mut self.is_owed).then_some("");
        }
        let comma = self.may_be_commas;
        let (field, rest) = match self.rest.strip_prefix('"').and_then(|inner| inner.split_once('"')) {
            Some((quoted, rest)) => (quoted.trim(), rest),
            None => {
                let ends = |c: char| c.is_whitespace() || (comma && c == ',');
                self.rest.split_at(self.rest.find(ends).unwrap_or(self.rest.len()))
            }
        };
        let rest = rest.trim_start();
        self.is_owed = comma && rest.starts_with(',');
        self.rest = if self.is_owed { rest[1..].trim_start() } else { rest };
        Some(field)
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

/// Without the blanks around it. Most fields have none, and that is seen at once.
#[inline]
pub(super) fn trimmed(field: &str) -> &str {
    match field.as_bytes() {
        [first, .., last] if first.is_ascii_graphic() && last.is_ascii_graphic() => field,
        _ => field.trim(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_delimiter_in_quotes_is_none() {
        assert_eq!(fields("1, \"a,b\" ,3,", Delimiter::Byte(b',')), ["1", "a,b", "3", ""]);
        assert_eq!(fields("  1   2\t3 ", Delimiter::Blanks), ["1", "2", "3"]);
        assert_eq!(fields("0,5 \"leg 1\" 51000,5", Delimiter::Blanks), ["0,5", "leg 1", "51000,5"]);
    }

    #[test]
    fn loose_fields_are_between_blanks_or_commas() {
        let split = |line| loose_fields(line).collect::<Vec<_>>();
        assert_eq!(split("  1 \t-2.5   * "), ["1", "-2.5", "*"]);
        assert_eq!(split("1,2 , 3"), ["1", "2", "3"]);
        assert_eq!(split("1,,3,"), ["1", "", "3", ""]);
        assert_eq!(split("\"a, b\" 2"), ["a, b", "2"]);
        assert_eq!(split(" "), [""; 0]);
    }
}

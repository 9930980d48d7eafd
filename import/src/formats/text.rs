//! Text of any encoding in lines and fields.

use std::borrow::Cow;

use crate::text::decode;

/// A line without its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Line<'a> {
    /// From 1.
    pub(super) number: u32,
    /// Without the end of the line.
    pub(super) text: &'a str,
    /// Whether an end followed; only a file's last line may have none.
    pub(super) is_ended: bool,
}

/// The text of a file, whatever its encoding.
pub(super) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    // No encoding is asked for: one is always found.
    decode(bytes, None).map(|decoded| decoded.text).unwrap_or_default()
}

/// All lines, blank ones too: ended by `\n`, by `\r\n`, or by `\r` alone where no `\n` is in the text.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> + Clone {
    let end = if text.contains('\n') { '\n' } else { '\r' };
    text.split_inclusive(end).zip(1_u32..).map(move |(line, number)| Line {
        number,
        text: line.trim_end_matches(['\n', '\r', '\u{1a}']),
        is_ended: line.ends_with(end),
    })
}

/// Fields between blanks, with at most one comma among them: two commas have an empty field between them. A field in
/// quotes may hold both.
pub(super) fn fields(line: &str) -> Fields<'_> {
    Fields { rest: line.trim(), is_owed: false }
}

/// See [`fields`].
#[derive(Clone, Debug)]
pub(super) struct Fields<'a> {
    rest: &'a str,
    /// A comma was the last that was seen: a field follows it, be it empty.
    is_owed: bool,
}

impl<'a> Iterator for Fields<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        if self.rest.is_empty() {
            return std::mem::take(&mut self.is_owed).then_some("");
        }
        let (field, rest) = match self.rest.strip_prefix('"').and_then(|inner| inner.split_once('"')) {
            Some(quoted) => quoted,
            None => self.rest.split_at(self.rest.find([' ', '\t', ',']).unwrap_or(self.rest.len())),
        };
        let rest = rest.trim_start();
        self.is_owed = rest.starts_with(',');
        self.rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
        Some(field)
    }
}

/// A finite number; Fortran's exponents `1.5D+03` too.
pub(super) fn number(field: &str) -> Option<f64> {
    let field = field.trim();
    let parsed = fast_float2::parse::<f64, _>(field).ok().or_else(|| {
        let has_exponent = field.len() < 40 && field.contains(['D', 'd']);
        has_exponent.then(|| fast_float2::parse::<f64, _>(field.replace(['D', 'd'], "E")).ok()).flatten()
    });
    parsed.filter(|value| value.is_finite())
}

/// `MAG[nT]` and `latitude(deg)` in name and unit. `EM[0]` is an element of an array.
pub(super) fn name_and_unit(field: &str) -> (&str, Option<&str>) {
    let field = field.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, unit)) = field.strip_suffix(close).and_then(|head| head.split_once(open))
            && !name.trim().is_empty()
            && number(unit).is_none()
        {
            return (name.trim(), Some(unit.trim()).filter(|unit| !unit.is_empty()));
        }
    }
    (field, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_three_ways() {
        for text in ["a\n\nb", "a\r\n\r\nb", "a\r\rb"] {
            let found: Vec<_> = lines(text).map(|line| (line.number, line.text, line.is_ended)).collect();
            assert_eq!(found, [(1, "a", true), (2, "", true), (3, "b", false)]);
        }
    }

    #[test]
    fn fields_are_between_blanks_or_commas() {
        let split = |line| fields(line).collect::<Vec<_>>();
        assert_eq!(split("  1 \t-2.5   * "), ["1", "-2.5", "*"]);
        assert_eq!(split("1,2 , 3"), ["1", "2", "3"]);
        assert_eq!(split("1,,3,"), ["1", "", "3", ""]);
        assert_eq!(split("\"a, b\" 2"), ["a, b", "2"]);
        assert_eq!(split(" "), [""; 0]);
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(["1.5", " -2e3 ", "+4", "1.5D+03"].map(number), [Some(1.5), Some(-2000.0), Some(4.0), Some(1500.0)]);
        assert_eq!(["", "*", "1.5x", "inf", "nan", "1e999"].map(number), [None; 6]);
    }

    #[test]
    fn units_stand_in_brackets() {
        assert_eq!(name_and_unit(" Mag [nT]"), ("Mag", Some("nT")));
        assert_eq!(name_and_unit("latitude(deg)"), ("latitude", Some("deg")));
        assert_eq!(name_and_unit("(nT)"), ("(nT)", None));
        assert_eq!(name_and_unit("EM[0]"), ("EM[0]", None));
        assert_eq!(name_and_unit("fid"), ("fid", None));
    }
}

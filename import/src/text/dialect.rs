//! How a text parts its fields, found from its first lines.

use super::cell::{is_missing, parse_number};
use super::comment::is_comment;
use super::fields::fields;
use super::header;
use super::lines::{Line, lines};
use super::signs::{Decimal, Delimiter};
use crate::stamp::looks_like_a_stamp;

/// So many lines are looked at.
const LINES: usize = 600;
/// A line is one of data when so large a part of its fields that are not empty are numbers, stamps or missing.
const DATA_SHARE: f64 = 0.6;

/// How a text is to be read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Dialect {
    /// What parts the fields.
    pub delimiter: Delimiter,
    /// What stands before the decimals.
    pub decimal: Decimal,
    /// Names of the columns, with their units if they stand there; empty without a header.
    pub names: Vec<String>,
    /// A unit a column, from a row of units; empty without one.
    pub units: Vec<String>,
    /// The line of the names, from 1; 0 without a header.
    pub header_line: u32,
    /// The first line of data, from 1.
    pub data_line: u32,
    /// Where it begins, bytes.
    pub(super) data_offset: usize,
    /// Lines before the header, for what they may tell: rate, date, instrument.
    pub preamble: Vec<String>,
    /// Fields of most lines of data.
    pub width: usize,
}

impl Dialect {
    /// The dialect of a text; `None` when it has no table of numbers. What is asked for is not looked for.
    pub(crate) fn of(text: &str, delimiter: Option<Delimiter>, decimal: Option<Decimal>) -> Option<Self> {
        let first: Vec<Line<'_>> = lines(text).take(LINES).collect();
        let delimiters =
            Delimiter::ALL.into_iter().filter(|candidate| delimiter.is_none_or(|asked| asked == *candidate));
        let mut best: Option<(f64, Delimiter, Decimal, usize)> = None;
        for delimiter in delimiters {
            for candidate in [Decimal::Point, Decimal::Comma] {
                let clash = candidate == Decimal::Comma && delimiter == Delimiter::Byte(b',');
                if clash || decimal.is_some_and(|asked| asked != candidate) {
                    continue;
                }
                if let Some((score, begin)) = score(&first, delimiter, candidate)
                    && best.is_none_or(|(highest, ..)| score > highest)
                {
                    best = Some((score, delimiter, candidate, begin));
                }
            }
        }
        let (_, delimiter, decimal, begin) = best?;
        Some(Self::from_block(&first, delimiter, decimal, begin))
    }

    fn from_block(first: &[Line<'_>], delimiter: Delimiter, decimal: Decimal, begin: usize) -> Self {
        let width = usual_width(&first[begin..], delimiter);
        let found = header::find(&first[..begin], delimiter, width);
        Self {
            delimiter,
            decimal,
            names: found.names,
            units: found.units,
            header_line: found.line,
            data_line: first[begin].number,
            data_offset: first[begin].offset,
            preamble: first[..found.preamble].iter().map(|line| line.text.trim().to_string()).collect(),
            width,
        }
    }

    /// Whether a line of the data is one.
    pub(super) fn is_data(&self, line: &str) -> bool {
        share_of_data(&fields(line, self.delimiter), self.decimal) >= DATA_SHARE
    }
}

/// How well a table of numbers comes out, and at which line it begins: numbers count, and fields that are none count
/// against it.
fn score(lines: &[Line<'_>], delimiter: Delimiter, decimal: Decimal) -> Option<(f64, usize)> {
    let mut begin = None;
    let (mut good, mut bad) = (0.0, 0.0);
    for (at, line) in lines.iter().enumerate() {
        if line.text.trim().is_empty() || is_comment(line.text) {
            continue;
        }
        let fields = fields(line.text, delimiter);
        let share = share_of_data(&fields, decimal);
        if fields.len() >= 2 && share >= DATA_SHARE {
            begin.get_or_insert(at);
            let there = fields.iter().filter(|field| !field.is_empty()).count() as f64;
            good += there * share;
            bad += there * (1.0 - share);
        } else if begin.is_some() {
            bad += fields.len() as f64;
        }
    }
    Some((good - 2.0 * bad, begin?)).filter(|(score, _)| *score > 0.0)
}

/// The part of the fields that are there which are numbers, stamps or stand for missing; at least one must be a number.
fn share_of_data(fields: &[&str], decimal: Decimal) -> f64 {
    let (mut there, mut data, mut numbers) = (0_usize, 0_usize, 0_usize);
    for field in fields.iter().filter(|field| !field.is_empty()) {
        there += 1;
        let is_number = parse_number(field, decimal).is_some();
        numbers += usize::from(is_number);
        data += usize::from(is_number || is_missing(field) || looks_like_a_stamp(field));
    }
    if numbers == 0 { 0.0 } else { data as f64 / there as f64 }
}

/// The number of fields that most lines have.
fn usual_width(lines: &[Line<'_>], delimiter: Delimiter) -> usize {
    let mut widths: Vec<usize> = lines
        .iter()
        .filter(|line| line.is_ended && !line.text.trim().is_empty() && !is_comment(line.text))
        .map(|line| fields(line.text, delimiter).len())
        .collect();
    widths.sort_unstable();
    widths.get(widths.len() / 2).copied().unwrap_or_else(|| fields(lines[0].text, delimiter).len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Dialect {
        Dialect::of(text, None, None).unwrap()
    }

    #[test]
    fn delimiter_and_decimal_sign_are_found_together() {
        for (text, delimiter, decimal) in [
            ("time,mag\n0.0,51000.5\n0.1,51000.6\n", "comma", Decimal::Point),
            ("time;mag\n0,0;51000,5\n0,1;51000,6\n", "semicolon", Decimal::Comma),
            ("time\tmag\n0,0\t51000,5\n0,1\t51000,6\n", "tab", Decimal::Comma),
            ("time mag\n0.0   51000.5\n0.1  51000.6\n", "blanks", Decimal::Point),
            ("0,0 51000,5\n0,1 51000,6\n", "blanks", Decimal::Comma),
            ("a|b\n1|2.5\n2|3.5\n", "bar", Decimal::Point),
            (
                "date;time;mag\n22.11.2026;10:00:00,1;51000,5\n22.11.2026;10:00:00,2;51000,6\n",
                "semicolon",
                Decimal::Comma,
            ),
        ] {
            let dialect = of(text);
            assert_eq!((dialect.delimiter.name(), dialect.decimal), (delimiter, decimal), "{text}");
        }
    }

    #[test]
    fn names_units_and_what_stands_before_them() {
        let dialect = of("Survey 12\nRate: 10 Hz\n\ntime;mag;depth\ns;nT;m\n0,0;51000,5;3,1\n0,1;51000,6;3,2\n");
        assert_eq!((dialect.names.join("|"), dialect.units.join("|")), ("time|mag|depth".into(), "s|nT|m".into()));
        assert_eq!((dialect.header_line, dialect.data_line), (4, 6));
        assert_eq!(dialect.preamble, ["Survey 12", "Rate: 10 Hz", ""]);
    }

    #[test]
    fn a_comment_may_hold_the_names() {
        let dialect = of("# made by x\n# time mag\n0.0 51000.5\n0.1 51000.6\n");
        assert_eq!((dialect.names.join("|"), dialect.header_line), ("time|mag".into(), 2));
        assert_eq!(of("0.0 51000.5\n0.1 51000.6\n").header_line, 0);
    }

    #[test]
    fn prose_is_no_table() {
        assert_eq!(Dialect::of("Dear all,\nplease find the data elsewhere.\n", None, None), None);
        assert_eq!(Dialect::of("", None, None), None);
    }
}

//! The sorts of lines that a Geosoft XYZ file has.

use crate::text::{loose_fields, number};

/// A line of such a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Record<'a> {
    /// Nothing.
    Blank,
    /// After `/`.
    Comment(&'a str),
    /// `//flight 12`, which holds until the next.
    Flight(&'a str),
    /// `//date 2020/01/31`, which holds until the next.
    Date(&'a str),
    /// `Line 101`, `Tie 5`, `L101:2`: what the rows after it belong to, with a letter but for the word `Line`.
    Line(String),
    /// Anything else.
    Row(&'a str),
}

/// The types of lines of Oasis montaj with the letters that stand for them in its names.
/// <https://help.seequent.com/Oasismontaj/2024.2/Content/ss/glossary/xyz_data.htm>
const TYPES: [(&str, &str); 7] =
    [("line", ""), ("tie", "T"), ("random", "D"), ("base", "B"), ("test", "S"), ("trend", "R"), ("special", "P")];

/// What a line is.
pub(super) fn record(line: &str) -> Record<'_> {
    let line = line.trim();
    if let Some(rest) = line.strip_prefix("//") {
        return directive(rest).unwrap_or(Record::Comment(rest));
    }
    if let Some(rest) = line.strip_prefix('/') {
        return Record::Comment(rest.trim());
    }
    match label(line) {
        _ if line.is_empty() => Record::Blank,
        Some(label) => Record::Line(label),
        None => Record::Row(line),
    }
}

/// Whether a line can be a row: most of its fields are numbers or missing.
pub(super) fn is_row(line: &str) -> bool {
    let (mut numbers, mut words) = (0, 0);
    for field in loose_fields(line) {
        if number(field).is_some() || field == "*" {
            numbers += 1;
        } else if !field.is_empty() {
            words += 1;
        }
    }
    numbers > words
}

fn directive(rest: &str) -> Option<Record<'_>> {
    let (word, value) = rest.trim().split_once([' ', '\t'])?;
    let value = value.trim();
    match word.to_ascii_lowercase().as_str() {
        "flight" => Some(Record::Flight(value)),
        "date" => Some(Record::Date(value)),
        _ => None,
    }
}

/// The label of rows from `Line 101` or `L101:2`, if the line is that.
fn label(line: &str) -> Option<String> {
    if line.len() > 64 || !line.starts_with(|first: char| first.is_ascii_alphabetic()) {
        return None;
    }
    if let [word, name] = line.split_ascii_whitespace().collect::<Vec<_>>()[..] {
        let (_, letter) = TYPES.iter().find(|(long, _)| word.eq_ignore_ascii_case(long))?;
        let name = name.trim_matches('"');
        return (!name.is_empty()).then(|| format!("{letter}{name}"));
    }
    let (letter, rest) = line.split_at(1);
    let is_letter = letter == "L" || TYPES.iter().any(|(_, short)| *short == letter);
    let is_number = rest.starts_with(|c: char| c.is_ascii_digit())
        && rest.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.' || byte == b':');
    (is_letter && is_number).then(|| line.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_of_six_sorts() {
        assert_eq!(record("  "), Record::Blank);
        assert_eq!(record("/ X Y MAG"), Record::Comment("X Y MAG"));
        assert_eq!(record("// of the survey"), Record::Comment(" of the survey"));
        assert_eq!(record("//Flight 12"), Record::Flight("12"));
        assert_eq!(record("//DATE\t2020/01/31"), Record::Date("2020/01/31"));
        assert_eq!(record(" 1 2 3"), Record::Row("1 2 3"));
    }

    #[test]
    fn lines_have_types() {
        let labels = ["Line 101", "line 93.53", "Tie 5", "Random \"3\"", "L101", "T5:2", "L101.1:3:1"];
        let wanted = ["101", "93.53", "T5", "D3", "L101", "T5:2", "L101.1:3:1"];
        assert_eq!(labels.map(|text| record(text)), wanted.map(|text| Record::Line(text.into())));
        for text in ["Line", "Line 1 2", "Lines 3", "X101", "L", "Lima", "101", "L10a"] {
            assert_eq!(record(text), Record::Row(text));
        }
    }

    #[test]
    fn rows_are_mostly_numbers() {
        assert!(["1 2 * 12:00:00", "1,2,x", "5"].into_iter().all(is_row));
        assert!(!["Field no 1", "", "a b", "x 1"].into_iter().any(is_row));
    }
}

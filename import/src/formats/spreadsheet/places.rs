//! Whether the places that the cells of a worksheet claim are places.
//!
//! `calamine` 0.38 counts letters and digits of `ABC123` without a look at how many there are, and takes the beginning of
//! `C3:B2` from its end; what comes out is another place, or a panic where arithmetic is checked.

use quick_xml::events::{BytesStart, Event};

use super::sheet::Fault;

/// As large as any spreadsheet program has them.
const MOST_LETTERS: usize = 3;
const MOST_DIGITS: usize = 7;

/// Looks through a part of a workbook, if it is a worksheet.
pub(super) fn check(part: &[u8]) -> Result<(), Fault> {
    // Other encodings than UTF-8 are allowed, but no program writes them.
    let text = std::str::from_utf8(part).map_err(Fault::damaged)?;
    let mut reader = quick_xml::Reader::from_str(text);
    reader.config_mut().check_end_names = false;
    let mut is_worksheet = None;
    loop {
        match reader.read_event().map_err(Fault::damaged)? {
            Event::Start(tag) | Event::Empty(tag) => {
                if !*is_worksheet.get_or_insert_with(|| tag.local_name().as_ref() == "worksheet") {
                    return Ok(());
                }
                check_tag(&tag)?;
            }
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

fn check_tag(tag: &BytesStart<'_>) -> Result<(), Fault> {
    let name = match tag.local_name().as_ref() {
        "c" | "row" => "r",
        "dimension" | "mergeCell" | "f" => "ref",
        _ => return Ok(()),
    };
    for attribute in tag.attributes().with_checks(false) {
        let attribute = attribute.map_err(Fault::damaged)?;
        if attribute.key.as_ref() == name && !is_area(&attribute.value) {
            return Err(Fault::Damaged(format!("\"{}\" is no place in a sheet", attribute.value)));
        }
    }
    Ok(())
}

/// `A1`, `A1:B2` with the end behind the beginning, or the number of a row.
fn is_area(text: &str) -> bool {
    match text.split_once(':') {
        None => place(text).is_some(),
        Some((from, to)) => place(from).zip(place(to)).is_some_and(|(from, to)| from.0 <= to.0 && from.1 <= to.1),
    }
}

/// Column and row, from 1; the column is 0 if there is none.
fn place(text: &str) -> Option<(u32, u32)> {
    let (letters, digits) = text.split_at(text.find(|letter: char| !letter.is_ascii_alphabetic())?);
    if letters.len() > MOST_LETTERS || digits.len() > MOST_DIGITS {
        return None;
    }
    let column = letters.bytes().fold(0, |column, letter| column * 26 + u32::from(letter.to_ascii_uppercase() - b'@'));
    Some((column, digits.parse().ok().filter(|row| *row > 0)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_areas_are_told_from_what_is_none() {
        assert!(["A1", "XFD1048576", "17", "A1:F155", "aa2:AB2"].into_iter().all(is_area));
        let none = ["", "A", "A0", "C3:B4", "B4:C3", "A1:", "ABCD1", "A99999999", "A-1", "\u{e4}1", "A1B"];
        assert!(!none.into_iter().any(is_area));
    }

    #[test]
    fn only_worksheets_are_looked_through() {
        assert!(check(b"<worksheet><sheetData><row r=\"1\"><c r=\"A1\"/></row></sheetData></worksheet>").is_ok());
        assert!(check(b"<x:worksheet><c r=\"AAAAAAAAAAAAAAA1\"/></x:worksheet>").is_err());
        assert!(check(b"<other><c r=\"AAAAAAAAAAAAAAA1\"/></other>").is_ok());
    }
}

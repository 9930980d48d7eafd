//! Whether an archive is safe to open.

use std::io::{Cursor, Read as _};

use zip::ZipArchive;

use super::super::memory::Budget;
use super::sheet::Fault;

/// The place where a workbook keeps its texts once each.
const SHARED_TEXTS: &str = "sharedstrings.xml";
/// Bytes of the shortest shared text, `<si/>`.
const SHORTEST_TEXT: usize = 5;

/// Unpacks everything once, whatever the archive says of its sizes, and keeps nothing: all must be whole, and no more than
/// a file of this length warrants.
pub(super) fn check(bytes: &[u8], budget: &mut Budget) -> Result<(), Fault> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(Fault::damaged)?;
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).map_err(Fault::damaged)?;
        let name = entry.name().map_err(Fault::damaged)?.to_ascii_lowercase();
        if name.ends_with(SHARED_TEXTS) {
            let text = read_bounded(&mut entry, budget)?;
            check_count(&text)?;
        } else if name.ends_with(".xml") {
            super::places::check(&read_bounded(&mut entry, budget)?)?;
        } else {
            let mut limited = (&mut entry).take(budget.left() as u64 + 1);
            let size = std::io::copy(&mut limited, &mut std::io::sink()).map_err(Fault::damaged)?;
            budget.take(usize::try_from(size).unwrap_or(usize::MAX), 1)?;
        }
    }
    Ok(())
}

/// An entry of an archive.
pub(super) fn entry(bytes: &[u8], name: &str, budget: &mut Budget) -> Result<Vec<u8>, Fault> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(Fault::damaged)?;
    let mut entry = archive.by_name(name).map_err(Fault::damaged)?;
    read_bounded(&mut entry, budget)
}

fn read_bounded(entry: &mut impl std::io::Read, budget: &mut Budget) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    entry.take(budget.left() as u64 + 1).read_to_end(&mut bytes).map_err(Fault::damaged)?;
    budget.take(bytes.len(), 1)?;
    Ok(bytes)
}

/// `calamine` makes room for as many texts as the sheet says it has, before it has seen one.
fn check_count(text: &[u8]) -> Result<(), Fault> {
    const COUNT: &[u8] = b"uniqueCount";
    if text.contains(&0) {
        return Err(Fault::Damaged("its texts are in an unusual encoding".into()));
    }
    for place in text.windows(COUNT.len()).enumerate().filter(|(_, word)| *word == COUNT).map(|(place, _)| place) {
        let digits = text[place + COUNT.len()..].iter().skip_while(|byte| !byte.is_ascii_digit());
        let digits = digits.take_while(|byte| byte.is_ascii_digit());
        let claimed =
            digits.fold(0_usize, |claimed, digit| claimed.saturating_mul(10).saturating_add((digit - b'0').into()));
        if claimed > text.len() / SHORTEST_TEXT {
            return Err(Fault::Damaged(format!("it says that it has {claimed} texts")));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_that_cannot_be_there_are_not_believed() {
        let text = |count: &str| format!("<sst uniqueCount = \"{count}\"><si><t>a</t></si></sst>").into_bytes();
        assert!(check_count(&text("1")).is_ok());
        assert!(check_count(&text("100")).is_err());
        assert!(check_count(&text("99999999999999999999999999")).is_err());
    }
}

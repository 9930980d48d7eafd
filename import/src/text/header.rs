//! The header of a text: names of the columns, and their units.

use super::cell::parse_number;
use super::comment::{is_comment, without_mark};
use super::fields::fields;
use super::lines::Line;
use super::signs::{Decimal, Delimiter};
use crate::units::is_unit;

/// What stands above the data.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Header {
    /// Names, as many as the header has.
    pub(super) names: Vec<String>,
    /// Units, as many as their row has.
    pub(super) units: Vec<String>,
    /// The line of the names, from 1; 0 without.
    pub(super) line: u32,
    /// So many lines stand before it.
    pub(super) preamble: usize,
}

/// The header among the lines above the data: the last one whose fields are names, with a row of units below it or not.
pub(super) fn find(above: &[Line<'_>], delimiter: Delimiter, width: usize) -> Header {
    let none = Header { preamble: above.len(), ..Header::default() };
    // The nearest line that can be one; a comment only where no other does.
    let plain: Vec<_> = candidates(above).filter(|(_, line)| !is_comment(line.text)).collect();
    let header = from(plain.into_iter(), delimiter, width);
    header.or_else(|| from(candidates(above), delimiter, width)).unwrap_or(none)
}

/// The last lines that are not blank, from below.
fn candidates<'a>(above: &'a [Line<'a>]) -> impl Iterator<Item = (usize, &'a Line<'a>)> {
    above.iter().enumerate().rev().filter(|(_, line)| !line.text.trim().is_empty()).take(6)
}

fn from<'a>(
    mut candidates: impl Iterator<Item = (usize, &'a Line<'a>)>,
    delimiter: Delimiter,
    width: usize,
) -> Option<Header> {
    let (at, last) = candidates.next()?;
    let cells = names_of(last.text, delimiter, width)?;
    if is_row_of_units(&cells)
        && let Some((above_at, line)) = candidates.next()
        && let Some(names) = names_of(line.text, delimiter, width)
    {
        return Some(Header { names, units: cells, line: line.number, preamble: above_at });
    }
    Some(Header { names: cells, units: Vec::new(), line: last.number, preamble: at })
}

/// The fields of a line, if they can be the names of so many columns. A header may part its names otherwise than the data
/// their fields, and may lack the names of empty fields at the end.
fn names_of(line: &str, delimiter: Delimiter, width: usize) -> Option<Vec<String>> {
    let line = without_mark(line);
    let others = Delimiter::ALL.into_iter().filter(|other| *other != delimiter);
    std::iter::once(delimiter).chain(others).find_map(|delimiter| {
        let mut names = fields(line, delimiter);
        while names.len() > width && names.last().is_some_and(|name| name.is_empty()) {
            names.pop();
        }
        let few = names.len() < 2.max(width.div_ceil(2)) || names.len() > width + 2;
        (!few && are_names(&names)).then(|| names.into_iter().map(str::to_string).collect())
    })
}

fn are_names(fields: &[&str]) -> bool {
    let numbers = fields.iter().filter(|field| parse_number(field, Decimal::Point).is_some()).count();
    let named = fields.iter().filter(|field| !field.is_empty()).count();
    named * 2 > fields.len() && numbers * 4 < named
}

fn is_row_of_units(cells: &[String]) -> bool {
    let there: Vec<_> = cells.iter().filter(|cell| !cell.is_empty()).collect();
    let units = there.iter().filter(|cell| is_unit(cell)).count();
    !there.is_empty() && units * 10 >= there.len() * 7
}

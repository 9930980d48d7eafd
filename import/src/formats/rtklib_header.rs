//! The line of RTKLIB's positions that names their columns.

use std::borrow::Cow;

use super::rtklib_time::TimeSystem;
use crate::source::{FindingKind, Note};
use crate::text::{loose_fields, name_and_unit, number};

/// The unit of an angle in three fields: degrees, minutes and seconds.
pub(super) const DEGREES_IN_THREE: &str = "d'\"";

/// What the line of columns says.
pub(super) struct Header {
    pub(super) system: TimeSystem,
    pub(super) columns: Vec<(String, Option<String>)>,
}

/// The line of columns: the time system, then names with units.
pub(super) fn header(line: &str) -> Option<Header> {
    let mut words = loose_fields(line.strip_prefix('%')?);
    let system = TimeSystem::of(words.next()?)?;
    let columns: Vec<_> = words.map(name_and_unit).collect();
    let is_position = |name: &str| ["latitude", "x-ecef", "e-baseline"].contains(&name);
    columns.iter().any(|(name, _)| is_position(name)).then_some(Header { system, columns })
}

impl Header {
    /// Of the fields of a row, with those of the time.
    pub(super) fn width(&self) -> usize {
        2 + self.columns.iter().map(|column| fields_of(column.1.as_deref())).sum::<usize>()
    }

    /// The cells of a row, one a column.
    pub(super) fn cells<'a>(&self, fields: &[&'a str]) -> Vec<Cow<'a, str>> {
        let mut rest = fields.get(2..).unwrap_or_default();
        let mut cells = Vec::with_capacity(self.columns.len());
        for (_, unit) in &self.columns {
            let (cell, after) = rest.split_at_checked(fields_of(unit.as_deref())).unwrap_or_default();
            rest = after;
            cells.push(match cell {
                [degrees, minutes, seconds] => in_degrees(degrees, minutes, seconds),
                _ => Cow::Borrowed(cell.first().copied().unwrap_or("")),
            });
        }
        cells
    }

    /// For the user: that the times are no longer those of the file.
    pub(super) fn note(&self, first_utc_s: f64) -> Option<Note> {
        // At most 1 s beside a leap second, where the time of the file itself decides.
        let ahead_s = self.system.ahead_s(first_utc_s + self.system.ahead_s(first_utc_s));
        let text = match self.system {
            TimeSystem::Gps => format!("times are GPS time, {ahead_s} s ahead of UTC: given in UTC"),
            TimeSystem::Japan => "times are Japan's, 9 h ahead of UTC: given in UTC".to_string(),
            TimeSystem::Utc => return None,
        };
        Some(Note { kind: FindingKind::Units, text })
    }
}

fn fields_of(unit: Option<&str>) -> usize {
    if unit == Some(DEGREES_IN_THREE) { 3 } else { 1 }
}

fn in_degrees<'a>(degrees: &'a str, minutes: &str, seconds: &str) -> Cow<'a, str> {
    match [degrees, minutes, seconds].map(number) {
        [Some(whole), Some(minutes), Some(seconds)] => {
            let size = whole.abs() + minutes / 60.0 + seconds / 3600.0;
            Cow::Owned(if degrees.starts_with('-') { -size } else { size }.to_string())
        }
        _ => Cow::Borrowed(degrees),
    }
}

//! Fewer points where a map needs no more.

use std::ops::Range;

use towmag_recording::Column;

use crate::error::ExportError;
use crate::position::Position;
use crate::table::Table;

/// Times are written with so many digits that steps of a tenth of a second miss by less than this, s.
const ROUNDING_S: f64 = 1e-3;

/// The rows of a leg that have a position; where they are thinned, those with a time, `every_s` seconds apart or more, and the last one.
pub(super) fn rows(
    table: &Table,
    leg: &Range<usize>,
    position: &Position<'_>,
    every_s: Option<f64>,
) -> Result<Vec<usize>, ExportError> {
    let placed: Vec<usize> = leg.clone().filter(|&row| position.at(row).is_some()).collect();
    let Some(every_s) = every_s else { return Ok(placed) };
    let time = Column::Time.name();
    let without = || table.lacks(format!("{time} is missing, and --every needs it"));
    let time_s = table.numbers(time).ok_or_else(without)?;
    let timed: Vec<usize> = placed.into_iter().filter(|&row| !time_s[row].is_nan()).collect();
    let mut kept: Vec<usize> = Vec::new();
    for &row in &timed {
        let is_due = |&last: &usize| time_s[row] - time_s[last] >= every_s - ROUNDING_S;
        if kept.last().is_none_or(is_due) || Some(&row) == timed.last() {
            kept.push(row);
        }
    }
    Ok(kept)
}

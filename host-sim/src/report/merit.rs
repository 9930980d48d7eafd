//! The figure of merit on the page: a table by heading and manoeuvre.

use crate::collect::{MANOEUVRES, MeritCell, SECTORS};
use crate::run::MethodResult;
use crate::text::number::three_digits;

/// Of the method that is shown as the best.
pub(super) struct Merit<'a> {
    pub(super) method: &'a str,
    /// "12.3 of 456 nT over 9 headings and manoeuvres".
    pub(super) sum: String,
    pub(super) manoeuvres: [&'static str; 3],
    /// Heading, and after and before of each manoeuvre.
    pub(super) rows: Vec<(&'static str, [String; 3])>,
}

/// `None` where no manoeuvre could be told.
pub(super) fn merit(method: &MethodResult) -> Option<Merit<'_>> {
    let [before, after] = method.merit.sums_nt()?.map(three_digits);
    let cell = |cell: &MeritCell| match cell.windows {
        0 => "–".into(),
        _ => format!("{} of {}", three_digits(cell.after_nt), three_digits(cell.before_nt)),
    };
    let seen = SECTORS.iter().zip(&method.merit.0).filter(|(_, cells)| cells.iter().any(|cell| cell.windows > 0));
    Some(Merit {
        method: &method.name,
        sum: format!("{after} of {before} nT over {} headings and manoeuvres", method.merit.seen().count()),
        manoeuvres: MANOEUVRES,
        rows: seen.map(|(heading, cells)| (*heading, cells.each_ref().map(cell))).collect(),
    })
}

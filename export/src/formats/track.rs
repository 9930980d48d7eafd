//! What is said of a leg of the track, in every format that draws it.

use towmag_recording::Column;

use crate::legs::Leg;
use crate::table::Table;

/// A leg as it is described beside its course.
pub(super) struct LegFacts<'a> {
    /// Its label.
    pub(super) line: Option<&'a str>,
    /// `time_s` of its first and of its last row that have one.
    pub(super) time_s: [Option<f64>; 2],
    /// The same of `utc_s`.
    pub(super) utc_s: [Option<f64>; 2],
    /// Its rows.
    pub(super) rows: usize,
}

impl<'a> LegFacts<'a> {
    /// Of this leg.
    pub(super) fn of(table: &Table, leg: &Leg<'a>) -> Self {
        let ends = |column: Column| {
            let numbers = table.numbers(column.name()).unwrap_or(&[]);
            let mut known = leg.rows.clone().filter_map(|row| numbers.get(row)).filter(|number| !number.is_nan());
            let first = known.next().copied();
            [first, known.next_back().copied().or(first)]
        };
        Self { line: leg.label, time_s: ends(Column::Time), utc_s: ends(Column::Utc), rows: leg.rows.len() }
    }
}

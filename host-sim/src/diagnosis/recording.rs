//! A recording as it is diagnosed: what does not change however often it is searched.

use towmag::model::TERMS;

use super::base::filled;
use super::reconstruct::prepared::Prepared;
use super::reconstruct::reconstruction::Reconstruction;
use super::rounding::Rounding;
use crate::simulator::signals::Signals;

/// A recording, and the clean signals that it gives as it was read.
pub(super) struct Recording<'a> {
    pub(super) table: &'a Prepared,
    pub(super) rounding: Rounding,
    pub(super) reconstruction: Reconstruction,
    pub(super) start: Signals,
}

impl<'a> Recording<'a> {
    pub(super) fn of(table: &'a Prepared, coefficients: [f64; TERMS]) -> Self {
        let reconstruction = Reconstruction::of(table);
        let trajectory =
            reconstruction.trajectory(table, &table.flux_nt, &filled(&table.to_explain_nt()), coefficients);
        Self { table, rounding: Rounding::of(table), reconstruction, start: Signals::new(trajectory) }
    }
}

//! The steps of a channel along a recording: an export may change between two of its parts.

use std::ops::Range;

use super::lattice::Lattice;
use crate::diagnosis::policy::{
    LATTICE_LEAST_CONCENTRATION, LATTICE_LEAST_ON, SAME_STEP_SHARE, STRETCH_BORDER_ROWS, STRETCH_LEAST_ROWS,
    STRETCH_MOST_HALVINGS,
};

/// Steps beyond which a value is not on its lattice.
const OFF: f64 = 0.25;

/// Rows that are rounded alike.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stretch {
    pub(crate) rows: Range<usize>,
    /// What a value is rounded to, in its unit: the step of the lattice, or that of the last digit.
    pub(crate) step: f64,
    lattice: Option<Lattice>,
}

impl Stretch {
    fn new(rows: Range<usize>, lattice: Option<Lattice>, resolution: f64) -> Self {
        Self { rows, step: lattice.map_or(resolution, |lattice| lattice.step), lattice }
    }

    /// Standard error of the step; that of a last digit has none.
    pub(crate) fn step_error(&self) -> f64 {
        self.lattice.map_or(0.0, |lattice| lattice.step_error)
    }

    /// Whether another stretch has the same step.
    fn is_like(&self, other: &Self) -> bool {
        self.lattice.is_some() == other.lattice.is_some() && (self.step / other.step - 1.0).abs() < SAME_STEP_SHARE
    }

    /// Whether nearly all of some rows are on its lattice; without one they always are.
    fn holds(&self, values: &[f64], rows: Range<usize>) -> bool {
        let Some(lattice) = self.lattice else { return true };
        let known = known(&values[rows]);
        let on = known.iter().filter(|value| lattice.off(**value) <= OFF).count();
        on as f64 >= LATTICE_LEAST_ON * known.len() as f64
    }
}

/// The stretches of a column, in order: all rows belong to one. `resolution` is the step of the last digit; what is not a
/// number is on every lattice.
pub(crate) fn stretches(values: &[f64], resolution: f64) -> Vec<Stretch> {
    let mut stretches: Vec<Stretch> = Vec::new();
    for next in halved(values, 0..values.len(), resolution, STRETCH_MOST_HALVINGS) {
        match stretches.last_mut() {
            Some(last) if last.is_like(&next) => last.rows.end = next.rows.end,
            _ => stretches.push(next),
        }
    }
    for border in 1..stretches.len() {
        move_border(values, &mut stretches, border);
    }
    without_remnants(stretches)
}

/// Without the stretches that were only what is left about a border: their rows go to the one before.
fn without_remnants(stretches: Vec<Stretch>) -> Vec<Stretch> {
    let mut kept: Vec<Stretch> = Vec::new();
    for stretch in stretches {
        match kept.last_mut() {
            Some(last) if stretch.rows.len() < STRETCH_BORDER_ROWS => last.rows.end = stretch.rows.end,
            _ => kept.push(stretch),
        }
    }
    kept
}

/// One stretch where one lattice holds everywhere, else those of the two halves.
fn halved(values: &[f64], rows: Range<usize>, resolution: f64, halvings: u32) -> Vec<Stretch> {
    let lattice = Lattice::of(&known(&values[rows.clone()]), resolution);
    let is_everywhere = |lattice: &Lattice| {
        let mut parts = values[rows.clone()].chunks(STRETCH_LEAST_ROWS);
        parts.all(|part| lattice.concentration(&known(part)) >= LATTICE_LEAST_CONCENTRATION)
    };
    if lattice.as_ref().is_some_and(is_everywhere) || rows.len() < 2 * STRETCH_LEAST_ROWS || halvings == 0 {
        return vec![Stretch::new(rows, lattice, resolution)];
    }
    let middle = rows.start + rows.len() / 2;
    let [first, second] = [rows.start..middle, middle..rows.end];
    let (mut first, second) = rayon::join(
        || halved(values, first, resolution, halvings - 1),
        || halved(values, second, resolution, halvings - 1),
    );
    first.extend(second);
    first
}

/// Move the border before a stretch to where the coarser one of the two lattices ends: halving puts it only about there.
fn move_border(values: &[f64], stretches: &mut [Stretch], border: usize) {
    let [before, after] = &mut stretches[border - 1..=border] else { return };
    let rows = STRETCH_BORDER_ROWS;
    let mut at = before.rows.end;
    if before.step >= after.step {
        while at < after.rows.end && before.holds(values, at..(at + rows).min(after.rows.end)) {
            at = (at + rows).min(after.rows.end);
        }
    } else {
        while at > before.rows.start && after.holds(values, at.saturating_sub(rows).max(before.rows.start)..at) {
            at = at.saturating_sub(rows).max(before.rows.start);
        }
    }
    (before.rows.end, after.rows.start) = (at, at);
}

fn known(values: &[f64]) -> Vec<f64> {
    values.iter().copied().filter(|value| value.is_finite()).collect()
}

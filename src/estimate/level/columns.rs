//! The terms with a better derivative than the published backward difference, and without those that the field itself is
//! in.
//!
//! A first-order backward difference is half an epoch late. On the simulated lake tow that alone leaves 0.7 nT in the
//! band and, as coefficients bend to make up for it, 10 nT in the level. What is learnt therefore waits one epoch for the
//! central difference; what is written, which cannot wait, has the third-order backward one (in short waves the
//! second-order one leaves 0.35 nT).

use crate::model::basis::DIAGONALS;
use crate::model::{Row, TERMS, TermVector};

/// Place of the first eddy term.
const EDDY: usize = 9;

/// Columns that stay zero: the field's magnitude, which holds geology and targets as the scalar does and would explain them
/// away, and the sum of the diagonal eddy terms, which is zero but for rounding.
pub(super) const LEFT_OUT: [usize; 2] = [DIAGONALS[0][2], DIAGONALS[1][2]];

/// What is remembered of the epochs before.
#[derive(Clone, Copy, Debug)]
pub(super) struct History {
    tick: u32,
    /// Direction of the field, the latest first.
    directions: [Option<[f32; 3]>; 3],
    /// Columns and reading of the latest epoch.
    latest: Option<Row>,
}

impl History {
    /// Nothing.
    pub(super) const BLANK: Self = Self { tick: 0, directions: [None; 3], latest: None };

    /// Take in an epoch whose terms are `terms` and whose reading, less a reference, is `scalar_nt`. Returns the columns
    /// for now, and the row of the epoch before if the one before that is known too.
    pub(super) fn step(
        &mut self,
        tick: u32,
        terms: &TermVector,
        scalar_nt: f32,
        rate_hz: f32,
    ) -> (TermVector, Option<Row>) {
        if tick.wrapping_sub(self.tick) != 1 {
            *self = Self::BLANK;
        }
        let direction = [terms[0], terms[1], terms[2]];
        let now = self.columns_now(terms, direction, rate_hz);
        let row = self.row_before(direction, rate_hz);
        self.tick = tick;
        self.directions = [Some(direction), self.directions[0], self.directions[1]];
        self.latest = Some(Row { terms: now, scalar_nt });
        (now, row)
    }

    /// Columns with the third-order backward difference, `(11 u(t) - 18 u(t - 1) + 9 u(t - 2) - 2 u(t - 3)) / 6`; after a
    /// gap with the one that the terms have.
    fn columns_now(&self, terms: &TermVector, u: [f32; 3], rate_hz: f32) -> TermVector {
        let mut columns = *terms;
        if let [Some(one), Some(two), Some(three)] = self.directions {
            // Of differences: in f32 the sum of the cosines themselves would lose digits.
            let per_s = |i: usize| rate_hz * (3.0 * (u[i] - one[i]) - 1.5 * (u[i] - two[i]) + (u[i] - three[i]) / 3.0);
            set_eddy(&mut columns, u, [per_s(0), per_s(1), per_s(2)]);
        }
        LEFT_OUT.into_iter().for_each(|column| columns[column] = 0.0);
        columns
    }

    /// The row of the epoch before, with the central difference.
    fn row_before(&self, after: [f32; 3], rate_hz: f32) -> Option<Row> {
        let [u, earlier, _] = self.directions;
        let (mut row, u, earlier) = (self.latest?, u?, earlier?);
        let per_s = |i: usize| rate_hz * 0.5 * (after[i] - earlier[i]);
        set_eddy(&mut row.terms, u, [per_s(0), per_s(1), per_s(2)]);
        Some(row)
    }
}

/// The eddy columns `u_i du_j/dt`. The magnitude, a factor of 1.0 that changes by 1e-4, is left out of these.
fn set_eddy(columns: &mut TermVector, u: [f32; 3], per_s: [f32; 3]) {
    for (i, cosine) in u.into_iter().enumerate() {
        for (j, per_s) in per_s.into_iter().enumerate() {
            columns[EDDY + 3 * i + j] = cosine * per_s;
        }
    }
    columns[TERMS - 1] = 0.0;
}

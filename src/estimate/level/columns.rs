//! The terms with a better derivative than the published backward difference, and without those that the field itself is
//! in.
//!
//! A first-order backward difference is half an epoch late. On the simulated lake tow that alone leaves 0.7 nT in the
//! band and, as coefficients bend to make up for it, 10 nT in the level. What is learnt can wait: two epochs later the
//! derivative of five points is known, which at 1 Hz is 0.5 % short where the difference of two neighbours is 6 % short.
//! What is written cannot wait, and has the third-order backward difference (in short waves the second-order one leaves 0.35 nT).

use crate::model::basis::DIAGONALS;
use crate::model::{Row, TERMS, TermVector};

/// Which columns these are. What a calibration has learnt in others must not be multiplied with them: whoever stores
/// [`Prior::level`](super::super::Prior::level) stores this too, and forgets a level that has another. 1: the difference of neighbours, and
/// eddy columns without the magnitude.
pub const LEVEL_COLUMNS: u32 = 2;

/// Place of the first eddy term.
const EDDY: usize = 9;

/// Columns that stay zero: the field's magnitude, which holds geology and targets as the scalar does and would explain them
/// away, and the sum of the diagonal eddy terms, which is zero but for rounding.
pub(super) const LEFT_OUT: [usize; 2] = [DIAGONALS[0][2], DIAGONALS[1][2]];

/// Epochs that a row waits for its derivative.
const LATE: usize = 2;

/// Direction of the field, and its magnitude in the unit of the columns.
#[derive(Clone, Copy, Debug)]
struct Direction {
    cosines: [f32; 3],
    field: f32,
}

/// What is remembered of the epochs before.
#[derive(Clone, Copy, Debug)]
pub(super) struct History {
    tick: u32,
    /// Of the field, the latest first.
    directions: [Option<Direction>; 2 * LATE],
    /// Columns and readings that wait for their derivative, the latest first.
    rows: [Option<Row>; LATE],
}

impl History {
    /// Nothing.
    pub(super) const BLANK: Self = Self { tick: 0, directions: [None; 2 * LATE], rows: [None; LATE] };

    /// Take in an epoch whose terms are `terms` and whose reading, less a reference, is `scalar_nt`. Returns the columns
    /// for now, and the row of two epochs before if the two before that are known too.
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
        let [[.., magnitude], _] = DIAGONALS;
        let now = Direction { cosines: [terms[0], terms[1], terms[2]], field: 1.0 + terms[magnitude] };
        let columns = self.columns_now(terms, &now, rate_hz);
        let row = self.row_before(&now, rate_hz);
        self.tick = tick;
        let [one, two, three, _] = self.directions;
        self.directions = [Some(now), one, two, three];
        self.rows = [Some(Row { terms: columns, scalar_nt }), self.rows[0]];
        (columns, row)
    }

    /// Columns with the third-order backward difference, `(11 u(t) - 18 u(t - 1) + 9 u(t - 2) - 2 u(t - 3)) / 6`; after a
    /// gap with the one that the terms have.
    fn columns_now(&self, terms: &TermVector, now: &Direction, rate_hz: f32) -> TermVector {
        let mut columns = *terms;
        if let [Some(one), Some(two), Some(three), _] = &self.directions {
            // Of differences: in f32 the sum of the cosines themselves would lose digits.
            let since = |before: &Direction, i: usize| now.cosines[i] - before.cosines[i];
            let per_s = |i: usize| rate_hz * (3.0 * since(one, i) - 1.5 * since(two, i) + since(three, i) / 3.0);
            set_eddy(&mut columns, now, [per_s(0), per_s(1), per_s(2)]);
        }
        LEFT_OUT.into_iter().for_each(|column| columns[column] = 0.0);
        columns
    }

    /// The row of two epochs before, with the derivative of the five points around it,
    /// `(8 (u(t - 1) - u(t - 3)) - (u(t) - u(t - 4))) / 12`.
    fn row_before(&self, now: &Direction, rate_hz: f32) -> Option<Row> {
        let [one, middle, three, four] = &self.directions;
        let (one, middle, three, four) = (one.as_ref()?, middle.as_ref()?, three.as_ref()?, four.as_ref()?);
        let mut row = self.rows[LATE - 1]?;
        let inner = |i: usize| one.cosines[i] - three.cosines[i];
        let outer = |i: usize| now.cosines[i] - four.cosines[i];
        let per_s = |i: usize| rate_hz * (8.0 * inner(i) - outer(i)) / 12.0;
        set_eddy(&mut row.terms, middle, [per_s(0), per_s(1), per_s(2)]);
        Some(row)
    }
}

/// The eddy columns `s u_i du_j/dt`, with the magnitude `s` of eq. (4): a calibration holds where the field is another.
fn set_eddy(columns: &mut TermVector, direction: &Direction, per_s: [f32; 3]) {
    for (i, cosine) in direction.cosines.into_iter().enumerate() {
        for (j, per_s) in per_s.into_iter().enumerate() {
            columns[EDDY + 3 * i + j] = direction.field * cosine * per_s;
        }
    }
    columns[TERMS - 1] = 0.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE_HZ: f32 = 10.0;

    /// Terms of a direction that swings in the horizontal plane, of which the level makes use.
    fn terms(angle: f64, field: f32) -> TermVector {
        let mut terms = TermVector::zeros();
        (terms[0], terms[1]) = (libm::cos(angle) as f32, libm::sin(angle) as f32);
        terms[DIAGONALS[0][2]] = field - 1.0;
        terms
    }

    fn angle(epoch: u32, hz: f64) -> f64 {
        0.1 * libm::sin(core::f64::consts::TAU * hz * f64::from(epoch) / f64::from(RATE_HZ))
    }

    /// Largest error of `x dy/dt` of what is learnt and of what is written, over the largest of its true values.
    fn errors(hz: f64, field: f32) -> [f64; 2] {
        let mut history = History::BLANK;
        let (mut errors, mut largest) = ([0.0_f64; 2], 0.0_f64);
        for epoch in 0..200 {
            let (now, row) = history.step(epoch, &terms(angle(epoch, hz), field), epoch as f32, RATE_HZ);
            let truth = |epoch: u32| {
                let omega = core::f64::consts::TAU * hz;
                let rate = 0.1 * omega * libm::cos(omega * f64::from(epoch) / f64::from(RATE_HZ));
                f64::from(field) * libm::cos(angle(epoch, hz)) * libm::cos(angle(epoch, hz)) * rate
            };
            let Some(row) = row else { continue };
            assert_eq!(row.scalar_nt, epoch as f32 - 2.0, "the reading is another epoch's");
            largest = largest.max(libm::fabs(truth(epoch)));
            let apart = [f64::from(row.terms[EDDY + 1]) - truth(epoch - 2), f64::from(now[EDDY + 1]) - truth(epoch)];
            errors.iter_mut().zip(apart).for_each(|(error, apart)| *error = error.max(libm::fabs(apart)));
        }
        errors.map(|error| error / largest)
    }

    #[test]
    fn the_derivative_that_is_learnt_from_is_right_in_short_waves() {
        let [learnt, written] = errors(0.8, 1.0);
        assert!(learnt < 0.005 && written < 0.05, "{learnt} {written}");
        // The difference of neighbours is 6 % short there.
        assert!(errors(1.0, 1.0)[0] < 0.01);
    }

    #[test]
    fn eddy_currents_grow_with_the_field() {
        let [learnt, written] = errors(0.2, 1.3);
        assert!(learnt < 1e-3 && written < 1e-2, "{learnt} {written}");
    }

    #[test]
    fn no_derivative_across_a_gap() {
        let mut history = History::BLANK;
        let rows = |history: &mut History, ticks: core::ops::Range<u32>| {
            ticks.filter(|&tick| history.step(tick, &terms(0.1, 1.0), 0.0, RATE_HZ).1.is_some()).count()
        };
        assert_eq!(rows(&mut history, 0..10), 6);
        assert_eq!(rows(&mut history, 11..15), 0);
        assert_eq!(rows(&mut history, 15..20), 5);
    }
}

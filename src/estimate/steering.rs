//! What changing coefficients write into the output, steered out of the band.
//!
//! The output is written once, epoch by epoch, each with the coefficients of its time. Band-passed afterwards it holds
//! what the coefficients have learnt since as an error: 1.1 to 1.3 times what the same coefficients leave of band-passed
//! rows. But the error is known, for it is the difference between what was written and what the coefficients of now would
//! have written, and so is all of it that is still to come out of a band-pass. An offset of the output can therefore be
//! moved such that the least of it comes: a linear-quadratic regulator (Anderson and Moore, "Optimal Control", 1990) whose
//! plant is the band-pass itself.

use crate::filter::{BandPass, BandPassState, STATES};
use crate::model::{Coefficients, TERMS, TermVector};

/// Price of moving the offset by 1 nT within an epoch, in nT^2 of what is left within the band. Free moves would undo
/// the band-pass, and fill the output with what lies beyond it.
const MOVE_PRICE: f32 = 0.01;

/// Price of an offset of 1 nT for an epoch, likewise: below the band it is invisible, and would wander for ever.
const OFFSET_PRICE: f32 = 1e-4;

/// Share of the offset that the first policy takes back in an epoch.
const FIRST_GAIN: f32 = 0.02;

/// Policies that are tried, each better than the one before it; the last ones differ by rounding errors.
const POLICIES: u32 = 12;

/// Doublings of the time over which a policy is judged: 16,384 epochs.
const DOUBLINGS: u32 = 14;

/// What the band-pass holds, and the offset.
const SIZE: usize = STATES + 1;

/// The place in what the band-pass holds where a constant input ends up. See [`BandPassState::steady`].
const CONSTANT: usize = 1;

type Vector = [f32; SIZE];
type Matrix = [Vector; SIZE];

/// Gains of the regulator: immutable.
#[derive(Clone, Copy, Debug)]
pub struct Steering {
    gains: Vector,
}

/// What a band-pass of the error holds, less what it would hold had the error always been that of now, and the offset.
#[derive(Clone, Copy, Debug, Default)]
pub struct SteeringState {
    rest: BandPassState<1>,
    offset_nt: f32,
}

impl Steering {
    /// For an output that is looked at through `band_pass`: policy iteration (Kleinman, IEEE Trans. AC-13, 1968), for
    /// whose first policy the band-pass is left alone.
    // Its matrices shall have left the stack before anything large is built.
    #[inline(never)]
    pub fn new(band_pass: &BandPass) -> Self {
        let (unit, unit_output) = band_pass.unit_responses();
        let mut transition = [[0.0; SIZE]; SIZE];
        transition[STATES][STATES] = 1.0;
        for (row, unit) in transition.iter_mut().zip(&unit) {
            row[..STATES].copy_from_slice(unit);
        }
        let mut output = [0.0; SIZE];
        output[..STATES].copy_from_slice(&unit_output);
        let mut gains = [0.0; SIZE];
        gains[STATES] = -FIRST_GAIN;
        for _ in 0..POLICIES {
            let worth = worth(&transition, &output, &gains);
            gains = better(&transition, &output, &worth);
        }
        Self { gains }
    }

    /// One epoch: the offset of the output, nT.
    pub fn step(&self, state: &mut SteeringState, band_pass: &BandPass) -> f32 {
        let offset = state.offset_nt * self.gains[STATES];
        let moved_nt = offset + state.rest.values().zip(&self.gains).map(|(value, gain)| value * gain).sum::<f32>();
        state.offset_nt += moved_nt;
        state.rest.shift(&[-moved_nt]);
        band_pass.step(&mut state.rest, &[0.0]);
        state.offset_nt
    }
}

impl SteeringState {
    /// The coefficients have changed; `columns` are those that `filter` has seen last.
    pub fn change(&mut self, change: &Coefficients, columns: &TermVector, filter: &BandPassState<{ TERMS + 1 }>) {
        self.rest.subtract(filter, change.basis());
        // Less what a constant input makes of it.
        self.rest.shift(&[change.predict_nt(columns)]);
    }
}

/// Change of a row, `row * state`, when the offset moves by 1 nT.
fn moved(row: &Vector) -> f32 {
    row[STATES] - row[CONSTANT]
}

/// What a policy costs from a state on, for ever, as a quadratic form.
fn worth(transition: &Matrix, output: &Vector, gains: &Vector) -> Matrix {
    // The offset moves by gains * state, then the band-pass goes on.
    let after = |row: &Vector| -> Vector { core::array::from_fn(|j| row[j] + moved(row) * gains[j]) };
    let mut over = transition.each_ref().map(after);
    let (output, offset) = (after(output), over[STATES]);
    let mut worth: Matrix = core::array::from_fn(|i| {
        let cost =
            |j: usize| output[i] * output[j] + MOVE_PRICE * gains[i] * gains[j] + OFFSET_PRICE * offset[i] * offset[j];
        core::array::from_fn(cost)
    });
    // The sum over twice the time is that over the first half, and the same from where that has led.
    for _ in 0..DOUBLINGS {
        let second = product::<true>(&over, &product::<false>(&worth, &over));
        for (row, second) in worth.iter_mut().zip(&second) {
            row.iter_mut().zip(second).for_each(|(worth, second)| *worth += second);
        }
        over = product::<false>(&over, &over);
    }
    worth
}

/// The gains that are best for an epoch whose outcome is worth that much.
fn better(transition: &Matrix, output: &Vector, worth: &Matrix) -> Vector {
    let push = transition.each_ref().map(moved);
    // Row of the whole cost that belongs to a move.
    let mut row = output.map(|value| moved(output) * value);
    row[STATES] += OFFSET_PRICE;
    for (j, worth) in worth.iter().enumerate() {
        let pushed: f32 = push.iter().zip(worth).map(|(push, worth)| push * worth).sum();
        row.iter_mut().zip(&transition[j]).for_each(|(row, next)| *row += pushed * next);
    }
    let price = MOVE_PRICE + moved(&row);
    row.map(|value| -value / price)
}

/// `a b`, or `a' b`.
fn product<const TRANSPOSED: bool>(a: &Matrix, b: &Matrix) -> Matrix {
    let mut product = [[0.0; SIZE]; SIZE];
    for (i, product) in product.iter_mut().enumerate() {
        for (j, b) in b.iter().enumerate() {
            let a = if TRANSPOSED { a[j][i] } else { a[i][j] };
            product.iter_mut().zip(b).for_each(|(product, b)| *product += a * b);
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filter::BandPassDesign;

    /// Sum of squares that comes out of the band-pass after a bump of the error, with and without steering.
    fn energies(design: BandPassDesign) -> [f32; 2] {
        let band_pass = design.build().unwrap();
        let steering = Steering::new(&band_pass);
        [false, true].map(|steers| {
            let (mut jumped_nt, mut energy) = (0.0, 0.0);
            let mut watch = BandPassState::steady(&[0.0]);
            let mut state = SteeringState::default();
            for epoch in 0..20_000 {
                // What the coefficients change by jumps, and later jumps back.
                let jump_nt = [(0, 1.0), (7, -0.4), (19, 0.3)].iter().find(|(at, _)| *at == epoch).map_or(0.0, |j| j.1);
                jumped_nt += jump_nt;
                state.rest.shift(&[-jump_nt]);
                let steered_nt = if steers { steering.step(&mut state, &band_pass) } else { 0.0 };
                let [seen] = band_pass.step(&mut watch, &[jumped_nt + steered_nt]);
                energy += seen * seen;
            }
            // Slowest with one pole a side at 0.02 Hz: 800 s.
            assert!(state.offset_nt.abs() < 0.1, "{design:?}: the offset stays at {} nT", state.offset_nt);
            energy
        })
    }

    #[test]
    fn less_comes_out_of_every_band() {
        for order in 1..=8 {
            for (low_hz, high_hz) in [(0.1, 0.9), (0.02, 0.5), (0.2, 2.0), (0.05, 4.0), (0.5, 0.9)] {
                let design = BandPassDesign { low_hz, high_hz, order, sample_rate_hz: 10.0 };
                let [without, with] = energies(design);
                assert!(with < 0.9 * without, "{design:?}: {with} is no less than {without}");
            }
        }
    }
}

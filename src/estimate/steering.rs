//! What changing coefficients write into the output, steered out of the band.
//!
//! The output is written once, epoch by epoch, each with the coefficients of its time. Band-passed afterwards it holds
//! what the coefficients have learnt since as an error: 1.1 to 1.3 times what the same coefficients leave of
//! band-passed rows. But the error is known, for it is the difference between what was written and what the
//! coefficients of now would have written, and so is all of it that is still to come out of a band-pass. An offset of
//! the output can therefore be moved such that the least of it comes: a linear-quadratic regulator (Anderson and Moore,
//! "Optimal Control", 1990) whose plant is the band-pass itself. The prices of its cost function are in `policy.rs`.

use crate::filter::{BandPass, BandPassState, STATES};
use crate::model::{Coefficients, TERMS, TermVector};
use crate::policy::{MOVE_PRICE, OFFSET_PRICE};

/// Share of the offset that the gains before the first iteration take back in an epoch: any that is stable will do.
const FIRST_GAIN: f32 = 0.02;

/// Policy iterations, each with better gains than the one before; the last ones differ by rounding errors.
const ITERATIONS: u32 = 12;

/// Doublings of the time over which the cost of a policy is summed: 16,384 epochs.
const DOUBLINGS: u32 = 14;

/// State of the plant: what the band-pass holds, then the offset.
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

/// State of the plant: what a band-pass of the error holds, less what it would hold had the error always been that of
/// now; and the offset, nT.
#[derive(Clone, Copy, Debug, Default)]
pub struct SteeringState {
    pending: BandPassState<1>,
    offset_nt: f32,
}

impl Steering {
    /// For an output that is looked at through `band_pass`: policy iteration (Kleinman, IEEE Trans. AC-13, 1968), which
    /// starts from gains that leave the band-pass alone and take the offset back.
    // Never inline: its matrices must have left the stack before anything large is built.
    #[inline(never)]
    pub fn new(band_pass: &BandPass) -> Self {
        let (unit, unit_output) = band_pass.state_space();
        let mut transition = [[0.0; SIZE]; SIZE];
        transition[STATES][STATES] = 1.0;
        for (row, unit) in transition.iter_mut().zip(&unit) {
            row[..STATES].copy_from_slice(unit);
        }
        let mut output = [0.0; SIZE];
        output[..STATES].copy_from_slice(&unit_output);
        let mut gains = [0.0; SIZE];
        gains[STATES] = -FIRST_GAIN;
        for _ in 0..ITERATIONS {
            let cost = cost_to_go(&transition, &output, &gains);
            gains = improved_gains(&transition, &output, &cost);
        }
        Self { gains }
    }

    /// One epoch: the offset of the output, nT.
    pub fn step(&self, state: &mut SteeringState, band_pass: &BandPass) -> f32 {
        let offset = state.offset_nt * self.gains[STATES];
        let moved_nt = offset + state.pending.values().zip(&self.gains).map(|(value, gain)| value * gain).sum::<f32>();
        state.offset_nt += moved_nt;
        state.pending.add_constant(&[-moved_nt]);
        band_pass.step(&mut state.pending, &[0.0]);
        state.offset_nt
    }
}

impl SteeringState {
    /// The coefficients have changed; `columns` are those that `filter` has seen last.
    pub fn change(&mut self, change: &Coefficients, columns: &TermVector, filter: &BandPassState<{ TERMS + 1 }>) {
        self.pending.subtract(filter, change.basis());
        // Less what a constant input makes of it.
        self.pending.add_constant(&[change.predict_nt(columns)]);
    }
}

/// Change of a row, `row * state`, when the offset moves by 1 nT.
fn input_gain(row: &Vector) -> f32 {
    row[STATES] - row[CONSTANT]
}

/// What gains cost from a state on, for ever, as a quadratic form of the state.
fn cost_to_go(transition: &Matrix, output: &Vector, gains: &Vector) -> Matrix {
    // The offset moves by gains * state, then the band-pass goes on.
    let after = |row: &Vector| -> Vector { core::array::from_fn(|j| row[j] + input_gain(row) * gains[j]) };
    let mut closed_loop = transition.each_ref().map(after);
    let (output, offset) = (after(output), closed_loop[STATES]);
    let mut cost: Matrix = core::array::from_fn(|i| {
        let of_epoch =
            |j: usize| output[i] * output[j] + MOVE_PRICE * gains[i] * gains[j] + OFFSET_PRICE * offset[i] * offset[j];
        core::array::from_fn(of_epoch)
    });
    // The sum over twice the time is that over the first half, and the same from where that has led.
    for _ in 0..DOUBLINGS {
        let second = product::<true>(&closed_loop, &product::<false>(&cost, &closed_loop));
        for (row, second) in cost.iter_mut().zip(&second) {
            row.iter_mut().zip(second).for_each(|(cost, second)| *cost += second);
        }
        closed_loop = product::<false>(&closed_loop, &closed_loop);
    }
    cost
}

/// The gains that are best for one epoch, when `cost` is what the state after it costs.
fn improved_gains(transition: &Matrix, output: &Vector, cost: &Matrix) -> Vector {
    let input = transition.each_ref().map(input_gain);
    // Row of the whole cost that belongs to a move.
    let mut row = output.map(|value| input_gain(output) * value);
    row[STATES] += OFFSET_PRICE;
    for (j, cost) in cost.iter().enumerate() {
        let weight: f32 = input.iter().zip(cost).map(|(input, cost)| input * cost).sum();
        row.iter_mut().zip(&transition[j]).for_each(|(row, next)| *row += weight * next);
    }
    let price = MOVE_PRICE + input_gain(&row);
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
                state.pending.add_constant(&[-jump_nt]);
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

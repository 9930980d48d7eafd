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
use nalgebra::{SMatrix, SVector};

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

type Vector = SVector<f32, SIZE>;
type Matrix = SMatrix<f32, SIZE, SIZE>;

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
        let (filter, filter_output) = band_pass.state_space();
        let mut transition = Matrix::zeros();
        transition.fixed_view_mut::<STATES, STATES>(0, 0).copy_from(&filter);
        transition[(STATES, STATES)] = 1.0;
        let mut output = Vector::zeros();
        output.fixed_rows_mut::<STATES>(0).copy_from(&filter_output);
        let mut gains = Vector::zeros();
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
        let moved_nt =
            offset + state.pending.values().iter().zip(&self.gains).map(|(value, gain)| value * gain).sum::<f32>();
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

/// Change of `row' state` when the offset moves by 1 nT.
fn input_gain(row: &Vector) -> f32 {
    row[STATES] - row[CONSTANT]
}

/// Change of the state when the offset moves by 1 nT, of which the band-pass makes its next.
fn input(transition: &Matrix) -> Vector {
    transition.column(STATES) - transition.column(CONSTANT)
}

/// What gains cost from a state on, for ever, as a quadratic form of the state. `f32`; sums over columns in the order
/// of their index. The closed loop is stable, so that its powers decay and the sum is finite.
fn cost_to_go(transition: &Matrix, output: &Vector, gains: &Vector) -> Matrix {
    // The offset moves by gains' state, then the band-pass goes on.
    let mut closed_loop = *transition;
    closed_loop.ger(1.0, &input(transition), gains, 1.0);
    let output = output + gains * input_gain(output);
    let offset = closed_loop.row(STATES).transpose();
    let mut cost = Matrix::zeros();
    for (price, row) in [(1.0, &output), (MOVE_PRICE, gains), (OFFSET_PRICE, &offset)] {
        cost.ger(1.0, &(row * price), row, 1.0);
    }
    // The sum over twice the time is that over the first half, and the same from where that has led.
    for _ in 0..DOUBLINGS {
        let after_half = cost * closed_loop;
        // Not `gemm_tr`: its sums over columns of 17 take half as long again as this.
        cost += closed_loop.transpose() * after_half;
        closed_loop *= closed_loop;
    }
    cost
}

/// The gains that are best for one epoch, when `cost` is what the state after it costs.
fn improved_gains(transition: &Matrix, output: &Vector, cost: &Matrix) -> Vector {
    // Row of the whole cost that belongs to a move.
    let mut row = output * input_gain(output);
    row[STATES] += OFFSET_PRICE;
    for (cost, next) in (cost * input(transition)).iter().zip(transition.row_iter()) {
        row.axpy(*cost, &next.transpose(), 1.0);
    }
    row / -(MOVE_PRICE + input_gain(&row))
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

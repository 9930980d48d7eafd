//! What changing coefficients write into the output, steered out of the band.
//!
//! The output is written once, epoch by epoch, each with the coefficients of its time. Band-passed afterwards it holds
//! what the coefficients have learnt since as an error: 1.1 to 1.3 times what the same coefficients leave of band-passed
//! rows. But the error is known, for it is the difference between what was written and what the coefficients of now would
//! have written, and so is all of it that is still to come out of a band-pass. An offset of the output can therefore be
//! moved such that the least of it comes: a linear-quadratic regulator (Anderson and Moore, "Optimal Control", 1990) whose
//! plant is the band-pass itself.

use super::band_pass::{BandPass, BandPassState, STATES};
use super::{Coefficients, TERMS, TermVector};

/// Price of moving the offset by 1 nT within an epoch, in nT^2 of what is left within the band. Free moves would undo
/// the band-pass, and fill the output with what lies beyond it.
const MOVE_PRICE: f32 = 0.03;

/// Policies that are tried, each better than the one before it; the last ones differ by rounding errors.
const POLICIES: u32 = 12;

/// Doublings of the time over which a policy is judged: 16,384 epochs.
const DOUBLINGS: u32 = 14;

/// The offset's place in the state: where a constant input ends up. See [`BandPassState::steady`].
const OFFSET: usize = 1;

type Matrix = [[f32; STATES]; STATES];

/// Gains of the regulator: immutable.
#[derive(Clone, Copy, Debug)]
pub struct Steering {
    gains: [f32; STATES],
}

/// What a band-pass of the error holds, less what it would hold had the error always been that of now.
#[derive(Clone, Copy, Debug, Default)]
pub struct SteeringState {
    rest: BandPassState<1>,
}

impl Steering {
    /// For an output that is looked at through `band_pass`.
    // Its matrices shall have left the stack before anything large is built.
    #[inline(never)]
    pub fn new(band_pass: &BandPass) -> Self {
        let (transition, output) = band_pass.unit_responses();
        let mut gains = [0.0; STATES];
        for _ in 0..POLICIES {
            let worth = worth(&transition, &output, &gains);
            // Cost of a state once the offset has been moved: what comes out now, and what it is worth after.
            let later = product(&worth, &transition);
            let cost = |i: usize| {
                let column = transition.map(|row| row[OFFSET]);
                output[OFFSET] * output[i] + (0..STATES).map(|j| column[j] * later[j][i]).sum::<f32>()
            };
            let price = MOVE_PRICE + cost(OFFSET);
            gains = core::array::from_fn(|i| cost(i) / price);
        }
        Self { gains }
    }

    /// One epoch: how far the offset of the output moves, nT.
    pub fn step(&self, state: &mut SteeringState, band_pass: &BandPass) -> f32 {
        let moved_nt: f32 = state.rest.values().zip(&self.gains).map(|(value, gain)| value * gain).sum();
        state.rest.shift(&[-moved_nt]);
        band_pass.step(&mut state.rest, &[0.0]);
        moved_nt
    }
}

impl SteeringState {
    /// The coefficients have changed; `columns` are those that `filter` has seen last.
    pub fn change(&mut self, change: &Coefficients, columns: &TermVector, filter: &BandPassState<{ TERMS + 1 }>) {
        let mut weights = [0.0; TERMS + 1];
        let mut input = [0.0; TERMS + 1];
        weights[..TERMS].copy_from_slice(change.basis());
        input[..TERMS].copy_from_slice(columns);
        self.rest.subtract(filter, &input, &weights);
    }
}

/// What a policy costs from a state on, for ever, as a quadratic form.
fn worth(transition: &Matrix, output: &[f32; STATES], gains: &[f32; STATES]) -> Matrix {
    // The offset moves by gains * state, then the band-pass goes on.
    let moved = |row: &[f32; STATES]| -> [f32; STATES] { core::array::from_fn(|j| row[j] - row[OFFSET] * gains[j]) };
    let mut over = transition.each_ref().map(moved);
    let output = moved(output);
    let mut worth: Matrix = core::array::from_fn(|i| {
        core::array::from_fn(|j| output[i] * output[j] + MOVE_PRICE * gains[i] * gains[j])
    });
    // The sum over twice the time is that over the first half, and the same from where that has led.
    for _ in 0..DOUBLINGS {
        let second = transposed_product(&over, &product(&worth, &over));
        for (row, second) in worth.iter_mut().zip(&second) {
            row.iter_mut().zip(second).for_each(|(worth, second)| *worth += second);
        }
        over = product(&over, &over);
    }
    worth
}

/// `a b`.
fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut product = [[0.0; STATES]; STATES];
    for (product, a) in product.iter_mut().zip(a) {
        for (a, b) in a.iter().zip(b) {
            product.iter_mut().zip(b).for_each(|(product, b)| *product += a * b);
        }
    }
    product
}

/// `a' b`.
fn transposed_product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut product = [[0.0; STATES]; STATES];
    for (a, b) in a.iter().zip(b) {
        for (product, a) in product.iter_mut().zip(a) {
            product.iter_mut().zip(b).for_each(|(product, b)| *product += a * b);
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compensation::BandPassDesign;

    /// Sum of squares that comes out of the band-pass after a bump of the error, with and without steering.
    fn energies(design: BandPassDesign) -> [f32; 2] {
        let band_pass = design.build().unwrap();
        let steering = Steering::new(&band_pass);
        [false, true].map(|steers| {
            let (mut offset_nt, mut energy) = (0.0, 0.0);
            let mut watch = BandPassState::steady(&[0.0]);
            let mut state = SteeringState::default();
            for epoch in 0..20_000 {
                // What the coefficients change by jumps, and later jumps back.
                let jump_nt = [(0, 1.0), (7, -0.4), (19, 0.3)].iter().find(|(at, _)| *at == epoch).map_or(0.0, |j| j.1);
                offset_nt += jump_nt;
                state.rest.shift(&[-jump_nt]);
                if steers {
                    offset_nt += steering.step(&mut state, &band_pass);
                }
                let [seen] = band_pass.step(&mut watch, &[offset_nt]);
                energy += seen * seen;
            }
            assert!(offset_nt.is_finite(), "{design:?}: the offset has gone to {offset_nt} nT");
            energy
        })
    }

    #[test]
    fn less_comes_out_of_every_band() {
        for order in 1..=8 {
            for (low_hz, high_hz) in [(0.1, 0.9), (0.02, 0.5), (0.2, 2.0), (0.05, 4.0), (0.5, 0.9)] {
                let design = BandPassDesign { low_hz, high_hz, order, sample_rate_hz: 10.0 };
                let [without, with] = energies(design);
                println!("{design:?}: {without} {with}");
                assert!(with < without, "{design:?}: {with} is no less than {without}");
            }
        }
    }
}

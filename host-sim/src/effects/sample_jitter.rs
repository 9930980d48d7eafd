//! `sample_jitter`: the scalar sensor samples at irregular times. `s'(t) = s(t - e)`, `e ~ N(0, sigma^2)`.

use rand_distr::{Distribution, StandardNormal};

use super::parts::{real, retimed, slope_nt_per_s};
use crate::effects::{Change, Draw, Effect, Kind, Parameter, Search, Spec};
use crate::simulator::signals::Signals;

/// The effect `sample_jitter`.
#[derive(Debug)]
pub struct SampleJitter;

const PARAMETERS: &[Parameter] = &[real("sigma_s", "s", [0.0, 0.5], [0.0005, 0.1], Kind::Spread)];

const SPEC: Spec = Spec {
    name: "sample_jitter",
    title: "jitter of the scalar's sampling times",
    what: "each scalar reading is late or early by a random time",
    origin: "time stamps from an operating system, or a sensor that answers when it finds time",
    source: "stamps of a desktop computer scatter by about 20 ms, hardware stamps by less than 1 ms",
    model: "`s'(t) = s(t - e)`, `e` normal",
    parameters: PARAMETERS,
    random: true,
    search: Search::Variance { starts: &[&[1.0]] },
    injectable: true,
    ..Spec::BASE
};

impl Effect for SampleJitter {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], draw: &mut Draw) -> Change {
        let sigma_s = parameters[0];
        retimed(signals, |_, time_s| {
            let unit: f64 = StandardNormal.sample(draw);
            time_s - sigma_s * unit
        })
    }

    /// To first order: `sigma^2 (ds/dt)^2`.
    fn variance(&self, signals: &Signals, parameters: &[f64]) -> Option<Change> {
        let square = |slope: f64| (parameters[0] * slope).powi(2);
        Some(Change::of_scalar(slope_nt_per_s(signals).into_iter().map(square).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulator::signals::tests::sine_signals;
    use rand::SeedableRng;
    use std::f64::consts::TAU;

    #[test]
    fn the_scatter_is_that_of_the_slope() {
        let signals = sine_signals(20.0, 0.25);
        let sigma_s = 0.01;
        let mut squares = vec![0.0; signals.len()];
        for seed in 0..400 {
            let change = SampleJitter.change(&signals, &[sigma_s], &mut Draw::seed_from_u64(seed));
            squares.iter_mut().zip(change.scalar_nt).for_each(|(sum, nt)| *sum += nt * nt / 400.0);
        }
        let variance = SampleJitter.variance(&signals, &[sigma_s]).unwrap().scalar_nt;
        let slope = |time_s: f64| 20.0 * TAU * 0.25 * (TAU * 0.25 * time_s).cos();
        for (row, time_s) in signals.epochs_s().iter().enumerate() {
            let expected = (sigma_s * slope(*time_s)).powi(2);
            assert!((variance[row] - expected).abs() < 1e-5, "{row}");
            // 400 draws: 7 % of their own scatter; and what curvature adds where the slope is none.
            assert!((squares[row] - expected).abs() < 0.35 * expected + 1e-4, "{row} {} {expected}", squares[row]);
        }
    }
}

//! What the fluxgate's noise leaves in the direction, as draws of it.
//!
//! The smoothing lets more noise through where the body moves, and at the frequencies that it moves with: how much of it, at
//! which moment, follows from nothing but the smoothing itself.

use std::sync::Arc;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use towmag::model::TERMS;

use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::reconstruct::reconstruction::Reconstruction;
use crate::diagnosis::reconstruct::smooth::moving_average;
use crate::simulator::signals::tolles_lawson::{self, Slopes};
use crate::simulator::signals::{Rows, Signals};

/// Draws, and rows that their squares are averaged over: each sample's variance is known to a third from them.
const DRAWS: u64 = 8;
const AVERAGED: usize = 10;

/// Noise of the fluxgate's direction, and what the smoothing leaves of it.
#[derive(Clone, Debug)]
pub(crate) struct DirectionNoise {
    /// Of the recorded direction, rad rms of a component across it.
    recorded_rad: f64,
    draws: Arc<[Draw]>,
}

/// Errors of the smoothed direction, and of its rate, 1/s, at each row.
#[derive(Debug)]
struct Draw {
    direction: Vec<[f64; 3]>,
    rate: Vec<[f64; 3]>,
}

impl DirectionNoise {
    /// Of a recording: as much noise as it has, added to its smoothed direction `smooth`, and smoothed again.
    pub(crate) fn of(table: &Prepared, reconstruction: &Reconstruction, smooth: &Signals) -> Self {
        let recorded_rad = table.direction_noise_rad();
        let draw = |seed: u64| {
            let noisy = noisy(&smooth.rows().direction, table, recorded_rad, &mut ChaCha8Rng::seed_from_u64(seed));
            let field_nt = vec![1.0; table.len()];
            let again = Signals::new(reconstruction.trajectory(table, &noisy, &field_nt), [0.0; TERMS]);
            Draw::between(again.rows(), smooth.rows())
        };
        let is_noisy = recorded_rad > 0.0 && recorded_rad.is_finite();
        Self {
            recorded_rad,
            draws: if is_noisy {
                (0..DRAWS).into_par_iter().map(draw).collect::<Vec<_>>().into()
            } else {
                Arc::default()
            },
        }
    }

    /// Noise of the recorded direction, rad rms of a component across it.
    pub(crate) fn recorded_rad(&self) -> f64 {
        self.recorded_rad
    }

    /// Variance that it has of the interference of a body with some coefficients, in the units of eq. (4), once `of` is made of a
    /// column over the rows, nT: the mean square of the draws, over a second. All 0 of a fluxgate without noise.
    pub(crate) fn variance(
        &self,
        signals: &Signals,
        coefficients: &[f64; TERMS],
        of: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Vec<f64> {
        let share = |nt: Vec<f64>| of(&nt).iter().map(|x| x * x / DRAWS as f64).collect();
        let added = |mut sum: Vec<f64>, more: Vec<f64>| {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
            sum
        };
        let shares = self.interference_nt(signals, coefficients).map(share);
        let sum = shares.reduce(added).unwrap_or_else(|| of(&vec![0.0; signals.len()]));
        moving_average(&sum, AVERAGED)
    }

    /// What each draw adds to the interference of a body with some coefficients, in the units of eq. (4), one value a row, nT.
    pub(crate) fn interference_nt(
        &self,
        signals: &Signals,
        coefficients: &[f64; TERMS],
    ) -> impl Iterator<Item = Vec<f64>> {
        let rows = signals.rows();
        let at_row = |(field_nt, c): (&f64, &[f64; 3])| tolles_lawson::slopes(coefficients, *field_nt, *c);
        let slopes: Vec<Slopes> = rows.field_nt.iter().zip(&rows.direction).map(at_row).collect();
        self.draws.iter().map(move |draw| draw.interference_nt(&slopes))
    }
}

impl Draw {
    fn between(noisy: &Rows, smooth: &Rows) -> Self {
        let less =
            |a: &[[f64; 3]], b: &[[f64; 3]]| a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|k| a[k] - b[k])).collect();
        Self {
            direction: less(&noisy.direction, &smooth.direction),
            rate: less(&noisy.direction_rate, &smooth.direction_rate),
        }
    }

    fn interference_nt(&self, slopes: &[Slopes]) -> Vec<f64> {
        let of_row = |(slopes, (direction, rate)): (&Slopes, (&[f64; 3], &[f64; 3]))| {
            (0..3).map(|k| slopes.by_direction_nt[k] * direction[k] + slopes.by_rate_nt_s[k] * rate[k]).sum()
        };
        slopes.iter().zip(self.direction.iter().zip(&self.rate)).map(of_row).collect()
    }
}

/// Directions with noise of `rad` rms in each component; none where the fluxgate has none.
fn noisy(directions: &[[f64; 3]], table: &Prepared, rad: f64, random: &mut ChaCha8Rng) -> Vec<[f64; 3]> {
    let mut of_row = |(direction, recorded): (&[f64; 3], &[f64; 3])| {
        let noisy = direction.map(|component| {
            let noise: f64 = StandardNormal.sample(random);
            component + rad * noise
        });
        if recorded[0].is_finite() { noisy } else { [f64::NAN; 3] }
    };
    directions.iter().zip(&table.flux_nt).map(&mut of_row).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::diagnosis::reconstruct::tangent_plane::unit;

    const ROWS: usize = 1800;
    const FLUXGATE_NOISE_NT: f64 = 0.5;

    /// Rocked all the time, and shaken at 1 Hz for some seconds about 90 s.
    fn true_direction(time_s: f64) -> [f64; 3] {
        let shaken = 0.03 * (-((time_s - 90.0) / 8.0).powi(2)).exp() * (TAU * time_s).sin();
        let (roll, pitch) = (0.2 * (TAU * 0.15 * time_s).sin() + shaken, 0.1 * (TAU * 0.13 * time_s).cos() + shaken);
        unit([pitch, roll, 1.0])
    }

    fn recorded() -> Prepared {
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let time_s: Vec<f64> = (0..ROWS).map(|row| 0.1 * row as f64).collect();
        let flux_nt =
            time_s.iter().map(|s| true_direction(*s).map(|c| 50_000.0 * c + FLUXGATE_NOISE_NT * draw())).collect();
        Prepared { usable: vec![true; ROWS], flux_nt, time_s, ..Prepared::default() }
    }

    #[test]
    fn the_draws_are_as_loud_as_what_the_smoothing_leaves_and_louder_where_the_body_is_shaken() {
        let table = recorded();
        let reconstruction = Reconstruction::of(&table);
        // Eddy currents of 500 nT per rad/s along one axis.
        let mut coefficients = [0.0; TERMS];
        coefficients[17] = 0.01;
        let field_nt = vec![50_000.0; ROWS];
        let smooth = Signals::new(reconstruction.trajectory(&table, &table.flux_nt, &field_nt), coefficients);
        let noise = DirectionNoise::of(&table, &reconstruction, &smooth);
        let told = noise.variance(&smooth, &coefficients, <[f64]>::to_vec);
        let rms = |rows: std::ops::Range<usize>| {
            let step_s = 1e-3;
            let error = |row: usize| {
                let time_s = table.time_s[row];
                let [before, after] = [-step_s, step_s].map(|off_s| true_direction(time_s + off_s)[2]);
                let slope = tolles_lawson::slopes(&coefficients, 50_000.0, true_direction(time_s)).by_rate_nt_s[2];
                slope * (smooth.rows().direction_rate[row][2] - (after - before) / (2.0 * step_s))
            };
            let count = rows.len() as f64;
            let mean = |of: &dyn Fn(usize) -> f64| (rows.clone().map(of).sum::<f64>() / count).sqrt();
            (mean(&|row| error(row).powi(2)), mean(&|row| told[row]))
        };
        let (still, shaken) = (rms(100..600), rms(850..950));
        for (left_nt, told_nt) in [still, shaken] {
            assert!((0.6..1.6).contains(&(told_nt / left_nt)), "{told_nt} nT told, {left_nt} nT left");
        }
        assert!(shaken.1 > 1.5 * still.1, "{still:?} {shaken:?}");
    }
}

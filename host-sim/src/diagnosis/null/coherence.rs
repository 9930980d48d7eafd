//! Whether the residual of a window follows the motion of that window more than it follows that of others: what is driven by
//! the motion does, in whatever way, and however much of it was taken for noise.

use std::ops::Range;

use nalgebra::SymmetricEigen;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use statrs::statistics::Statistics;

use super::finding::Finding;
use crate::diagnosis::noise::motion::local_columns;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::policy::{COHERENCE_LEAST_WINDOWS, COHERENCE_MOTION_RATIO, COHERENCE_WINDOWS};
use crate::diagnosis::reconstruct::direction_noise::DirectionNoise;
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::regression::products::{dot, gram_of};
use crate::diagnosis::search::log_tail;

/// Windows that a window's motion is held against, at most: evenly spread over the recording.
const MOST_OTHERS: usize = 40;

/// Of a whitened residual of variance 1, which has so many times the variance of the draws of the direction's noise. None where the
/// fluxgate is known to be wrong in other ways too: what the residual has of these follows the motion.
pub(super) fn coherence(
    problem: &RegressionProblem<'_>,
    z: &[f64],
    direction: Option<&DirectionNoise>,
    of_draws: f64,
) -> Finding {
    let Some(direction) = direction else { return Finding { what: "motion", log_p: 0.0, excess: 0.0 } };
    let RegressionProblem { whitening, signals, .. } = problem;
    let columns: Vec<Vec<f64>> = local_columns(signals).iter().map(|column| whitening.apply(column)).collect();
    let least = COHERENCE_MOTION_RATIO * whitened_noise(whitening, signals.len(), direction.recorded_rad());
    let drawn = |nt: Vec<f64>| whitening.apply(&nt.iter().map(|nt| of_draws.sqrt() * nt).collect::<Vec<_>>());
    let coefficients = signals.coefficients();
    let draws: Vec<Vec<f64>> =
        if of_draws > 0.0 { direction.interference_nt(signals, coefficients).map(drawn).collect() } else { Vec::new() };
    let of_length = |&samples: &usize| {
        let of_window = |window: Range<usize>| Moved::of(&columns, window, least);
        of_windows(&windows(&whitening.ranges(), samples).filter_map(of_window).collect::<Vec<_>>(), z, &draws)
    };
    let best = COHERENCE_WINDOWS.iter().map(of_length).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 0.0));
    let (log_p, excess) = (best.0 + (COHERENCE_WINDOWS.len() as f64).ln(), best.1);
    Finding { what: "motion", log_p: log_p.min(0.0), excess }
}

/// Mean square of white noise, one value a row, once it is whitened.
fn whitened_noise(whitening: &Whitening, rows: usize, rms: f64) -> f64 {
    let mut random = ChaCha8Rng::seed_from_u64(0);
    let noise: Vec<f64> = (0..rows).map(|_| StandardNormal.sample(&mut random)).map(|x: f64| rms * x).collect();
    let whitened = whitening.apply(&noise);
    dot(&whitened, &whitened) / whitened.len().max(1) as f64
}

/// Windows of equal length within the blocks.
fn windows(blocks: &[Range<usize>], samples: usize) -> impl Iterator<Item = Range<usize>> {
    let of = move |block: &Range<usize>| {
        let first = block.start;
        (0..block.len() / samples).map(move |k| first + k * samples..first + (k + 1) * samples)
    };
    blocks.iter().flat_map(of)
}

/// A window in which the body moves, and an orthonormal basis of what goes with that.
struct Moved {
    window: Range<usize>,
    basis: Vec<Vec<f64>>,
}

impl Moved {
    /// None where nothing moves: of the combinations of the columns, those whose mean square is below `least` are the noise of
    /// the direction, which the residual has too.
    fn of(columns: &[Vec<f64>], window: Range<usize>, least: f64) -> Option<Self> {
        let parts: Vec<&[f64]> = columns.iter().map(|column| &column[window.clone()]).collect();
        let eigen = SymmetricEigen::new(gram_of(&parts));
        let least = least * window.len() as f64;
        let direction = |k: usize| {
            let size = eigen.eigenvalues[k].sqrt();
            let weights: Vec<f64> = eigen.eigenvectors.column(k).iter().map(|weight| weight / size).collect();
            (0..window.len())
                .map(|row| parts.iter().zip(&weights).map(|(part, weight)| part[row] * weight).sum())
                .collect()
        };
        let basis: Vec<Vec<f64>> = (0..parts.len()).filter(|&k| eigen.eigenvalues[k] > least).map(direction).collect();
        (!basis.is_empty()).then_some(Self { window, basis })
    }

    /// Power that the residual of a window has along this one's motion, for each direction of it.
    fn power(&self, z: &[f64]) -> f64 {
        self.basis.iter().map(|direction| dot(direction, z).powi(2)).sum::<f64>() / self.basis.len() as f64
    }
}

/// Logarithm of the chance, and the power beyond it. The smoothing lets the noise of the direction through at the frequencies that the
/// body moves with: what of `draws` follows a window's motion more than that of others is expected of the residual, too.
fn of_windows(moved: &[Moved], z: &[f64], draws: &[Vec<f64>]) -> (f64, f64) {
    let count = moved.len();
    if count < COHERENCE_LEAST_WINDOWS {
        return (0.0, 0.0);
    }
    let (mut own, mut expected, mut variance) = (0.0, 0.0, 0.0);
    for (at, Moved { window, basis }) in moved.iter().enumerate() {
        let beside = of_others(moved, at, &z[window.clone()]);
        let (mean, spread) = ((&beside).mean(), (&beside).variance());
        let of_draw = |draw: &Vec<f64>| {
            let drawn = &draw[window.clone()];
            moved[at].power(drawn) - of_others(moved, at, drawn).mean()
        };
        let let_through = draws.iter().map(of_draw).sum::<f64>() / draws.len().max(1) as f64;
        let (mean, dimensions) = (mean + let_through.max(0.0), basis.len() as f64);
        own += dimensions * moved[at].power(&z[window.clone()]);
        expected += dimensions * mean;
        // Windows of much the same motion differ by less than noise would.
        variance += (dimensions * dimensions * spread).max(2.0 * dimensions * mean.max(1.0).powi(2));
    }
    // Chi-squared with the mean and the variance that the other windows have.
    let scale = 0.5 * variance / expected.max(f64::MIN_POSITIVE);
    (log_tail(expected / scale, own / scale), own - expected)
}

/// Power that the values of a window have along the motions of other windows.
fn of_others(moved: &[Moved], at: usize, values: &[f64]) -> Vec<f64> {
    let count = moved.len();
    let others = MOST_OTHERS.min(count - 1);
    (0..others).map(|k| moved[(at + 1 + k * (count - 1) / others) % count].power(values)).collect()
}

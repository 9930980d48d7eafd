//! How far the gap shrinks with an effect: on blocks that were held out of the fit of its parameters.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::{Projection, dot};
use crate::diagnosis::regression::term::Term;

/// Parts that are held out in turn.
const FOLDS: usize = 4;
/// Draws of the blocks for the interval.
const DRAWS: usize = 400;

/// Share of the excess that goes with an effect.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct GapClosed {
    /// Share of the excess power above noise, whitened; may be negative.
    pub fraction: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
    /// Measured on blocks that were used neither to choose the effect nor to fit it.
    pub held_out: bool,
}

/// Squares of a block without and with an effect, and what noise alone would have.
#[derive(Clone, Copy, Debug, Default)]
struct Squares {
    before: f64,
    after: f64,
    noise: f64,
}

/// For the term with this index in a fit; `variance` is that of the whitened noise.
pub(crate) fn gap_closed(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    index: usize,
    variance: f64,
    draw: &mut ChaCha8Rng,
) -> GapClosed {
    let blocks = held_out(problem, fit, index, variance);
    let closed = |squares: &Squares| {
        let gone = squares.before - squares.after;
        gone / (squares.before - squares.noise).max(gone.abs()).max(1e-9)
    };
    let total = sum(blocks.iter());
    let mut draws: Vec<f64> = (0..DRAWS)
        .map(|_| closed(&sum((0..blocks.len()).map(|_| &blocks[draw.random_range(0..blocks.len())]))))
        .collect();
    draws.sort_by(f64::total_cmp);
    let fraction = closed(&total);
    // Noise in the held-out blocks moves the share even where every block shows the same.
    let excess = (total.before - total.noise).max(1.0);
    let noise = 1.96 * (2.0 * total.noise.max(0.0) * variance + 4.0 * excess * variance).sqrt() * 0.5 / excess;
    let ci95 = [
        (draws[DRAWS / 40].min(fraction - noise)).max(-5.0).min(fraction),
        (draws[DRAWS - 1 - DRAWS / 40].max(fraction + 0.5 * noise)).min(1.0).max(fraction),
    ];
    GapClosed { fraction, ci95, held_out: blocks.len() > 1 }
}

/// Sum of squares, of whitened noise, that a term of a fit takes away on blocks that its parameters were not fitted to.
pub(crate) fn held_out_gain(problem: &RegressionProblem<'_>, fit: &Fit, index: usize, variance: f64) -> f64 {
    let total = sum(held_out(problem, fit, index, variance).iter());
    total.before - total.after
}

/// The squares of each block, without a term of a fit and with it, its parameters from the other blocks.
fn held_out(problem: &RegressionProblem<'_>, fit: &Fit, index: usize, variance: f64) -> Vec<Squares> {
    let without = problem.fit_held(fit, index);
    let own = problem.own_columns(fit, index);
    let mut signal = problem.whitening.apply(&fit.columns[index]);
    without.project_out(&mut signal);
    let columns = problem.projected(&own, &without);
    // What is left of everything, with the effect's own columns not yet swept.
    let target: Vec<f64> = fit.residual_whitened.clone();
    let ranges = problem.whitening.ranges();
    fold_blocks(&ranges, problem, variance, &columns, &signal, &target)
}

/// For a term found on another recording, its parameters frozen.
pub(crate) fn frozen(problem: &RegressionProblem<'_>, fit: &Fit, term: &Term, variance: f64) -> GapClosed {
    let mut signal = problem.whitening.apply(&term.column(problem.library, &problem.signals));
    fit.projection.project_out(&mut signal);
    let noise = variance * (problem.whitening.dof() - fit.projection.rank() as f64);
    let before = fit.sse();
    let after: f64 = fit.residual_whitened.iter().zip(&signal).map(|(rest, signal)| (rest - signal).powi(2)).sum();
    let gone = before - after;
    let excess = (before - noise).max(gone.abs()).max(1e-9);
    let fraction = gone / excess;
    // Standard error of the gain: the signal's product with noise.
    let half = 1.96 * 2.0 * (variance * dot(&signal, &signal)).sqrt() / excess;
    GapClosed { fraction, ci95: [fraction - half, (fraction + half).min(1.0).max(fraction)], held_out: true }
}

fn sum<'a>(blocks: impl Iterator<Item = &'a Squares>) -> Squares {
    blocks.fold(Squares::default(), |a, b| Squares {
        before: a.before + b.before,
        after: a.after + b.after,
        noise: a.noise + b.noise,
    })
}

fn fold_blocks(
    ranges: &[std::ops::Range<usize>],
    problem: &RegressionProblem<'_>,
    variance: f64,
    columns: &[Vec<f64>],
    signal: &[f64],
    rest: &[f64],
) -> Vec<Squares> {
    let folds = FOLDS.min(ranges.len());
    let mut out = vec![Squares::default(); ranges.len()];
    for fold in 0..folds {
        let training: Vec<bool> = (0..ranges.len()).map(|block| block % folds != fold || folds == 1).collect();
        let cut = |column: &[f64]| -> Vec<f64> {
            ranges
                .iter()
                .zip(&training)
                .filter(|(_, used)| **used)
                .flat_map(|(range, _)| column[range.clone()].iter().copied())
                .collect()
        };
        // How the parameters move when the held-out blocks are not known.
        let rest_there = cut(rest);
        let columns_there: Vec<Vec<f64>> = columns.iter().map(|column| cut(column)).collect();
        let move_by = if columns.is_empty() { Vec::new() } else { Projection::of(&columns_there).solve(&rest_there) };
        let signal_there = cut(signal);
        let glrt = 2.0 * dot(&signal_there, &rest_there) + dot(&signal_there, &signal_there);
        // Without the held-out blocks the effect would not have been chosen.
        let chosen = glrt > 9.0 * variance;
        for (block, range) in ranges.iter().enumerate().filter(|(block, _)| block % folds == fold || folds == 1) {
            let (mut before, mut after) = (0.0, 0.0);
            for k in range.clone() {
                let with = rest[k] - columns.iter().zip(&move_by).map(|(column, by)| column[k] * by).sum::<f64>();
                let without = rest[k] + signal[k];
                before += without * without;
                after += if chosen { with * with } else { without * without };
            }
            out[block] = Squares { before, after, noise: variance * problem.whitening.block_dof(block) };
        }
    }
    out
}

//! How far the gap shrinks with an effect: on parts that were held out of the fit of its parameters.

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp1, StandardNormal};
use serde::Serialize;

use crate::diagnosis::evidence::bootstrap::ci95;
use crate::diagnosis::evidence::folds::{Part, by_unit, spread_parts, training};
use crate::diagnosis::evidence::interval::TWO_SIGMA;
use crate::diagnosis::policy::{FOLD_LEAST_GLRT, HELD_OUT_FOLDS};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::regression::projection::Projection;
use crate::diagnosis::regression::term::Term;

/// Share of the excess that goes with an effect.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct GapClosed {
    /// Share of the excess power above noise, whitened; may be negative.
    pub fraction: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
    /// Measured on parts that were used neither to choose the effect nor to fit it.
    pub held_out: bool,
}

/// Sums of squares of the whitened residual of a block without and with an effect, and what noise alone would have.
#[derive(Clone, Copy, Debug, Default)]
struct Squares {
    before: f64,
    after: f64,
    noise: f64,
}

impl Squares {
    fn sum<'a>(blocks: impl Iterator<Item = &'a Self>) -> Self {
        blocks.fold(Self::default(), |a, b| Self {
            before: a.before + b.before,
            after: a.after + b.after,
            noise: a.noise + b.noise,
        })
    }

    /// The same blocks, each counted so many times.
    fn weighted(blocks: &[Self], mut weight: impl FnMut() -> f64) -> Self {
        blocks.iter().fold(Self::default(), |sum, block| {
            let weight = weight();
            Self {
                before: sum.before + weight * block.before,
                after: sum.after + weight * block.after,
                noise: sum.noise + weight * block.noise,
            }
        })
    }

    /// Reduction of the sum of squares, over the excess.
    fn closed(&self) -> f64 {
        share(self.before - self.after, self.before - self.noise)
    }
}

/// Share of an excess that a reduction takes: no more than all of it, and of none nothing.
pub(crate) fn share(reduction: f64, excess: f64) -> f64 {
    reduction / excess.max(reduction.abs()).max(1e-9)
}

/// Squares of a part without and with something, and what noise alone would have.
pub(crate) struct Halves {
    pub(crate) before: f64,
    pub(crate) after: f64,
    pub(crate) noise: f64,
}

/// The share that goes on parts that were held out, with its interval.
pub(crate) fn closed_of_parts(parts: &[Halves], variance: f64, draw: &mut ChaCha8Rng) -> GapClosed {
    let squares = |part: &Halves| Squares { before: part.before, after: part.after, noise: part.noise };
    let blocks: Vec<Squares> = parts.iter().map(squares).collect();
    let fraction = Squares::sum(blocks.iter()).closed();
    let ci95 = ci95(fraction, || drawn(&blocks, [variance; 2], draw));
    GapClosed { fraction, ci95, held_out: true }
}

/// For the term with this index in a fit; `variances` are that of the whitened noise, and what of it is no gap.
pub(crate) fn gap_closed(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    index: usize,
    variances: [f64; 2],
    draw: &mut ChaCha8Rng,
) -> GapClosed {
    let blocks = held_out(problem, fit, index, variances);
    let fraction = Squares::sum(blocks.iter()).closed();
    let ci95 = ci95(fraction, || drawn(&blocks, variances, draw));
    GapClosed { fraction, ci95, held_out: true }
}

/// The share that goes, drawn once: with blocks of random weights (Bayesian bootstrap, Rubin 1981, which loses no block that
/// holds all of an event), and with what noise makes of the reduction and of its own level.
fn drawn(blocks: &[Squares], [variance, no_gap]: [f64; 2], draw: &mut ChaCha8Rng) -> f64 {
    let unit = |draw: &mut ChaCha8Rng| -> f64 { StandardNormal.sample(draw) };
    let sum = Squares::weighted(blocks, || Exp1.sample(draw));
    let reduction = sum.before - sum.after;
    // Of the signal's product with noise, and of the mean square of so many samples.
    let reduction = reduction + 2.0 * (variance * reduction.abs()).sqrt() * unit(draw);
    let noise = sum.noise + (2.0 * no_gap * sum.noise.max(0.0)).sqrt() * unit(draw);
    share(reduction, sum.before - noise)
}

/// Reduction of the sum of whitened squares by a term of a fit on blocks that its parameters were not fitted to.
pub(crate) fn held_out_gain(problem: &RegressionProblem<'_>, fit: &Fit, index: usize, variance: f64) -> f64 {
    let total = Squares::sum(held_out(problem, fit, index, [variance; 2]).iter());
    total.before - total.after
}

/// The squares without a term of a fit and with it, its parameters from the other parts: of each block, or of each part where
/// a block may hold all of the effect.
fn held_out(problem: &RegressionProblem<'_>, fit: &Fit, index: usize, [variance, no_gap]: [f64; 2]) -> Vec<Squares> {
    let folds = Folds::new(problem, fit, index, variance);
    let corrections: Vec<_> = (0..HELD_OUT_FOLDS).map(|fold| folds.correction(fold)).collect();
    let ranges = problem.whitening.ranges();
    let of_part = |part: &Part| {
        let (before, after) = folds.squares(part, corrections[part.fold].as_deref());
        let share = part.samples.len() as f64 / ranges[part.block].len() as f64;
        Squares { before, after, noise: no_gap * problem.whitening.block_dof(part.block) * share }
    };
    let by_part = folds.parts.iter().map(of_part).collect();
    by_unit(&folds.parts, by_part, |a, b| Squares::sum([a, b].into_iter()))
}

/// For a term found on another recording, its parameters frozen.
pub(crate) fn frozen(problem: &RegressionProblem<'_>, fit: &Fit, term: &Term, variance: f64) -> GapClosed {
    let mut signal = problem.whitening.apply(&term.column(problem.library, &problem.signals));
    fit.projection.project_out(&mut signal);
    let noise = variance * (problem.whitening.dof() - fit.projection.rank() as f64);
    let before = fit.sse();
    let after: f64 = fit.residual_whitened.iter().zip(&signal).map(|(z, signal)| (z - signal).powi(2)).sum();
    let reduction = before - after;
    let excess = (before - noise).max(reduction.abs()).max(1e-9);
    let fraction = reduction / excess;
    // Standard error of the reduction: the signal's product with noise.
    let half_width = TWO_SIGMA * 2.0 * (variance * dot(&signal, &signal)).sqrt() / excess;
    GapClosed {
        fraction,
        ci95: [fraction - half_width, (fraction + half_width).min(1.0).max(fraction)],
        held_out: true,
    }
}

/// Cross-validation of one term: whitened columns over all samples, cut into parts of which each fold holds out some.
struct Folds<'a> {
    parts: Vec<Part>,
    /// Columns of the term's own parameters, everything else projected out.
    columns: Vec<Vec<f64>>,
    /// What the term as fitted adds, everything else projected out.
    signal: Vec<f64>,
    /// Of the whole fit: the effect's own columns are not projected out of it once more.
    residual: &'a [f64],
    /// Of the whitened noise.
    variance: f64,
}

impl<'a> Folds<'a> {
    fn new(problem: &RegressionProblem<'_>, fit: &'a Fit, index: usize, variance: f64) -> Self {
        let without = problem.fit_held(fit, index);
        let mut signal = problem.whitening.apply(&fit.columns[index]);
        without.project_out(&mut signal);
        Self {
            parts: spread_parts(&problem.whitening.ranges(), &signal),
            columns: problem.projected(&problem.own_columns(fit, index), &without),
            signal,
            residual: &fit.residual_whitened,
            variance,
        }
    }

    /// The part of a column that the parameters of a fold are fitted to.
    fn training(&self, column: &[f64], fold: usize) -> Vec<f64> {
        training(&self.parts, column, fold)
    }

    /// How the parameters move when the held-out blocks are not known; `None` where the effect would not have been chosen
    /// without them.
    fn correction(&self, fold: usize) -> Option<Vec<f64>> {
        let residual = self.training(self.residual, fold);
        let signal = self.training(&self.signal, fold);
        let glrt = 2.0 * dot(&signal, &residual) + dot(&signal, &signal);
        let is_chosen = glrt > FOLD_LEAST_GLRT * self.variance;
        if !is_chosen {
            return None;
        }
        if self.columns.is_empty() {
            return Some(Vec::new());
        }
        let columns: Vec<Vec<f64>> = self.columns.iter().map(|column| self.training(column, fold)).collect();
        Some(Projection::of(&columns).solve(&residual))
    }

    /// Sums of the squares of a part without and with the effect, its parameters moved by `correction`.
    fn squares(&self, part: &Part, correction: Option<&[f64]>) -> (f64, f64) {
        let (mut before, mut after) = (0.0, 0.0);
        for k in part.samples.clone() {
            let without = self.residual[k] + self.signal[k];
            let with = correction.map_or(without, |correction| {
                self.residual[k] - self.columns.iter().zip(correction).map(|(column, by)| column[k] * by).sum::<f64>()
            });
            before += without * without;
            after += with * with;
        }
        (before, after)
    }
}

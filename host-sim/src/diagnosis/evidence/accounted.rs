//! How much of the excess power the model of a random effect accounts for, on parts of the recording that it was not
//! fitted to: from epoch to epoch there is nothing to subtract.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::diagnosis::evidence::interval::{TWO_SIGMA, wilson};
use crate::diagnosis::evidence::shrink::GapClosed;
use crate::diagnosis::noise::variance::{VarianceFit, fit_variance, scale};
use crate::diagnosis::search::exact::{Grid, Repeats};
use crate::diagnosis::selection::Selection;

/// Parts that are held out in turn.
const FOLDS: usize = 4;
/// Draws of the blocks for the interval.
const DRAWS: usize = 400;

/// Of an effect that makes the noise larger.
pub(crate) fn by_variance(selection: &Selection<'_>, fitted: &VarianceFit, draw: &mut ChaCha8Rng) -> GapClosed {
    let whitening = &selection.problem.whitening;
    let direction = selection.noise.direction_weights();
    let effects = whitening.weights().iter().zip(&direction).map(|(all, noise)| all / noise);
    let squares: Vec<f64> = selection
        .fit
        .residual_whitened
        .iter()
        .zip(effects)
        .map(|(z, weight)| (z / weight).powi(2) / selection.variance)
        .collect();
    let growth: Vec<f64> = fitted.growth.iter().map(|growth| growth - 1.0).collect();
    let ranges = whitening.ranges();
    let folds = FOLDS.min(ranges.len());
    let mut blocks = vec![[0.0; 2]; ranges.len()];
    for fold in 0..folds {
        let is_held_out = |block: usize| block % folds == fold;
        let training = |values: &[f64]| -> Vec<f64> {
            let used = ranges.iter().enumerate().filter(|(block, _)| folds == 1 || !is_held_out(*block));
            used.flat_map(|(_, range)| values[range.clone()].iter().copied()).collect()
        };
        let (training_squares, training_growth) = (training(&squares), training(&growth));
        let (_, kappa, _) = fit_variance(&training_squares, &training_growth);
        let base = scale(&training_squares, &training_growth, kappa);
        for (block, range) in ranges.iter().enumerate().filter(|(block, _)| is_held_out(*block)) {
            let modelled: f64 = growth[range.clone()].iter().map(|growth| base * kappa * growth).sum();
            let there: f64 = squares[range.clone()].iter().map(|square| square - base).sum();
            blocks[block] = [modelled, there];
        }
    }
    let ratio = |[modelled, there]: [f64; 2]| if there > 0.0 { modelled / there } else { 0.0 };
    let total = |of: &mut dyn Iterator<Item = usize>| {
        of.fold([0.0; 2], |sum, block| [sum[0] + blocks[block][0], sum[1] + blocks[block][1]])
    };
    let mut drawn: Vec<f64> = (0..DRAWS)
        .map(|_| share(ratio(total(&mut (0..blocks.len()).map(|_| draw.random_range(0..blocks.len()))))))
        .collect();
    drawn.sort_by(f64::total_cmp);
    let fraction = share(ratio(total(&mut (0..blocks.len()))));
    let ci95 = [drawn[DRAWS / 40].min(fraction), drawn[DRAWS - 1 - DRAWS / 40].max(fraction)];
    GapClosed { fraction, ci95, held_out: folds > 1 }
}

/// Of repeated readings: what as many repeats as in the other half would do, against what the repeats of a half did.
pub(crate) fn by_repeats(repeats: &Repeats) -> GapClosed {
    let [first, second] = repeats.halves;
    let predicted = first.share() * second.power + second.share() * first.power;
    let there = first.repeated_power + second.repeated_power;
    let ratio = if there > 0.0 { predicted / there } else { 0.0 };
    let half = TWO_SIGMA * (1.0 / first.repeats.max(1.0) + 1.0 / second.repeats.max(1.0)).sqrt();
    let fraction = share(ratio);
    GapClosed { fraction, ci95: [fraction - half, (fraction + half).min(1.0)], held_out: true }
}

/// Of readings on a grid: how many of one half are on the grid of the other.
pub(crate) fn by_grid(grid: &Grid) -> GapClosed {
    GapClosed { fraction: grid.held_out, ci95: wilson(grid.held_out, grid.values as f64), held_out: true }
}

/// A model that predicts too much is as wrong as one that predicts too little.
fn share(ratio: f64) -> f64 {
    1.0 - (1.0 - ratio).abs()
}

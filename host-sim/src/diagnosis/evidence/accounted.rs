//! How much of the excess power the model of a random effect accounts for, on parts of the recording that it was not
//! fitted to: a random effect has no value at an epoch that could be subtracted.

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp1};

use crate::diagnosis::evidence::bootstrap::ci95;
use crate::diagnosis::evidence::folds::{Part, by_unit, spread_parts, training};
use crate::diagnosis::evidence::interval::{TWO_SIGMA, wilson};
use crate::diagnosis::evidence::shrink::GapClosed;
use crate::diagnosis::noise::model::NoiseModel;
use crate::diagnosis::noise::variance::{fit_variance, scale};
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::policy::HELD_OUT_FOLDS;
use crate::diagnosis::search::multiples::QuantisationGrid;
use crate::diagnosis::search::repeats::Repeats;

/// Excess of whitened power as the effect's model has it, and as it was measured.
#[derive(Clone, Copy, Debug, Default)]
struct Excess {
    modelled: f64,
    measured: f64,
}

impl Excess {
    fn sum<'a>(all: impl Iterator<Item = &'a Self>) -> Self {
        all.fold(Self::default(), |sum, other| Self {
            modelled: sum.modelled + other.modelled,
            measured: sum.measured + other.measured,
        })
    }

    /// The same blocks, each counted so many times: the Bayesian bootstrap (Rubin 1981), which loses no block that alone has the
    /// effect.
    fn weighted(blocks: &[Self], mut weight: impl FnMut() -> f64) -> Self {
        blocks.iter().fold(Self::default(), |sum, block| {
            let weight = weight();
            Self { modelled: sum.modelled + weight * block.modelled, measured: sum.measured + weight * block.measured }
        })
    }

    /// 1 when the model has all of it: a model that has twice as much is as wrong as one that has half. Below 0 where one of the
    /// two is.
    fn accounted(&self) -> f64 {
        let ratio = if self.measured > 0.0 { self.modelled / self.measured } else { 0.0 };
        if ratio > 1.0 { 1.0 / ratio } else { ratio }
    }
}

/// What a fit leaves of a channel, whitened.
pub(crate) struct Whitened<'b> {
    pub(crate) whitening: &'b Whitening,
    pub(crate) noise: &'b NoiseModel,
    pub(crate) residual_whitened: &'b [f64],
    /// Variance of the whitened noise.
    pub(crate) variance: f64,
}

/// Of an effect that makes the noise larger, one of those that the noise model has, beside the others.
pub(crate) fn by_variance(channel: &Whitened<'_>, random: usize, draw: &mut ChaCha8Rng) -> GapClosed {
    let others = channel.noise.added_by(|other| other != random);
    let of_others = |value: f64, others: &f64| value / (1.0 + others);
    let left = left_before(channel);
    let squares: Vec<f64> = left.iter().zip(&others).map(|(z, others)| of_others(z * z, others)).collect();
    let own = channel.noise.added_by(|other| other == random);
    let added: Vec<f64> = own.iter().zip(&others).map(|(added, others)| of_others(*added, others)).collect();
    let blocks = held_out(&squares, &added, &channel.whitening.ranges());
    let fraction = Excess::sum(blocks.iter()).accounted();
    let ci95 = ci95(fraction, || Excess::weighted(&blocks, || Exp1.sample(draw)).accounted());
    GapClosed { fraction, ci95, held_out: true }
}

/// The whitened residual, of noise 1, as it is without the weights that random effects ask for.
pub(crate) fn left_before(channel: &Whitened<'_>) -> Vec<f64> {
    let weights = channel.whitening.weights();
    let direction = channel.noise.direction_weights();
    let by_effects = weights.iter().zip(&direction).map(|(all, noise)| all / noise);
    let residual = channel.residual_whitened.iter();
    residual.zip(by_effects).map(|(z, weight)| z / weight / channel.variance.sqrt()).collect()
}

/// The excess of each block, or of each part where a block may hold all of the effect, the variance fitted to the other parts. `added`
/// is the course of the added variance, one a sample.
fn held_out(squares: &[f64], added: &[f64], ranges: &[std::ops::Range<usize>]) -> Vec<Excess> {
    let parts = spread_parts(ranges, added);
    let fitted = |fold: usize| {
        let (squares, added) = (training(&parts, squares, fold), training(&parts, added, fold));
        let kappa = fit_variance(&squares, &added).kappa;
        (scale(&squares, &added, kappa), kappa)
    };
    let folds: Vec<(f64, f64)> = (0..HELD_OUT_FOLDS).map(fitted).collect();
    let of_part = |part: &Part| {
        let (base, kappa) = folds[part.fold];
        Excess {
            modelled: added[part.samples.clone()].iter().map(|added| base * kappa * added).sum(),
            measured: squares[part.samples.clone()].iter().map(|square| square - base).sum(),
        }
    };
    by_unit(&parts, parts.iter().map(of_part).collect(), |a, b| Excess::sum([a, b].into_iter()))
}

/// Of repeated readings: what as many repeats as in the other half would do, against what the repeats of a half did.
pub(crate) fn by_repeats(repeats: &Repeats) -> GapClosed {
    let [first, second] = repeats.halves;
    let excess = Excess {
        modelled: first.share() * second.power + second.share() * first.power,
        measured: first.repeated_power + second.repeated_power,
    };
    let half_width = TWO_SIGMA * (1.0 / first.repeats.max(1.0) + 1.0 / second.repeats.max(1.0)).sqrt();
    let fraction = excess.accounted();
    GapClosed { fraction, ci95: [(fraction - half_width).max(0.0), (fraction + half_width).min(1.0)], held_out: true }
}

/// Of a quantised fluxgate: how many values of one half are on the grid of the other.
pub(crate) fn by_grid(grid: &QuantisationGrid) -> GapClosed {
    GapClosed { fraction: grid.held_out, ci95: wilson(grid.held_out, grid.values as f64), held_out: true }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::StandardNormal;

    use super::*;

    #[test]
    fn what_is_louder_in_one_block_alone_is_accounted_for() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let (ranges, loud) = ([0..300, 300..600, 600..900], 400..470);
        let added: Vec<f64> = (0..900).map(|k| f64::from(u8::from(loud.contains(&k)))).collect();
        let square = |added: &f64| {
            let z: f64 = StandardNormal.sample(&mut random);
            z * z * (1.0 + 30.0 * added)
        };
        let squares: Vec<f64> = added.iter().map(square).collect();
        let units = held_out(&squares, &added, &ranges);
        let accounted = Excess::sum(units.iter()).accounted();
        assert!(units.len() > ranges.len() && accounted > 0.7, "{} {accounted}", units.len());
        let elsewhere: Vec<f64> = (0..900).map(|k| f64::from(u8::from((600..670).contains(&k)))).collect();
        assert!(Excess::sum(held_out(&squares, &elsewhere, &ranges).iter()).accounted() < 0.3);
    }
}

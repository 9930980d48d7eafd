//! What of a noise model is noise of the direction, and how far that may be wrong.

use super::model::{NoiseModel, weights_of};
use crate::diagnosis::numerics::coefficient_of_variation;
use crate::diagnosis::policy::NOISE_DENSITY_RATIO;

impl NoiseModel {
    /// Growth of each sample's variance by the noise of the direction, of mean 1.
    pub(crate) fn direction_growth(&self) -> Option<&[f64]> {
        self.direction.as_ref().map(|direction| direction.growth.as_slice())
    }

    /// Variance of the noise of the direction, over that of its draws.
    pub(crate) fn of_draws(&self) -> f64 {
        self.direction.as_ref().map_or(0.0, |direction| direction.of_draws)
    }

    /// Coefficient of variation of the samples' variance by the noise of the direction.
    pub(crate) fn variance_cv(&self) -> f64 {
        self.direction_growth().map_or(0.0, coefficient_of_variation)
    }

    /// Share of the variance of each sample that is noise of the direction: what the quietest sample has is not.
    pub(crate) fn direction_share(&self) -> Vec<f64> {
        let Some(growth) = self.direction_growth() else { return vec![0.0; self.whitening.samples()] };
        let least = growth.iter().copied().fold(f64::INFINITY, f64::min);
        growth.iter().map(|growth| 1.0 - least / growth).collect()
    }

    /// How much denser the noise may be than this model has it where some whitened columns are, as a share of its variance: the noise of the
    /// direction is coloured by what is let through of it. By the share of the columns' power that lies where the noise is that.
    pub(crate) fn denser(&self, columns: &[Vec<f64>]) -> f64 {
        let variance_cv = self.variance_cv();
        if variance_cv == 0.0 {
            return 0.0;
        }
        let share = self.direction_share();
        let powers = columns.iter().flat_map(|column| column.iter().map(|x| x * x).zip(&share));
        let (all, of_direction) =
            powers.fold((0.0, 0.0), |(all, part), (power, share)| (all + power, part + share * power));
        NOISE_DENSITY_RATIO * (of_direction / all.max(f64::MIN_POSITIVE)).min(variance_cv)
    }

    /// Weights of the samples by the noise of the direction alone, without any effect.
    pub(crate) fn direction_weights(&self) -> Vec<f64> {
        self.direction_growth().map_or_else(|| vec![1.0; self.whitening.samples()], weights_of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::noise::blocks::Block;
    use crate::diagnosis::noise::direction::DirectionGrowth;

    #[test]
    fn only_what_lies_where_the_direction_is_noisy_may_have_denser_noise() {
        let block = Block { rows: 0..400, missing: Vec::new(), targets: Vec::new() };
        let quiet = NoiseModel::white(&[block]);
        let samples = quiet.whitening.samples();
        let is_loud = |k: usize| k < samples / 4;
        let growth = (0..samples).map(|k| if is_loud(k) { 3.7 } else { 0.1 }).collect();
        let direction = Some(DirectionGrowth { growth, of_draws: 1.0 });
        let mut loud = quiet.clone();
        loud.direction = direction;
        let column =
            |is_there: &dyn Fn(usize) -> bool| vec![(0..samples).map(|k| f64::from(u8::from(is_there(k)))).collect()];
        assert_eq!(quiet.denser(&column(&is_loud)), 0.0);
        assert_eq!(loud.denser(&column(&|k| !is_loud(k))), 0.0);
        // 1 - 0.1 / 3.7 of the noise there is the direction's.
        let there = loud.denser(&column(&is_loud));
        assert!((there - NOISE_DENSITY_RATIO * (1.0 - 0.1 / 3.7)).abs() < 1e-9, "{there}");
        let everywhere = loud.denser(&column(&|_| true));
        assert!((everywhere - 0.25 * there).abs() < 0.02 * there, "{everywhere} {there}");
    }
}

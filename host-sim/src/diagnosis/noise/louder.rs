//! Whether samples are louder where an effect would make them so, whatever the distribution of the noise: by the ranks of their
//! differences, which heavy tails and a wrong edge of the effect do not bend, nor anything that lasts longer than a row. Ranks do not
//! know by how much: which of several courses the loudness has is told by the differences themselves, as if they had heavy tails.

use statrs::distribution::{ContinuousCDF, Normal};

use super::courses::{Courses, Fitted, Tails};
use crate::diagnosis::numerics::median;

/// By how much the squares of successive differences of white noise spread more, summed up over many, than if they were independent:
/// derived from their correlation, 1/4 on either side.
const SPREAD_OF_DIFFERENCES: f64 = 1.5;

/// Share of the median of the squares that is added to each of them: differences that are nothing but rounding may be 0.
const LEAST_SQUARE: f64 = 1e-4;

/// Squares of the differences of successive samples, and what is known to make them louder anyhow.
pub(crate) struct Differences {
    /// None of them 0.
    squares: Vec<f64>,
    /// Those of normal values of the same ranks (van der Waerden's scores).
    squared_scores: Vec<f64>,
    /// Logarithms of growths, one value a sample.
    known: Vec<Vec<f64>>,
    /// With the likeliest powers of what is known, of the scores.
    deviance: f64,
}

impl Differences {
    /// Of a whitened residual; growths that are `known` are given by their logarithms, one value a sample.
    pub(crate) fn of(whitened: &[f64], known: Vec<Vec<f64>>) -> Self {
        // Of white noise their mean is its variance.
        let square = |k: usize| 0.5 * (whitened[k] - whitened[k.saturating_sub(1)]).powi(2);
        let squares: Vec<f64> = (0..whitened.len()).map(square).collect();
        let squared_scores = squared_normal_scores(&squares);
        let least = LEAST_SQUARE * median(squares.clone());
        let squares = squares.into_iter().map(|square| square + least).collect();
        let Fitted { deviance, .. } = Courses::of(&known, whitened.len()).fitted(&squared_scores, Tails::Normal);
        Self { squares, squared_scores, known, deviance }
    }

    /// Squares of normal values of the same ranks.
    pub(crate) fn squared_scores(&self) -> &[f64] {
        &self.squared_scores
    }

    /// Twice the logarithm of the likelihood ratio, by ranks, of a variance that goes with a power of a growth, given by its logarithm,
    /// over one that does not; 0 where it goes against it.
    pub(crate) fn glrt(&self, growth: Vec<f64>) -> f64 {
        let with = self.with(vec![growth]).fitted(&self.squared_scores, Tails::Normal);
        let glrt = ((self.deviance - with.deviance) / SPREAD_OF_DIFFERENCES).max(0.0);
        if with.powers[self.known.len() + 1] > 0.0 { glrt } else { 0.0 }
    }

    /// Minus twice the log likelihood, up to a constant, of some courses together, up or down, by the differences themselves.
    pub(crate) fn deviance_of(&self, courses: Vec<Vec<f64>>) -> f64 {
        self.with(courses).fitted(&self.squares, Tails::Heavy).deviance / SPREAD_OF_DIFFERENCES
    }

    fn with(&self, courses: Vec<Vec<f64>>) -> Courses {
        let all: Vec<Vec<f64>> = self.known.iter().cloned().chain(courses).collect();
        Courses::of(&all, self.squares.len())
    }
}

/// Squares of the normal values of the same ranks by size.
fn squared_normal_scores(squares: &[f64]) -> Vec<f64> {
    let mut by_size: Vec<usize> = (0..squares.len()).collect();
    by_size.sort_by(|&a, &b| squares[a].total_cmp(&squares[b]));
    let normal = Normal::standard();
    let mut scores = vec![0.0; squares.len()];
    for (rank, sample) in by_size.into_iter().enumerate() {
        let share_below = (rank as f64 + 0.5) / squares.len() as f64;
        scores[sample] = normal.inverse_cdf(0.5 + 0.5 * share_below).powi(2);
    }
    scores
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StudentT};

    use super::*;

    const SAMPLES: usize = 2400;
    const LOUD: std::ops::Range<usize> = 900..1300;

    /// Noise with heavy tails.
    fn noise(seed: u64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let tails = StudentT::new(3.0).unwrap();
        (0..SAMPLES).map(|_| tails.sample(&mut random)).collect()
    }

    /// Logarithm of a growth by 4 in some samples.
    fn grown(rows: std::ops::Range<usize>) -> Vec<f64> {
        (0..SAMPLES).map(|k| if rows.contains(&k) { 4.0_f64.ln() } else { 0.0 }).collect()
    }

    fn louder(mut values: Vec<f64>, growth: &[f64]) -> Vec<f64> {
        values.iter_mut().zip(growth).for_each(|(value, log)| *value *= (0.5 * log).exp());
        values
    }

    #[test]
    fn the_chance_of_heavy_tails_to_be_louder_somewhere_is_that_of_chi_squared() {
        let of = |seed: u64| Differences::of(&noise(seed), Vec::new()).glrt(grown(LOUD));
        // Half of the time it is quieter, which is no chance to be louder.
        let beyond = (0..400).filter(|seed| of(*seed) > 2.71).count();
        assert!((8..=34).contains(&beyond), "{beyond} of 400 where 20 are expected");
    }

    #[test]
    fn a_variance_that_grows_is_found_in_heavy_tails_and_not_where_it_is_known() {
        let values = louder(noise(1), &grown(LOUD));
        let found = Differences::of(&values, Vec::new());
        let known = Differences::of(&values, vec![grown(LOUD)]);
        assert!(found.glrt(grown(LOUD)) > 100.0);
        assert_eq!(found.glrt(grown(LOUD).iter().map(|log| -log).collect()), 0.0);
        assert!(known.glrt(grown(850..1350)) < 12.0);
        // The same course says nothing new.
        assert!(known.glrt(grown(LOUD)) < 1e-3);
    }

    #[test]
    fn what_lasts_is_no_noise() {
        let hump = |k: usize| 20.0 * (-((k as f64 - 1100.0) / 60.0).powi(2)).exp();
        let values: Vec<f64> = noise(2).iter().enumerate().map(|(k, value)| value + hump(k)).collect();
        assert!(Differences::of(&values, Vec::new()).glrt(grown(LOUD)) < 10.0);
    }
}

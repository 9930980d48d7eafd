//! Whether samples are louder where an effect would make them so, whatever the distribution of the noise: by the ranks of their
//! differences, which heavy tails and a wrong edge of the effect do not bend, nor anything that lasts longer than a row.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, Normal};

/// Newton steps at most, and the gain of the deviance below which they end.
const STEPS: usize = 30;
const LEAST_GAIN: f64 = 1e-3;
/// How often a step that gains nothing is halved.
const HALVINGS: usize = 12;
/// Added to the curvature, as a share of the number of samples, so that courses that say the same do no harm.
const RIDGE: f64 = 1e-9;

/// By how much the squares of successive differences of white noise spread more, summed up over many, than if they were independent:
/// derived from their correlation, 1/4 on either side.
const SPREAD_OF_DIFFERENCES: f64 = 1.5;

/// Squares of the differences of successive samples, as those of normal values of the same ranks (van der Waerden's scores), and what is
/// known to make them louder anyhow.
pub(crate) struct Differences {
    squared_scores: Vec<f64>,
    /// Logarithms of growths, one value a sample.
    known: Vec<Vec<f64>>,
    /// With the likeliest powers of what is known.
    deviance: f64,
}

impl Differences {
    /// Of a whitened residual; growths that are `known` are given by their logarithms, one value a sample.
    pub(crate) fn of(whitened: &[f64], known: Vec<Vec<f64>>) -> Self {
        let square = |k: usize| (whitened[k] - whitened[k.saturating_sub(1)]).powi(2);
        let squared_scores = squared_normal_scores(&(0..whitened.len()).map(square).collect::<Vec<f64>>());
        let Fitted { deviance, .. } = Courses::of(&known, whitened.len()).fitted(&squared_scores);
        Self { squared_scores, known, deviance }
    }

    /// Twice the logarithm of the likelihood ratio of a variance that goes with a power of a growth, given by its logarithm, over one that
    /// does not; 0 where it goes against it.
    pub(crate) fn glrt(&self, growth: Vec<f64>) -> f64 {
        let (glrt, powers) = self.glrt_and_powers(vec![growth]);
        if powers[self.known.len() + 1] > 0.0 { glrt } else { 0.0 }
    }

    /// The same of some courses together, up or down.
    pub(crate) fn glrt_of_any(&self, courses: Vec<Vec<f64>>) -> f64 {
        self.glrt_and_powers(courses).0
    }

    fn glrt_and_powers(&self, courses: Vec<Vec<f64>>) -> (f64, DVector<f64>) {
        let all: Vec<Vec<f64>> = self.known.iter().cloned().chain(courses).collect();
        let with = Courses::of(&all, self.squared_scores.len()).fitted(&self.squared_scores);
        (((self.deviance - with.deviance) / SPREAD_OF_DIFFERENCES).max(0.0), with.powers)
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

/// A constant and the logarithms of growths, a column each.
struct Courses(DMatrix<f64>);

/// Normal samples whose variance is a product of powers.
struct Fitted {
    powers: DVector<f64>,
    /// Minus twice the log likelihood, up to a constant.
    deviance: f64,
}

impl Courses {
    fn of(logs: &[Vec<f64>], samples: usize) -> Self {
        let at = |sample: usize, course: usize| if course == 0 { 1.0 } else { logs[course - 1][sample] };
        Self(DMatrix::from_fn(samples, logs.len() + 1, at))
    }

    /// The likeliest powers, by Fisher scoring.
    fn fitted(&self, squares: &[f64]) -> Fitted {
        let Self(courses) = self;
        let mut curvature = courses.tr_mul(courses);
        (0..curvature.nrows()).for_each(|k| curvature[(k, k)] += RIDGE * squares.len() as f64);
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        let mut powers = DVector::zeros(courses.ncols());
        powers[0] = mean.max(f64::MIN_POSITIVE).ln();
        let mut best = Fitted { deviance: self.deviance(&powers, squares), powers };
        let Some(curvature) = curvature.cholesky() else { return best };
        for _ in 0..STEPS {
            let step = curvature.solve(&courses.tr_mul(&self.excess(&best.powers, squares)));
            let tried = (0..HALVINGS).map(|k| &best.powers + 0.5_f64.powi(k as i32) * &step);
            let mut tried = tried.map(|powers| Fitted { deviance: self.deviance(&powers, squares), powers });
            let Some(next) = tried.find(|next| next.deviance < best.deviance) else { break };
            let gain = best.deviance - next.deviance;
            best = next;
            if gain < LEAST_GAIN {
                break;
            }
        }
        best
    }

    /// By how much each square is above its variance, as a share of that.
    fn excess(&self, powers: &DVector<f64>, squares: &[f64]) -> DVector<f64> {
        let log_variances = &self.0 * powers;
        DVector::from_iterator(
            squares.len(),
            squares.iter().zip(log_variances.iter()).map(|(square, log)| square * (-log).exp() - 1.0),
        )
    }

    fn deviance(&self, powers: &DVector<f64>, squares: &[f64]) -> f64 {
        let log_variances = &self.0 * powers;
        squares.iter().zip(log_variances.iter()).map(|(square, log)| log + square * (-log).exp()).sum()
    }
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

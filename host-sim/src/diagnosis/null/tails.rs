//! Noise with heavy tails as normal noise: what is rare in it is rare still, but no longer a surprise.

use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};
use statrs::function::gamma::ln_gamma;

use crate::diagnosis::policy::{HEAVY_TAILS_LEAST_GAIN, TAIL_DEGREES, TWO_KINDS_LEAST_GAIN};

/// Rounds in which the scale is fitted.
const ROUNDS: usize = 30;
/// Rounds in which two kinds of values are told apart, from this share of few and these variances over that of all.
const TWO_KINDS_ROUNDS: usize = 60;
const TWO_KINDS_START: (f64, [f64; 2]) = (0.03, [0.7, 10.0]);
/// Values that one thread takes at once.
const AT_ONCE: usize = 1000;

/// Values whose distribution is Student's, with the degrees of freedom that are likeliest, as the normal values of the same
/// chance. As they are where normal ones are as likely, or two kinds of them, few large ones beside many small: noise with
/// heavy tails has all sizes, and what happens now and then is no noise. Independent values of mean 0 and about one size.
pub(crate) fn normal_scores(values: &[f64]) -> Vec<f64> {
    match heavy_tails(values) {
        Some(fitted) => values.par_iter().map(|value| fitted.score(*value)).collect(),
        None => values.to_vec(),
    }
}

/// Mean square of values whose distribution is Student's, as that says: that of a few draws wanders; none where normal values are as
/// likely, or two kinds of them.
pub(crate) fn mean_square_of_heavy_tails(values: &[f64]) -> Option<f64> {
    heavy_tails(values).map(|fitted| fitted.scale * fitted.scale * fitted.degrees / (fitted.degrees - 2.0))
}

/// The likeliest Student's distribution; none where normal values are as likely, or two kinds of them.
fn heavy_tails(values: &[f64]) -> Option<Fitted> {
    let best = TAIL_DEGREES
        .into_par_iter()
        .map(|degrees| Fitted::of(values, degrees))
        .max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood));
    best.filter(|fitted| {
        fitted.log_likelihood > normal_log_likelihood(values) + HEAVY_TAILS_LEAST_GAIN
            && fitted.log_likelihood > two_kinds_log_likelihood(values) - TWO_KINDS_LEAST_GAIN
    })
}

/// Of the likeliest variance.
fn normal_log_likelihood(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean_square = values.iter().map(|x| x * x).sum::<f64>() / n.max(1.0);
    -0.5 * n * (1.0 + (std::f64::consts::TAU * mean_square.max(f64::MIN_POSITIVE)).ln())
}

/// Of normal values of the likeliest two variances, of which the larger is a few values'. By expectation maximisation.
fn two_kinds_log_likelihood(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean_square = values.iter().map(|x| x * x).sum::<f64>() / n;
    let (mut share, mut squares) = (TWO_KINDS_START.0, TWO_KINDS_START.1.map(|ratio| ratio * mean_square));
    for _ in 0..TWO_KINDS_ROUNDS {
        let is_few = |x: &f64| {
            let [of_many, of_few] = densities(*x, share, squares);
            of_few / (of_many + of_few).max(f64::MIN_POSITIVE)
        };
        let is_few: Vec<f64> = values.par_iter().with_min_len(AT_ONCE).map(is_few).collect();
        let (mut few, mut sums) = (0.0, [0.0; 2]);
        for (x, is_few) in values.iter().zip(is_few) {
            few += is_few;
            sums[0] += (1.0 - is_few) * x * x;
            sums[1] += is_few * x * x;
        }
        share = (few / n).clamp(1.0 / n, 0.5);
        squares = [sums[0] / (n - few).max(1.0), sums[1] / few.max(1.0)].map(|square| square.max(f64::MIN_POSITIVE));
    }
    values.iter().map(|x| densities(*x, share, squares).iter().sum::<f64>().max(f64::MIN_POSITIVE).ln()).sum()
}

/// Of the many and of the few.
fn densities(x: f64, share_of_few: f64, squares: [f64; 2]) -> [f64; 2] {
    let normal = |square: f64| (-0.5 * x * x / square).exp() / (std::f64::consts::TAU * square).sqrt();
    [(1.0 - share_of_few) * normal(squares[0]), share_of_few * normal(squares[1])]
}

/// Student's distribution with its likeliest scale.
struct Fitted {
    degrees: f64,
    scale: f64,
    log_likelihood: f64,
}

impl Fitted {
    /// By expectation maximisation: each value weighs the less the further out it is.
    fn of(values: &[f64], degrees: f64) -> Self {
        let n = values.len().max(1) as f64;
        let mut square = 1.0;
        for _ in 0..ROUNDS {
            let weighed = |x: &f64| x * x * (degrees + 1.0) / (degrees + x * x / square);
            square = (values.iter().map(weighed).sum::<f64>() / n).max(f64::MIN_POSITIVE);
        }
        let peak = ln_gamma(0.5 * (degrees + 1.0))
            - ln_gamma(0.5 * degrees)
            - 0.5 * (degrees * std::f64::consts::PI * square).ln();
        let fall = |x: &f64| 0.5 * (degrees + 1.0) * (x * x / (degrees * square)).ln_1p();
        Self { degrees, scale: square.sqrt(), log_likelihood: n * peak - values.iter().map(fall).sum::<f64>() }
    }

    /// The normal value of the same chance.
    fn score(&self, value: f64) -> f64 {
        let (Ok(student), Ok(normal)) = (StudentsT::new(0.0, self.scale, self.degrees), Normal::new(0.0, 1.0)) else {
            return value;
        };
        // The lower tail keeps its digits.
        let below = student.cdf(-value.abs()).max(1e-300);
        (-normal.inverse_cdf(below)).copysign(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal, StudentT};

    fn moments(values: &[f64]) -> (f64, f64) {
        let mean = |power: i32| values.iter().map(|x| x.powi(power)).sum::<f64>() / values.len() as f64;
        (mean(2), mean(4) / mean(2).powi(2))
    }

    #[test]
    fn heavy_tails_become_normal_and_normal_values_stay() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for degrees in [3.0, 4.5] {
            let tails = StudentT::new(degrees).unwrap();
            let values: Vec<f64> = (0..6000).map(|_| tails.sample(&mut random)).collect();
            let (square, kurtosis) = moments(&normal_scores(&values));
            assert!((square - 1.0).abs() < 0.08 && (kurtosis - 3.0).abs() < 0.4, "{degrees}: {square} {kurtosis}");
        }
        let values: Vec<f64> = (0..6000).map(|_| StandardNormal.sample(&mut random)).collect();
        assert_eq!(normal_scores(&values), values);
    }

    #[test]
    fn the_mean_square_of_heavy_tails_is_that_of_all_values_and_of_normal_ones_none_is_told() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        for degrees in [4.0, 6.0] {
            let tails = StudentT::new(degrees).unwrap();
            let values: Vec<f64> = (0..20_000).map(|_| tails.sample(&mut random)).collect();
            let told = mean_square_of_heavy_tails(&values).expect("heavy tails");
            assert!((told / (degrees / (degrees - 2.0)) - 1.0).abs() < 0.1, "{degrees}: {told}");
        }
        let values: Vec<f64> = (0..6000).map(|_| StandardNormal.sample(&mut random)).collect();
        assert_eq!(mean_square_of_heavy_tails(&values), None);
    }

    #[test]
    fn signs_and_order_stay() {
        let fitted = Fitted { degrees: 3.0, scale: 1.0, log_likelihood: 0.0 };
        let scores: Vec<f64> = [-50.0, -2.0, -0.1, 0.1, 2.0, 50.0].into_iter().map(|x| fitted.score(x)).collect();
        assert!(scores.windows(2).all(|pair| pair[0] < pair[1]), "{scores:?}");
        assert!((scores[0] + scores[5]).abs() < 1e-9 && scores[5] > 3.5 && scores[5] < 5.5, "{scores:?}");
    }

    #[test]
    fn a_few_large_values_beside_normal_ones_are_no_heavy_tails() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(4);
        let mut values: Vec<f64> = (0..2000).map(|_| StandardNormal.sample(&mut random)).collect();
        values.iter_mut().step_by(100).for_each(|x: &mut f64| *x += 6.0_f64.copysign(*x));
        assert_eq!(normal_scores(&values), values);
    }

    #[test]
    fn what_switches_now_and_then_stays_a_surprise() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        let mut values: Vec<f64> = (0..6000).map(|_| StandardNormal.sample(&mut random)).collect();
        values.iter_mut().step_by(60).for_each(|x| *x += 12.0);
        let (_, kurtosis) = moments(&normal_scores(&values));
        // Of 6,000 normal values it is 3.00 give or take 0.06.
        assert!(kurtosis > 3.36, "{kurtosis}");
    }
}

//! Samples about 0 whose variance is a product of powers of known courses, fitted to their squares.

use nalgebra::{DMatrix, DVector};

/// Newton steps at most, and the gain of the deviance below which they end.
const STEPS: usize = 60;
const LEAST_GAIN: f64 = 1e-3;
/// How often a step that gains nothing is halved.
const HALVINGS: usize = 12;
/// Added to the curvature, as a share of the number of samples, so that courses that say the same do no harm.
const RIDGE: f64 = 1e-9;
/// Degrees of freedom of Student's t, which stands for heavy tails. Set by hand.
const FREEDOM: f64 = 4.0;

/// How samples are distributed about their variance.
#[derive(Clone, Copy, Debug)]
pub(super) enum Tails {
    Normal,
    /// Student's t.
    Heavy,
}

impl Tails {
    /// Minus twice the log likelihood, up to a constant, of a square over its variance.
    fn deviance(self, ratio: f64) -> f64 {
        match self {
            Self::Normal => ratio,
            Self::Heavy => (FREEDOM + 1.0) * (ratio / FREEDOM).ln_1p(),
        }
    }

    /// By how much the variance should be larger, as a share of it: twice the slope of the log likelihood by its logarithm.
    fn excess(self, ratio: f64) -> f64 {
        match self {
            Self::Normal => ratio - 1.0,
            Self::Heavy => (FREEDOM + 1.0) * ratio / (FREEDOM + ratio) - 1.0,
        }
    }

    /// Expected slope of the excess over that of normal samples.
    fn information(self) -> f64 {
        match self {
            Self::Normal => 1.0,
            Self::Heavy => FREEDOM / (FREEDOM + 3.0),
        }
    }
}

/// A constant and the logarithms of growths, a column each.
pub(super) struct Courses(DMatrix<f64>);

/// Samples whose variance is a product of powers.
pub(super) struct Fitted {
    /// Of the constant, and of each course.
    pub(super) powers: DVector<f64>,
    /// Minus twice the log likelihood, up to a constant.
    pub(super) deviance: f64,
}

impl Courses {
    pub(super) fn of(logs: &[Vec<f64>], samples: usize) -> Self {
        let at = |sample: usize, course: usize| if course == 0 { 1.0 } else { logs[course - 1][sample] };
        Self(DMatrix::from_fn(samples, logs.len() + 1, at))
    }

    /// The likeliest powers, by Fisher scoring.
    pub(super) fn fitted(&self, squares: &[f64], tails: Tails) -> Fitted {
        let Self(courses) = self;
        let mut curvature = courses.tr_mul(courses) * tails.information();
        (0..curvature.nrows()).for_each(|k| curvature[(k, k)] += RIDGE * squares.len() as f64);
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        let mut powers = DVector::zeros(courses.ncols());
        powers[0] = mean.max(f64::MIN_POSITIVE).ln();
        let at = |powers: DVector<f64>| Fitted { deviance: self.deviance(&powers, squares, tails), powers };
        let mut best = at(powers);
        let Some(curvature) = curvature.cholesky() else { return best };
        for _ in 0..STEPS {
            let step = curvature.solve(&courses.tr_mul(&self.excess(&best.powers, squares, tails)));
            let mut tried = (0..HALVINGS).map(|k| at(&best.powers + 0.5_f64.powi(k as i32) * &step));
            let Some(next) = tried.find(|next| next.deviance < best.deviance) else { break };
            let gain = best.deviance - next.deviance;
            best = next;
            if gain < LEAST_GAIN {
                break;
            }
        }
        best
    }

    /// By how much each variance should be larger, as a share of it.
    fn excess(&self, powers: &DVector<f64>, squares: &[f64], tails: Tails) -> DVector<f64> {
        let log_variances = &self.0 * powers;
        let ratios = squares.iter().zip(log_variances.iter()).map(|(square, log)| square * (-log).exp());
        DVector::from_iterator(squares.len(), ratios.map(|ratio| tails.excess(ratio)))
    }

    fn deviance(&self, powers: &DVector<f64>, squares: &[f64], tails: Tails) -> f64 {
        let log_variances = &self.0 * powers;
        let of = |(square, log): (&f64, &f64)| log + tails.deviance(square * (-log).exp());
        squares.iter().zip(log_variances.iter()).map(of).sum()
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    const SAMPLES: usize = 4000;

    /// Squares of normal samples, a quarter of which is louder by a factor; and the logarithm of that.
    fn louder(times: f64) -> (Vec<f64>, Vec<f64>) {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let log = |k: usize| if k.is_multiple_of(4) { times.ln() } else { 0.0 };
        let square = |k: usize| {
            let normal: f64 = StandardNormal.sample(&mut random);
            normal * normal * log(k).exp()
        };
        ((0..SAMPLES).map(square).collect(), (0..SAMPLES).map(log).collect())
    }

    #[test]
    fn powers_are_told_of_what_is_ten_million_times_as_loud() {
        let (squares, log) = louder(1e7);
        for tails in [Tails::Normal, Tails::Heavy] {
            let fitted = Courses::of(std::slice::from_ref(&log), SAMPLES).fitted(&squares, tails);
            assert!((fitted.powers[1] - 1.0).abs() < 0.02, "{tails:?} {}", fitted.powers);
        }
    }

    #[test]
    fn a_few_values_that_belong_elsewhere_bend_normal_tails_alone() {
        let (mut squares, log) = louder(1e3);
        (1..SAMPLES).step_by(400).for_each(|k| squares[k] = 1e5);
        let power = |tails| Courses::of(std::slice::from_ref(&log), SAMPLES).fitted(&squares, tails).powers[1];
        let [normal, heavy] = [power(Tails::Normal), power(Tails::Heavy)];
        assert!((heavy - 1.0).abs() < 0.03 && normal < 0.5, "{normal} {heavy}");
    }
}

//! What the noise of the direction leaves in doubt of the variance of each sample.

use crate::diagnosis::noise::model::NoiseModel;
use crate::diagnosis::regression::problem::RegressionProblem;

/// How far the model of the direction's noise may be wrong, in whatever it says: least where little of a sample is that noise.
#[derive(Clone, Debug)]
pub(super) struct Doubt {
    /// Share of the variance of each sample that is noise of the direction.
    share: Vec<f64>,
    /// Coefficient of variation of the samples' variance by it.
    variance_cv: f64,
}

impl Doubt {
    pub(super) fn of(noise: &NoiseModel) -> Self {
        Self { share: noise.direction_share(), variance_cv: noise.variance_cv() }
    }

    /// At rows with a reading alone.
    pub(super) fn observed(&self, problem: &RegressionProblem<'_>) -> Self {
        Self { share: problem.whitening.observed(&self.share).collect(), ..*self }
    }

    /// What may be wrong of each sample's variance, as a share of it: `by_variation` times the coefficient of variation, and no more than
    /// `by_share` times what of the sample is noise of the direction.
    pub(super) fn of_samples(&self, [by_variation, by_share]: [f64; 2]) -> impl ExactSizeIterator<Item = f64> {
        self.share.iter().map(move |share| (by_share * share).min(by_variation * self.variance_cv))
    }

    /// The same on the whole: `by_share` times what of all samples is noise of the direction.
    pub(super) fn of_all(&self, [by_variation, by_share]: [f64; 2]) -> f64 {
        let mean = self.share.iter().sum::<f64>() / self.share.len().max(1) as f64;
        (by_share * mean).min(by_variation * self.variance_cv)
    }
}

#[cfg(test)]
impl Doubt {
    /// Where `is_doubtful`, all is noise of the direction.
    pub(super) fn where_it(is_doubtful: impl Fn(usize) -> bool, samples: usize, variance_cv: f64) -> Self {
        Self { share: (0..samples).map(|k| f64::from(u8::from(is_doubtful(k)))).collect(), variance_cv }
    }
}

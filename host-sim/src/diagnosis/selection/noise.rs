//! The noise model: colour, direction and effects that are random.

use crate::diagnosis::noise::direction::direction_growth;
use crate::diagnosis::noise::spectrum::NoiseSpectrum;
use crate::diagnosis::noise::variance::innovation_variance;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::{Candidate, scan_again};
use crate::diagnosis::selection::Search;
use crate::effects::Channel;

/// Whitened noise is never quieter: less is a reading without noise, of which nothing can be said.
const LEAST_VARIANCE: f64 = 0.05;
/// No sensor is quieter, nT.
const LEAST_NOISE_NT: f64 = 5e-4;

/// How much denser than white noise the noise of the direction may be where it is let through.
pub(crate) const NOISE_DENSITY_RATIO: f64 = 5.0;
/// Of the coefficient of variation of the direction's noise, how many times as much its model may have wrong for a while.
pub(crate) const VARIANCE_MODEL_ERROR: f64 = 4.0;

impl Search<'_> {
    /// Noise model from what is left now, and everything fitted again with it.
    pub(crate) fn whiten(&mut self) {
        let residual = self.problem.residual_nt(&self.fit);
        let plain = Whitening::new(&self.blocks, Predictor::white(1.0), None);
        let projected = plain.apply(&residual);
        let mut rows = vec![0.0; residual.len()];
        plain.rows().zip(&projected).for_each(|(row, value)| rows[row] = *value);
        self.spectrum = self.spectrum_of(&rows);
        let predictor = match &self.spectrum {
            Some(spectrum) => {
                let mut autocovariance = spectrum.autocovariance();
                autocovariance[0] += LEAST_NOISE_NT * LEAST_NOISE_NT;
                Predictor::levinson(&autocovariance)
            }
            None => Predictor::white(
                (dot(&projected, &projected) / projected.len().max(1) as f64).sqrt().max(LEAST_NOISE_NT),
            ),
        };
        self.direction = None;
        self.weigh(&predictor);
        if self.problem.channel == Channel::Scalar {
            self.direction = direction_growth(
                &self.problem.signals,
                &self.problem.whitening,
                &self.problem.whitening.apply(&residual),
                self.direction_noise_rad,
            );
            if self.direction.is_some() {
                self.weigh(&predictor);
            }
        }
        let terms = self.fit.terms.clone();
        self.refit(&terms);
    }

    /// Smooth spectrum of the noise that is there in all rows.
    fn spectrum_of(&self, rows: &[f64]) -> Option<NoiseSpectrum> {
        if self.random.is_empty() {
            return NoiseSpectrum::of(rows, &self.blocks);
        }
        let mut row_variance = vec![0.0; rows.len()];
        for change in self.random.iter().filter_map(|candidate| self.row_variance(candidate)) {
            row_variance.iter_mut().zip(change).for_each(|(sum, more)| *sum += more);
        }
        let before = self.spectrum.clone().or_else(|| NoiseSpectrum::of(rows, &self.blocks))?;
        Some(before.without(rows, &self.blocks, &row_variance))
    }

    /// What a random effect adds to the variance of each row, nT^2.
    fn row_variance(&self, candidate: &Candidate) -> Option<Vec<f64>> {
        let effect = &self.problem.library[candidate.term.effect];
        effect.variance(&self.problem.signals, &candidate.term.at).map(|change| change.scalar_nt)
    }

    /// Whitening by a predictor, each sample weighted by its own variance.
    fn weigh(&mut self, predictor: &Predictor) {
        let direction = self.direction.as_deref().map(weights_of);
        self.problem.whitening = Whitening::new(&self.blocks, predictor.clone(), direction);
        if self.random.is_empty() {
            return;
        }
        let mut growth = vec![1.0; self.problem.whitening.samples()];
        for index in 0..self.random.len() {
            let Some(row_variance) = self.row_variance(&self.random[index]) else { continue };
            let own: Vec<f64> =
                innovation_variance(&self.problem.whitening, &row_variance).iter().map(|added| 1.0 + added).collect();
            growth.iter_mut().zip(&own).for_each(|(sum, own)| *sum += own - 1.0);
            if let Some(variance) = &mut self.random[index].variance {
                variance.growth = own;
            }
        }
        let both = self.direction.iter().fold(growth, |growth, direction| {
            growth.iter().zip(direction).map(|(growth, direction)| growth * direction).collect()
        });
        self.problem.whitening = Whitening::new(&self.blocks, predictor.clone(), Some(weights_of(&both)));
    }

    /// Each random effect fitted again, now that the noise model knows of it.
    pub(crate) fn renew_random(&mut self) {
        for index in 0..self.random.len() {
            let old = self.random.remove(index);
            self.weigh(&self.problem.whitening.predictor().clone());
            let fit = self.problem.fit(&self.fit.terms);
            let found = scan_again(&self.problem, &fit, &old).unwrap_or(old);
            for named in self.named.iter_mut().filter(|named| named.candidate.term.effect == found.term.effect) {
                named.candidate = found.clone();
            }
            self.random.insert(index, found);
        }
        if !self.random.is_empty() {
            self.whiten();
        }
    }

    pub(crate) fn refit(&mut self, terms: &[Term]) {
        self.fit = self.problem.fit(terms);
        self.problem.adopt(&self.fit);
    }

    /// Variance of the whitened noise: from the middle of its distribution, which nothing rare moves.
    pub(crate) fn variance(&self) -> f64 {
        let whitening = &self.problem.whitening;
        let there: Vec<f64> = whitening.observed(&self.fit.residual_whitened).collect();
        variance_of(&there, whitening.dof() - self.fit.projection.rank() as f64)
    }

    /// How much the variance of the samples differs by the noise of the direction, of its mean, rms.
    pub(crate) fn variance_cv(&self) -> f64 {
        self.direction.as_deref().map_or(0.0, variance_cv_of)
    }

    pub(crate) fn samples(&self) -> f64 {
        self.problem.whitening.dof().max(10.0)
    }
}

/// How much variances differ, of their mean, rms.
pub(crate) fn variance_cv_of(variances: &[f64]) -> f64 {
    let count = variances.len().max(1) as f64;
    let mean = variances.iter().sum::<f64>() / count;
    (variances.iter().map(|variance| (variance / mean - 1.0).powi(2)).sum::<f64>() / count).sqrt()
}

/// Weights of samples whose variance grows.
pub(crate) fn weights_of(growth: &[f64]) -> Vec<f64> {
    growth.iter().map(|g| 1.0 / g.sqrt()).collect()
}

/// Variance of whitened noise: from the median of its squares, but never above the mean of them.
fn variance_of(rest: &[f64], dof: f64) -> f64 {
    if rest.is_empty() || dof < 1.0 {
        return 1.0;
    }
    let mean = rest.iter().map(|z| z * z).sum::<f64>() / dof;
    let from_median = robust_mean_square(rest) * rest.len() as f64 / dof;
    from_median.min(mean).max(LEAST_VARIANCE)
}

//! One member of the bank: a square-root estimator that gates what surprises it.

use super::super::square_root_information::SquareRootInformation;
use super::tuning::{CLIP, CLIPPED_MEAN_SQUARE, LEAST_VARIANCE, NO_INFORMATION};
use crate::model::Row;
use crate::model::{Coefficients, TERMS, dot};

/// Updates between two moves of the factor's centre to the latest coefficients.
const RECENTRE_EVERY: u32 = 1000;

/// What a member says of an epoch before it learns from it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Judgement {
    /// Band-passed scalar less the prediction, nT.
    pub(super) error_nt: f32,
    /// Predicted variance of it, nT^2.
    pub(super) variance: f32,
    /// Share of that which is the coefficients' own uncertainty, over that of the noise.
    pub(super) uncertainty: f32,
}

/// How a member learns and forgets, per epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Manner {
    pub(super) forgetting: f32,
    pub(super) sqrt_forgetting: f32,
    /// Multiple of the predicted standard deviation beyond which an epoch weighs less.
    pub(super) gate: f32,
    /// Variance of the noise in the rows it learns from, over that of the band-passed rows, if each were news.
    pub(super) noise_gain: f32,
}

/// A square-root estimator with the scale of its own noise.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub(super) factor: SquareRootInformation,
    pub(super) coefficients: Coefficients,
    /// Coefficients of one to two ages ago: they have not seen the target that passes now.
    aged: [Coefficients; 2],
    /// Variance of the prediction error where the coefficients are sure, nT^2.
    pub(super) noise: f32,
    /// The same of the aged coefficients.
    pub(super) aged_noise: f32,
    /// Logarithm of how well it has predicted, nats below the best.
    pub(super) evidence: f32,
    /// Probability by that evidence.
    pub(super) probability: f32,
    /// Trace of the information from the calibration, and of that from the epochs since.
    inherited: f32,
    learnt: f32,
    /// Epochs since it started.
    pub(super) age_epochs: u32,
}

impl Member {
    /// Of no use before it is replaced.
    pub(super) const BLANK: Self = Self {
        factor: SquareRootInformation::EMPTY,
        coefficients: Coefficients::ZERO,
        aged: [Coefficients::ZERO; 2],
        noise: 0.0,
        aged_noise: 0.0,
        evidence: 0.0,
        probability: 0.0,
        inherited: 0.0,
        learnt: 0.0,
        age_epochs: 0,
    };

    pub(super) fn new(factor: SquareRootInformation, coefficients: Coefficients, noise: f32) -> Self {
        let inherited = factor.trace();
        Self {
            factor,
            coefficients,
            aged: [coefficients; 2],
            noise,
            aged_noise: noise,
            evidence: 0.0,
            probability: 0.0,
            inherited,
            learnt: 0.0,
            age_epochs: 0,
        }
    }

    /// One that knows nothing, and predicts zero until it knows better.
    pub(super) fn knowing_nothing(noise: f32) -> Self {
        let factor = SquareRootInformation::independent(&[NO_INFORMATION; TERMS], &Coefficients::ZERO);
        Self::new(factor, Coefficients::ZERO, noise)
    }

    /// One that holds `factor`, and hardly anything of what that leaves open.
    pub(super) fn holding(mut factor: SquareRootInformation, centre: Coefficients, noise: f32) -> Self {
        (0..TERMS).for_each(|term| factor.hold_to_centre(term, NO_INFORMATION));
        Self::new(factor, centre, noise)
    }

    /// What it says of an epoch, `sigma^2 (1 + g x' (R' R)^-1 x)` for the variance, with the gain `g` of [`Manner`].
    pub(super) fn judge(&self, row: &Row, noise_gain: f32) -> Judgement {
        let uncertainty = noise_gain * self.factor.leverage(&row.terms);
        Judgement {
            error_nt: row.scalar_nt - self.coefficients.predict_nt(&row.terms),
            variance: self.noise * (1.0 + uncertainty),
            uncertainty,
        }
    }

    /// Prediction error of the aged coefficients, nT.
    pub(super) fn aged_error_nt(&self, row: &Row) -> f32 {
        row.scalar_nt - self.aged[0].predict_nt(&row.terms)
    }

    /// Let the coefficients age by one.
    pub(super) fn age(&mut self) {
        self.aged = [self.aged[1], self.coefficients];
    }

    /// Learn from the epoch that was judged: from its row, differenced or not.
    pub(super) fn learn(&mut self, row: &Row, judgement: &Judgement, manner: &Manner, noise_rate: f32) {
        let surprise = libm::fabsf(judgement.error_nt) / libm::sqrtf(judgement.variance);
        let weight = weight(surprise, manner.gate);
        self.noise = track(self.noise, surprise, noise_rate / (1.0 + judgement.uncertainty));
        self.factor.forget(manner.sqrt_forgetting);
        self.factor.add_weighted(row, weight);
        self.inherited *= manner.forgetting;
        self.learnt = manner.forgetting * self.learnt + weight * dot(&row.terms, &row.terms);
        if let Some(coefficients) = Coefficients::from_basis(self.factor.least_squares()) {
            self.coefficients = coefficients;
        }
        self.age_epochs = self.age_epochs.saturating_add(1);
        if self.age_epochs.is_multiple_of(RECENTRE_EVERY) {
            self.factor.recentre(&self.coefficients);
        }
    }

    /// Share of its information that is not the calibration's, 0 to 1.
    pub(super) fn adapted(&self) -> f32 {
        let all = self.inherited + self.learnt;
        if all > 0.0 { self.learnt / all } else { 0.0 }
    }

    /// Trace of all its information.
    pub(super) fn trace(&self) -> f32 {
        self.inherited + self.learnt
    }
}

/// Weight of an epoch by its prediction error over the predicted standard deviation. It falls with the fourth power, so
/// that what an epoch does to the coefficients falls with the third: a target ten times as high as the gate does less
/// than the noise does.
pub(super) fn weight(surprise: f32, gate: f32) -> f32 {
    let ratio = gate / surprise;
    if ratio < 1.0 { ratio * ratio * ratio * ratio } else { 1.0 }
}

/// A variance after one more error of `surprise` standard deviations.
pub(super) fn track(variance: f32, surprise: f32, rate: f32) -> f32 {
    let clipped = surprise.min(CLIP);
    let grown = variance + rate * variance * (clipped * clipped / CLIPPED_MEAN_SQUARE - 1.0);
    grown.max(LEAST_VARIANCE)
}

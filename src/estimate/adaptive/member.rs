//! One member of the bank: a square-root estimator that gives epochs with a large innovation less weight.

use super::super::robust::{gate_weight, tracked};
use super::super::square_root_information::SquareRootInformation;
use super::config::MemberConfig;
use crate::model::Row;
use crate::model::{Coefficients, TERMS, TermVector, dot};
use crate::policy::{RECENTRE_EVERY, UNINFORMED_WEIGHT};

/// What a member predicts of an epoch before it learns from it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Prediction {
    /// Innovation: band-passed scalar less the predicted one, nT.
    pub(super) error_nt: f32,
    /// Predicted variance of it, nT^2, above 0.
    pub(super) variance: f32,
    /// Part of that which is the coefficients' own uncertainty, over that of the noise.
    pub(super) uncertainty: f32,
}

impl Prediction {
    /// Size of the innovation in predicted standard deviations.
    fn normalised_innovation(&self) -> f32 {
        libm::fabsf(self.error_nt) / libm::sqrtf(self.variance)
    }
}

/// A square-root estimator with the scale of its own noise.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub(super) factor: SquareRootInformation,
    pub(super) coefficients: Coefficients,
    /// Coefficients of one to two ages ago: they have not seen the target that passes now.
    aged: [Coefficients; 2],
    /// Variance of the prediction error where the coefficients are certain, nT^2.
    pub(super) noise_variance: f32,
    /// The same of the aged coefficients.
    pub(super) aged_noise_variance: f32,
    /// How well its aged coefficients have predicted, nats: 0 for the best member, below 0 for the others.
    pub(super) log_evidence: f32,
    /// Probability by that evidence; those of all members sum to 1.
    pub(super) probability: f32,
    /// Trace of the information from the calibration, and of that from the epochs since.
    prior_trace: f32,
    learnt_trace: f32,
    /// Epochs since it was initialised.
    pub(super) age_epochs: u32,
}

impl Member {
    /// A place for a member; of no use before one is put there.
    pub(super) const BLANK: Self = Self {
        factor: SquareRootInformation::EMPTY,
        coefficients: Coefficients::ZERO,
        aged: [Coefficients::ZERO; 2],
        noise_variance: 0.0,
        aged_noise_variance: 0.0,
        log_evidence: 0.0,
        probability: 0.0,
        prior_trace: 0.0,
        learnt_trace: 0.0,
        age_epochs: 0,
    };

    fn new(factor: SquareRootInformation, coefficients: Coefficients, noise_variance: f32) -> Self {
        let prior_trace = factor.trace();
        Self {
            factor,
            coefficients,
            aged: [coefficients; 2],
            noise_variance,
            aged_noise_variance: noise_variance,
            prior_trace,
            ..Self::BLANK
        }
    }

    /// One that knows nothing, and predicts zero until it knows better.
    pub(super) fn uninformed(noise_variance: f32) -> Self {
        let factor = SquareRootInformation::independent(&TermVector::repeat(UNINFORMED_WEIGHT), &Coefficients::ZERO);
        Self::new(factor, Coefficients::ZERO, noise_variance)
    }

    /// One that holds the information in `factor`, and hardly any about what that leaves open.
    pub(super) fn informed(mut factor: SquareRootInformation, centre: Coefficients, noise_variance: f32) -> Self {
        (0..TERMS).for_each(|term| factor.hold_to_centre(term, UNINFORMED_WEIGHT));
        Self::new(factor, centre, noise_variance)
    }

    /// Predict an epoch: variance `sigma^2 (1 + g x' (R' R)^-1 x)`, with the noise gain `g` of [`MemberConfig`].
    pub(super) fn predict(&self, row: &Row, noise_gain: f32) -> Prediction {
        let uncertainty = noise_gain * self.factor.leverage(&row.terms);
        Prediction {
            error_nt: row.scalar_nt - self.coefficients.predict_nt(&row.terms),
            variance: self.noise_variance * (1.0 + uncertainty),
            uncertainty,
        }
    }

    /// Prediction error of the aged coefficients, nT.
    pub(super) fn aged_error_nt(&self, row: &Row) -> f32 {
        row.scalar_nt - self.aged[0].predict_nt(&row.terms)
    }

    /// An age has passed: the aged coefficients become those of one age ago.
    pub(super) fn age(&mut self) {
        self.aged = [self.aged[1], self.coefficients];
    }

    /// Learn from the epoch that was predicted: from its row, differenced or not.
    pub(super) fn learn(&mut self, row: &Row, prediction: &Prediction, config: &MemberConfig, noise_rate: f32) {
        let innovation = prediction.normalised_innovation();
        let weight = gate_weight(innovation, config.gate);
        self.noise_variance = tracked(self.noise_variance, innovation, noise_rate / (1.0 + prediction.uncertainty));
        self.factor.forget(config.sqrt_forgetting);
        self.factor.add_weighted(row, weight);
        self.prior_trace *= config.forgetting;
        self.learnt_trace = config.forgetting * self.learnt_trace + weight * dot(&row.terms, &row.terms);
        if let Some(coefficients) = Coefficients::from_basis(self.factor.least_squares()) {
            self.coefficients = coefficients;
        }
        self.age_epochs = self.age_epochs.saturating_add(1);
        if self.age_epochs.is_multiple_of(RECENTRE_EVERY) {
            self.factor.recentre(&self.coefficients);
        }
    }

    /// Share of its information that is not the calibration's, 0 to 1.
    pub(super) fn adapted_share(&self) -> f32 {
        let all = self.trace();
        if all > 0.0 { self.learnt_trace / all } else { 0.0 }
    }

    /// Trace of all its information.
    pub(super) fn trace(&self) -> f32 {
        self.prior_trace + self.learnt_trace
    }
}

//! The members as a mixture: their evidence, the probabilities that follow from it, and what they say together.

use super::super::robust::tracked;
use super::super::square_root_information::SquareRootInformation;
use super::config::Adaptive;
use super::member::{Member, Prediction};
use crate::model::Row;
use crate::model::{Coefficients, ZEROS};
use crate::policy::{DEGREES_OF_FREEDOM, INNOVATION_CLIP, LEAST_LOG_EVIDENCE, MEMBERS, PRIOR_COST_NATS};

/// All members.
#[derive(Clone, Debug)]
pub(super) struct Mixture {
    pub(super) members: [Member; MEMBERS],
}

impl Mixture {
    /// Places for members.
    pub(super) const BLANK: Self = Self { members: [const { Member::BLANK }; MEMBERS] };

    /// Probability of each member, from the one that keeps all of the calibration to the plain one.
    pub(super) fn probabilities(&self) -> [f32; MEMBERS] {
        self.members.each_ref().map(|member| member.probability)
    }

    /// Place of the most probable member.
    pub(super) fn leader(&self) -> usize {
        let probability = |i: &usize| self.members[*i].probability;
        (0..MEMBERS).max_by(|a, b| probability(a).total_cmp(&probability(b))).unwrap_or(0)
    }

    /// Information of the most probable member.
    pub(super) fn information(&self) -> &SquareRootInformation {
        &self.members[self.leader()].factor
    }

    /// Mean over the members, by their probability.
    fn mean(&self, of: impl Fn(&Member) -> f32) -> f32 {
        self.members.iter().map(|member| member.probability * of(member)).sum()
    }

    /// Variance of the aged predictions, nT^2.
    pub(super) fn aged_noise_variance(&self) -> f32 {
        self.mean(|member| member.aged_noise_variance)
    }

    /// Share of the information that is not the calibration's, 0 to 1.
    pub(super) fn adapted_share(&self) -> f32 {
        self.mean(Member::adapted_share)
    }

    /// Predicted standard deviation of the mean's error, nT: that of the mixture.
    pub(super) fn predicted_std_nt(&self, predictions: &[Prediction; MEMBERS]) -> f32 {
        let mean = |of: &dyn Fn(&Prediction) -> f32| -> f32 {
            self.members.iter().zip(predictions).map(|(member, prediction)| member.probability * of(prediction)).sum()
        };
        let error_nt = mean(&|prediction| prediction.error_nt);
        let apart_nt = |prediction: &Prediction| prediction.error_nt - error_nt;
        libm::sqrtf(mean(&|prediction| prediction.variance + apart_nt(prediction) * apart_nt(prediction)))
    }

    /// The members' coefficients, averaged by their probability; `None` when the mean is not finite.
    pub(super) fn mean_coefficients(&self) -> Option<Coefficients> {
        let mut mean = ZEROS;
        for member in &self.members {
            mean.axpy(member.probability, member.coefficients.basis(), 1.0);
        }
        Coefficients::from_basis(mean)
    }

    /// Judge the aged coefficients by how well they predict this row: their log likelihood in a Student distribution,
    /// over a fading window. Aged, because fresh coefficients that have fitted half a target predict its other half
    /// well: by those, the member that learns targets wins. Whether all members have failed to predict the row.
    pub(super) fn update_evidence(&mut self, row: &Row, adaptive: &Adaptive) -> bool {
        let noise_variance = self.aged_noise_variance();
        let mut least_square = f32::INFINITY;
        for (member, cost_nats) in self.members.iter_mut().zip(PRIOR_COST_NATS) {
            let error_nt = member.aged_error_nt(row);
            let square = error_nt * error_nt;
            least_square = least_square.min(square);
            let innovation = libm::sqrtf(square / member.aged_noise_variance);
            member.aged_noise_variance = tracked(member.aged_noise_variance, innovation, adaptive.noise_rate);
            let loss = adaptive.evidence_per_epoch * libm::log1pf(square / (DEGREES_OF_FREEDOM * noise_variance));
            let kept = member.log_evidence * (1.0 - adaptive.evidence_rate);
            member.log_evidence = kept - adaptive.evidence_rate * cost_nats - loss;
        }
        self.update_probabilities();
        least_square > INNOVATION_CLIP * INNOVATION_CLIP * noise_variance
    }

    /// Probabilities from the evidence.
    pub(super) fn update_probabilities(&mut self) {
        let best = self.members.iter().map(|member| member.log_evidence).fold(f32::NEG_INFINITY, f32::max);
        for member in &mut self.members {
            member.log_evidence = (member.log_evidence - best).max(LEAST_LOG_EVIDENCE);
            member.probability = libm::expf(member.log_evidence);
        }
        let sum: f32 = self.members.iter().map(|member| member.probability).sum();
        self.members.iter_mut().for_each(|member| member.probability /= sum);
    }
}

//! The bank from epoch to epoch: predict, update the evidence, learn, average, reinitialise.

use super::super::estimator::Estimator;
use super::super::robust::gate_weight;
use super::super::square_root_information::SquareRootInformation;
use super::super::{ElasticNet, Prior};
use super::config::Adaptive;
use super::member::{Member, Prediction};
use super::mixture::Mixture;
use super::quality::{Adaptation, Quality};
use super::reinitialisation::{FailureMonitor, reinitialise};
use crate::model::Row;
use crate::model::{Coefficients, ZEROS, dot};
use crate::policy::{
    DEFAULT_NOISE_NT, FREE_NOISE_RATIO, GATE, GATED_WEIGHT, INFORMATION_SHARES, LONG_MEMORY, MEMBERS, PLAIN,
    PRIOR_COST_NATS, SHORT_MEMORY,
};

/// All that the adaptive method remembers.
#[derive(Clone, Debug)]
pub struct Bank {
    mixture: Mixture,
    mean: Coefficients,
    previous: Option<Row>,
    epochs_until_aged: u32,
    /// Information that comes in per epoch of late, less what is forgotten: traces.
    net_information: f32,
    monitor: FailureMonitor,
    quality: Quality,
}

impl AsRef<Coefficients> for Bank {
    fn as_ref(&self) -> &Coefficients {
        &self.mean
    }
}

impl Bank {
    /// What was known of the latest epoch's quality before it was learnt.
    pub fn quality(&self) -> &Quality {
        &self.quality
    }

    /// An epoch has passed that was not learnt.
    pub(crate) fn skip(&mut self) {
        self.quality.adaptation = Adaptation::Waiting;
    }

    /// Information of the most probable member. Its rows are differenced, or correlated with each other: see
    /// [`noise_gain`](Self::noise_gain).
    pub fn information(&self) -> &SquareRootInformation {
        self.mixture.information()
    }

    /// Variance of the noise in the rows behind [`information`](Self::information) over that of the residual, for
    /// statistically independent rows.
    pub fn noise_gain(&self, adaptive: &Adaptive) -> f32 {
        adaptive.members[self.mixture.leader()].noise_gain
    }

    /// Probability of each member, from the one that keeps all of the calibration to the plain one.
    pub fn probabilities(&self) -> [f32; MEMBERS] {
        self.mixture.probabilities()
    }

    /// Average the members' coefficients by their probability.
    fn average(&mut self) {
        if let Some(mean) = self.mixture.mean_coefficients() {
            self.mean = mean;
        }
    }

    /// Quality of the epoch, from what is known before it is learnt.
    fn assess(&mut self, row: &Row, differenced: &Row, predictions: &[Prediction; MEMBERS], adaptive: &Adaptive) {
        let predicted_std_nt = self.mixture.predicted_std_nt(predictions);
        let error_nt = row.scalar_nt - self.mean.predict_nt(&row.terms);
        let adapted = self.mixture.adapted_share();
        self.track_information(row, differenced, adaptive);
        let adaptation = if self.monitor.is_recent(adaptive) {
            Adaptation::Relearning
        } else if gate_weight(libm::fabsf(error_nt) / predicted_std_nt, GATE) < GATED_WEIGHT {
            Adaptation::Surprised
        } else if self.net_information < 0.0 {
            Adaptation::Resting
        } else {
            Adaptation::Learning
        };
        self.quality = Quality { predicted_std_nt, adapted, adaptation };
    }

    /// What the leader gains by the epoch, less what it forgets.
    fn track_information(&mut self, row: &Row, differenced: &Row, adaptive: &Adaptive) {
        let leader = self.mixture.leader();
        let forgotten = (1.0 - adaptive.members[leader].forgetting) * self.mixture.members[leader].trace();
        let learnt = if leader == PLAIN { row } else { differenced };
        let net = dot(&learnt.terms, &learnt.terms) - forgotten;
        self.net_information += adaptive.failure_rate * (net - self.net_information);
    }

    /// The row less what of it the previous one predicts: what the model leaves is correlated from epoch to epoch, and
    /// rows that are not differenced count the same information many times (Cochrane and Orcutt 1949).
    fn difference(&mut self, row: &Row, correlation: f32) -> Row {
        let before = self.previous.replace(*row).unwrap_or(Row { terms: ZEROS, scalar_nt: 0.0 });
        Row { terms: row.terms - before.terms * correlation, scalar_nt: row.scalar_nt - correlation * before.scalar_nt }
    }

    /// Every `age_epochs`, the members' coefficients age.
    fn age(&mut self, age_epochs: u32) {
        if self.epochs_until_aged == 0 {
            self.epochs_until_aged = age_epochs;
            self.mixture.members.iter_mut().for_each(Member::age);
        }
        self.epochs_until_aged -= 1;
    }
}

impl Estimator for Adaptive {
    type State = Bank;

    // All zeros, so that it is cleared memory and not ten kilobytes of constants in the flash.
    const IDLE: Bank = Bank {
        mixture: Mixture::BLANK,
        mean: Coefficients::ZERO,
        previous: None,
        epochs_until_aged: 0,
        net_information: 0.0,
        monitor: FailureMonitor::BLANK,
        quality: Quality::START,
    };

    fn start(&self, bank: &mut Bank, prior: &Prior) {
        let noise_nt = prior.information.map_or(DEFAULT_NOISE_NT, |information| information.noise_nt());
        let noise_variance = noise_nt * noise_nt;
        for (i, member) in bank.mixture.members.iter_mut().enumerate() {
            *member = match INFORMATION_SHARES[i] {
                _ if i == SHORT_MEMORY => Member::uninformed(FREE_NOISE_RATIO * noise_variance),
                share if i < LONG_MEMORY => self.member(share, prior, noise_variance),
                share => self.member(share, prior, FREE_NOISE_RATIO * noise_variance),
            };
            member.aged_noise_variance = noise_variance;
            member.log_evidence = -PRIOR_COST_NATS[i];
        }
        bank.mean = prior.coefficients;
        bank.monitor = FailureMonitor::START;
        bank.mixture.update_probabilities();
        bank.average();
    }

    fn update(&self, bank: &mut Bank, row: &Row) {
        let predictions = core::array::from_fn(|i| bank.mixture.members[i].predict(row, self.members[i].noise_gain));
        let differenced = bank.difference(row, self.correlation);
        bank.assess(row, &differenced, &predictions, self);
        bank.age(self.age_epochs);
        let failed = bank.mixture.update_evidence(row, self);
        for (i, (member, prediction)) in bank.mixture.members.iter_mut().zip(&predictions).enumerate() {
            let learnt = if i == PLAIN { row } else { &differenced };
            member.learn(learnt, prediction, &self.members[i], self.noise_rate);
        }
        bank.average();
        bank.monitor.note(failed, self);
        reinitialise(&mut bank.mixture, &bank.monitor, &bank.mean, self);
    }
}

impl Adaptive {
    /// A member that keeps a share of what the calibration knows; without its information, of what `lambda2` says.
    fn member(&self, share: f32, prior: &Prior, noise_variance: f32) -> Member {
        let factor = match &prior.information {
            Some(information) => information.factor(share * self.members[0].noise_gain),
            None => {
                let penalty = ElasticNet { lambda1: 0.0, lambda2: f64::from(share * self.unknown_weight) };
                SquareRootInformation::independent(&penalty.scaled_lambda2(), &prior.coefficients)
            }
        };
        Member::informed(factor, centre(prior), noise_variance)
    }
}

/// Coefficients that the calibration's information is centred on.
fn centre(prior: &Prior) -> Coefficients {
    prior.information.map_or(prior.coefficients, |information| *information.centre())
}

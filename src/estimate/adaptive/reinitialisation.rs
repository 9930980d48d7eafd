//! Whether the bank as a whole fails, and which free members are reinitialised then.
//!
//! A target is over in seconds; a wrong model fails as long as the body turns. Failures are counted over a time that a
//! target fills less than half of.

use super::config::Adaptive;
use super::member::Member;
use super::mixture::Mixture;
use crate::model::Coefficients;
use crate::policy::{
    FAILURE_SHARE, FREE_NOISE_RATIO, FREE_SHARE, LONG_MEMORY, PLAIN, REINITIALISED_COST_NATS, SHORT_MEMORY,
};

/// What is remembered of failed predictions.
#[derive(Clone, Debug)]
pub(super) struct FailureMonitor {
    /// Share of the latest epochs that no member has predicted, 0 to 1.
    failure_share: f32,
    epochs_since_failure: u32,
}

impl FailureMonitor {
    /// Of no use before a start.
    pub(super) const BLANK: Self = Self { failure_share: 0.0, epochs_since_failure: 0 };

    /// Before the first epoch.
    pub(super) const START: Self = Self { failure_share: 0.0, epochs_since_failure: u32::MAX };

    /// Count an epoch.
    pub(super) fn note(&mut self, failed: bool, adaptive: &Adaptive) {
        self.failure_share += adaptive.failure_rate * (f32::from(u8::from(failed)) - self.failure_share);
        self.epochs_since_failure = if self.is_failing() { 0 } else { self.epochs_since_failure.saturating_add(1) };
    }

    /// Whether no member has predicted what came for longer than a target lasts.
    fn is_failing(&self) -> bool {
        self.failure_share > FAILURE_SHARE
    }

    /// Whether the latest failure is so recent that reinitialised members still learn.
    pub(super) fn is_recent(&self, adaptive: &Adaptive) -> bool {
        self.epochs_since_failure < adaptive.reinitialisation_epochs
    }

    /// Whether a member is to be reinitialised: during a failure, and once more when it has been over for long enough,
    /// because what was learnt first came through a band-pass that still held the body as it was before.
    fn calls_for(&self, member: &Member, adaptive: &Adaptive) -> bool {
        let tried = member.age_epochs >= adaptive.reinitialisation_epochs;
        self.is_failing() && tried || self.epochs_since_failure == adaptive.reinitialisation_epochs
    }
}

/// Reinitialise the free members that are due, at the mean coefficients `mean`. The leader is never touched.
pub(super) fn reinitialise(mixture: &mut Mixture, monitor: &FailureMonitor, mean: &Coefficients, adaptive: &Adaptive) {
    let leader = mixture.leader();
    let challenger = challenger(mixture, leader);
    let is_due = |i: usize| i != leader && monitor.calls_for(&mixture.members[i], adaptive);
    let [challenger_due, plain_due] = [challenger, PLAIN].map(is_due);
    // The one with the short memory forgets soon enough by itself.
    let trial_over = leader != LONG_MEMORY && mixture.members[LONG_MEMORY].age_epochs >= adaptive.trial_epochs;
    if challenger_due {
        replace(mixture, challenger, leader, mean);
    } else if trial_over {
        replace(mixture, LONG_MEMORY, leader, mean);
    }
    if plain_due {
        replace(mixture, PLAIN, leader, mean);
    }
}

/// Of the two free members the one that does not lead; of two that do not, the one that has waited longer.
fn challenger(mixture: &Mixture, leader: usize) -> usize {
    let long_has_waited = mixture.members[LONG_MEMORY].age_epochs >= mixture.members[SHORT_MEMORY].age_epochs;
    if leader == SHORT_MEMORY || leader != LONG_MEMORY && long_has_waited { LONG_MEMORY } else { SHORT_MEMORY }
}

/// Put in the place of `member` one that predicts as the bank does until it knows better, and keeps next to nothing of
/// what the leader knows.
fn replace(mixture: &mut Mixture, member: usize, leader: usize, mean: &Coefficients) {
    let leader = &mixture.members[leader];
    let factor = leader.factor.discounted(FREE_SHARE, mean);
    let mut fresh = Member::informed(factor, *mean, FREE_NOISE_RATIO * leader.noise_variance);
    fresh.aged_noise_variance = mixture.aged_noise_variance();
    fresh.log_evidence = -REINITIALISED_COST_NATS;
    mixture.members[member] = fresh;
}

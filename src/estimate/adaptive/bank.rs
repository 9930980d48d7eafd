//! The bank in motion: judge, weigh, learn, average, start anew.

use super::super::estimator::Estimator;
use super::super::square_root_information::SquareRootInformation;
use super::super::{ElasticNet, Prior};
use super::member::{Judgement, Member, track, weight};
use super::quality::{Adaptation, Quality};
use super::tuning::{Adaptive, CLIP, DEGREES_OF_FREEDOM, GATE, HANDICAP, LEAST_EVIDENCE};
use super::{COSTS, LONG, MEMBERS, NEXT_TO_NOTHING, PLAIN, SHARES, SHORT};
use crate::model::Row;
use crate::model::{Coefficients, TERMS, TermVector, dot};

/// Noise that is assumed where no calibration has told it, nT. It is found within half a minute.
const UNKNOWN_NOISE_NT: f32 = 1.0;

/// Times the noise that a free member starts with: where the calibration no longer holds, its noise need not either, and
/// a gate that is shut learns slowly. What is too much of it is gone within a minute.
const OPEN_GATE: f32 = 25.0;

/// Weight below which an epoch counts as not learnt.
const HARDLY: f32 = 0.1;

/// All that the adaptive method remembers.
#[derive(Clone, Debug)]
pub struct Bank {
    members: [Member; MEMBERS],
    average: Coefficients,
    previous: Option<Row>,
    until_aged: u32,
    /// Share of epochs of late that no member has predicted.
    surprises: f32,
    /// Information that comes in per epoch of late, less what is forgotten.
    income: f32,
    /// Epochs since no member predicted what came.
    since_failure: u32,
    quality: Quality,
}

impl AsRef<Coefficients> for Bank {
    fn as_ref(&self) -> &Coefficients {
        &self.average
    }
}

impl Bank {
    /// What was said of the latest epoch before it was learnt.
    pub fn quality(&self) -> &Quality {
        &self.quality
    }

    /// An epoch has passed that was not learnt.
    pub(crate) fn pass(&mut self) {
        self.quality.adaptation = Adaptation::Waiting;
    }

    /// Information of the most probable member. Its rows are differenced, or count several times: see
    /// [`noise_gain`](Self::noise_gain).
    pub fn information(&self) -> &SquareRootInformation {
        &self.members[self.leader()].factor
    }

    /// Variance of the noise in the rows behind [`information`](Self::information), if each were news, over that of the
    /// residual.
    pub fn noise_gain(&self, adaptive: &Adaptive) -> f32 {
        adaptive.manners[self.leader()].noise_gain
    }

    /// Probability of each member, from the one that keeps all of the calibration to the plain one.
    pub fn probabilities(&self) -> [f32; MEMBERS] {
        self.members.each_ref().map(|member| member.probability)
    }

    fn leader(&self) -> usize {
        let probability = |i: &usize| self.members[*i].probability;
        (0..MEMBERS).max_by(|a, b| probability(a).total_cmp(&probability(b))).unwrap_or(0)
    }

    /// Variance of the aged predictions, nT^2: that of the members, by their probability.
    fn aged_noise(&self) -> f32 {
        self.members.iter().map(|member| member.probability * member.aged_noise).sum()
    }

    /// Predicted standard deviation of the average's error: mixture of the members.
    fn predicted_std_nt(&self, judgements: &[Judgement; MEMBERS]) -> f32 {
        let mean = |of: &dyn Fn(&Judgement) -> f32| -> f32 {
            self.members.iter().zip(judgements).map(|(member, judgement)| member.probability * of(judgement)).sum()
        };
        let error_nt = mean(&|judgement| judgement.error_nt);
        let apart = |judgement: &Judgement| judgement.error_nt - error_nt;
        libm::sqrtf(mean(&|judgement| judgement.variance + apart(judgement) * apart(judgement)))
    }

    /// Judge the aged predictions. Aged, because fresh coefficients that have fitted half a target predict its other half
    /// well: judged by them, the member that eats targets wins.
    fn weigh(&mut self, row: &Row, adaptive: &Adaptive) {
        let noise = self.aged_noise();
        let mut least_square = f32::INFINITY;
        for (member, cost) in self.members.iter_mut().zip(COSTS) {
            let error_nt = member.aged_error_nt(row);
            let square = error_nt * error_nt;
            least_square = least_square.min(square);
            member.aged_noise = track(member.aged_noise, libm::sqrtf(square / member.aged_noise), adaptive.noise_rate);
            let loss = adaptive.evidence_per_epoch * libm::log1pf(square / (DEGREES_OF_FREEDOM * noise));
            let kept = member.evidence * (1.0 - adaptive.evidence_rate);
            member.evidence = kept - adaptive.evidence_rate * cost - loss;
        }
        self.normalise();
        let failed = least_square > CLIP * CLIP * noise;
        self.surprises += adaptive.surprise_rate * (f32::from(u8::from(failed)) - self.surprises);
    }

    /// Probabilities from the evidence.
    fn normalise(&mut self) {
        let best = self.members.iter().map(|member| member.evidence).fold(f32::NEG_INFINITY, f32::max);
        for member in &mut self.members {
            member.evidence = (member.evidence - best).max(LEAST_EVIDENCE);
            member.probability = libm::expf(member.evidence);
        }
        let sum: f32 = self.members.iter().map(|member| member.probability).sum();
        self.members.iter_mut().for_each(|member| member.probability /= sum);
    }

    /// Average the members' coefficients by their probability.
    fn average(&mut self) {
        let mut mean: TermVector = [0.0; TERMS];
        for member in &self.members {
            for (mean, theta) in mean.iter_mut().zip(member.coefficients.basis()) {
                *mean += member.probability * theta;
            }
        }
        if let Some(average) = Coefficients::from_basis(mean) {
            self.average = average;
        }
    }

    /// Start free members anew when no member has predicted what came for longer than a target lasts, and once more when
    /// that is over: what was learnt first came through a band-pass that still held the body as it was before.
    fn start_anew(&mut self, adaptive: &Adaptive) {
        let failing = self.surprises > 0.5;
        self.since_failure = if failing { 0 } else { self.since_failure.saturating_add(1) };
        let leader = self.leader();
        let challenger = self.challenger(leader);
        let is_due = |i: usize| {
            let tried = self.members[i].age_epochs >= adaptive.least_trial_epochs;
            i != leader && (failing && tried || self.since_failure == adaptive.least_trial_epochs)
        };
        let due = [challenger, PLAIN].map(is_due);
        // The one with the short memory forgets soon enough by itself.
        let had_its_time = leader != LONG && self.members[LONG].age_epochs >= adaptive.trial_epochs;
        if due[0] {
            self.replace(challenger, leader);
        } else if had_its_time {
            self.replace(LONG, leader);
        }
        if due[1] {
            self.replace(PLAIN, leader);
        }
    }

    /// Of the two free members the one that does not lead; of two that do not, the one that has waited longer.
    fn challenger(&self, leader: usize) -> usize {
        let long_has_waited = self.members[LONG].age_epochs >= self.members[SHORT].age_epochs;
        if leader == SHORT || leader != LONG && long_has_waited { LONG } else { SHORT }
    }

    /// A member that predicts as the bank does until it knows better, and keeps next to nothing of what the leader knows.
    fn replace(&mut self, member: usize, leader: usize) {
        let leader = &self.members[leader];
        let factor = leader.factor.discounted(NEXT_TO_NOTHING, &self.average);
        let mut fresh = Member::holding(factor, self.average, OPEN_GATE * leader.noise);
        fresh.aged_noise = self.aged_noise();
        fresh.evidence = -HANDICAP;
        self.members[member] = fresh;
    }

    fn note(&mut self, row: &Row, differenced: &Row, judgements: &[Judgement; MEMBERS], adaptive: &Adaptive) {
        let predicted_std_nt = self.predicted_std_nt(judgements);
        let error_nt = row.scalar_nt - self.average.predict_nt(&row.terms);
        let adapted = self.members.iter().map(|member| member.probability * member.adapted()).sum();
        let leader = self.leader();
        let forgotten = (1.0 - adaptive.manners[leader].forgetting) * self.members[leader].trace();
        let learnt = if leader == PLAIN { row } else { differenced };
        let income = dot(&learnt.terms, &learnt.terms) - forgotten;
        self.income += adaptive.surprise_rate * (income - self.income);
        let adaptation = if self.since_failure < adaptive.least_trial_epochs {
            Adaptation::Relearning
        } else if weight(libm::fabsf(error_nt) / predicted_std_nt, GATE) < HARDLY {
            Adaptation::Surprised
        } else if self.income < 0.0 {
            Adaptation::Resting
        } else {
            Adaptation::Learning
        };
        self.quality = Quality { predicted_std_nt, adapted, adaptation };
    }

    /// The row less what of it the previous one foretells: what the model leaves is correlated from epoch to epoch, and
    /// rows that are not differenced count the same news many times (Cochrane and Orcutt 1949).
    fn difference(&mut self, row: &Row, correlation: f32) -> Row {
        let before = self.previous.replace(*row).unwrap_or(Row { terms: [0.0; TERMS], scalar_nt: 0.0 });
        Row {
            terms: core::array::from_fn(|i| row.terms[i] - correlation * before.terms[i]),
            scalar_nt: row.scalar_nt - correlation * before.scalar_nt,
        }
    }
}

impl Estimator for Adaptive {
    type State = Bank;

    const IDLE: Bank = Bank {
        members: [const { Member::BLANK }; MEMBERS],
        average: Coefficients::ZERO,
        previous: None,
        until_aged: 0,
        surprises: 0.0,
        income: 0.0,
        since_failure: 0,
        quality: Quality::START,
    };

    fn start(&self, bank: &mut Bank, prior: &Prior) {
        let noise_nt = prior.information.map_or(UNKNOWN_NOISE_NT, |information| information.noise_nt());
        let noise = noise_nt * noise_nt;
        for (i, member) in bank.members.iter_mut().enumerate() {
            *member = match SHARES[i] {
                _ if i == SHORT => Member::knowing_nothing(OPEN_GATE * noise),
                share if i < LONG => self.keeping(share, prior, noise),
                share => self.keeping(share, prior, OPEN_GATE * noise),
            };
            member.aged_noise = noise;
            member.evidence = -COSTS[i];
        }
        bank.average = prior.coefficients;
        bank.since_failure = u32::MAX;
        bank.normalise();
        bank.average();
    }

    fn update(&self, bank: &mut Bank, row: &Row) {
        let judgements = core::array::from_fn(|i| bank.members[i].judge(row, self.manners[i].noise_gain));
        let differenced = bank.difference(row, self.correlation);
        bank.note(row, &differenced, &judgements, self);
        if bank.until_aged == 0 {
            bank.until_aged = self.age_epochs;
            bank.members.iter_mut().for_each(Member::age);
        }
        bank.until_aged -= 1;
        bank.weigh(row, self);
        for (i, (member, judgement)) in bank.members.iter_mut().zip(&judgements).enumerate() {
            let learnt = if i == PLAIN { row } else { &differenced };
            member.learn(learnt, judgement, &self.manners[i], self.noise_rate);
        }
        bank.average();
        bank.start_anew(self);
    }
}

impl Adaptive {
    /// A member that keeps a share of what the calibration knows; without its information, of what `lambda2` says.
    fn keeping(&self, share: f32, prior: &Prior, noise: f32) -> Member {
        let factor = match &prior.information {
            Some(information) => information.factor(share * self.manners[0].noise_gain),
            None => {
                let penalty = ElasticNet { lambda1: 0.0, lambda2: f64::from(share * self.unknown_weight) };
                SquareRootInformation::independent(&penalty.scaled_lambda2(), &prior.coefficients)
            }
        };
        Member::holding(factor, centre(prior), noise)
    }
}

/// Coefficients that the calibration's information is centred on.
fn centre(prior: &Prior) -> Coefficients {
    prior.information.map_or(prior.coefficients, |information| *information.centre())
}

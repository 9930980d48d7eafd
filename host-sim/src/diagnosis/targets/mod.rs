//! Targets: passing iron, whose dipoles both sensors read. They are what a survey is for, and no gap: found beside the
//! effects, left out where they are large, fitted where they are small, and listed.

mod dipole;
mod error;
mod fluxgate;
pub(crate) mod judged;
mod left_out;
mod nuisance;
mod residual;
mod rest;
mod scan;
pub(crate) mod search;
mod trimmed;

use super::base::blocks_of;
use super::noise::blocks::Block;
use super::policy::{TARGET_CLOSE_DISTANCES, TARGET_ERROR, TARGET_PART_MOST, TARGET_TAIL_SIGMAS, TARGETS_UNSEEN_PER_S};
use dipole::Dipole;
pub(crate) use dipole::Lobe;
use residual::OWN_DISTANCES;
pub(crate) use rest::Rest;

/// A target, or what the dipole of another one leaves near it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Target {
    pub(crate) dipole: Dipole,
    /// Chance that it is a target and nothing else.
    pub(crate) probability: f64,
    /// Whether it is a part of a larger one near by: a hull is no dipole.
    pub(crate) is_part: bool,
    /// Whether the fluxgate has it, too.
    is_seen: bool,
    /// GLRT of its dipole where it was found.
    glrt: f64,
    /// Noise of the scalar where it was found, nT.
    noise_nt: f64,
    /// Share of it that its dipole leaves, by its rms; 0 while it is looked for.
    error: f64,
}

/// The targets of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Targets {
    all: Vec<Target>,
    /// How often rows further from them were left out than at first.
    further: usize,
}

impl Targets {
    /// Those that are listed, in time.
    pub(crate) fn listed(&self) -> Vec<Target> {
        let mut listed: Vec<Target> = self.all.iter().filter(|target| !target.is_part).copied().collect();
        listed.sort_by(|a, b| a.dipole.epoch_s.total_cmp(&b.dipole.epoch_s));
        listed
    }

    /// What all of them add at some times, nT.
    pub(crate) fn anomaly_nt(&self, epochs_s: &[f64]) -> Vec<f64> {
        let sum = |s: &f64| self.all.iter().map(|target| target.dipole.anomaly_nt(*s)).sum();
        epochs_s.iter().map(sum).collect()
    }

    /// Usable rows without those that a target changes so quickly that what its dipole may have wrong of the change over the row before
    /// is more than noise.
    pub(crate) fn with_known_changes(&self, epochs_s: &[f64], usable: &[bool]) -> Vec<bool> {
        let change_nt = |dipole: &Dipole, row: usize| {
            dipole.anomaly_nt(epochs_s[row]) - dipole.anomaly_nt(epochs_s[row.saturating_sub(1)])
        };
        let is_known = |row: usize| {
            let knows = |target: &Target| TARGET_ERROR * change_nt(&target.dipole, row).abs() <= target.noise_nt;
            usable[row] && self.all.iter().all(knows)
        };
        (0..usable.len()).map(is_known).collect()
    }

    /// Blocks of the usable rows, each with what is fitted of the targets in it and near it.
    pub(crate) fn blocks(&self, epochs_s: &[f64], usable: &[bool]) -> Vec<Block> {
        blocks_of(epochs_s, usable).into_iter().map(|block| self.of_block(block, epochs_s)).collect()
    }

    fn of_block(&self, block: Block, epochs_s: &[f64]) -> Block {
        let epochs_s = &epochs_s[block.rows.clone()];
        let shows = |target: &&Target| {
            let least_nt = TARGET_TAIL_SIGMAS * target.noise_nt;
            epochs_s.iter().any(|s| target.dipole.anomaly_nt(*s).abs() > least_nt)
        };
        let columns = self.all.iter().filter(shows).flat_map(|target| target.dipole.columns(epochs_s)).collect();
        Block { targets: columns, ..block }
    }

    /// GLRT of those that `known` does not have, all together.
    pub(crate) fn glrt_beyond(&self, known: &Self) -> f64 {
        self.all[known.all.len()..].iter().map(|target| target.glrt).sum()
    }

    /// Share of a recording that those are in which `known` does not have.
    pub(crate) fn share_beyond(&self, known: &Self, duration_s: f64) -> f64 {
        let own_s = |target: &Target| 2.0 * OWN_DISTANCES * target.dipole.distance_s;
        self.all[known.all.len()..].iter().map(own_s).sum::<f64>() / duration_s
    }

    /// Without those that have met a better one: fits of two dipoles to one may be as large as they like, each against the other.
    fn without_met(self) -> Self {
        let mut all: Vec<Target> = self.all.clone();
        all.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
        let mut kept: Vec<Target> = Vec::new();
        for target in all {
            if !kept.iter().any(|better| better.dipole.has_met(&target.dipole)) {
                kept.push(target);
            }
        }
        Self { all: self.all.into_iter().filter(|target| kept.contains(target)).collect(), further: self.further }
    }

    /// Whether none is new beside those of the round before, nor has moved far of those that the fluxgate does not have.
    fn has_settled_from(&self, before: &Self) -> bool {
        let has_settled = |(now, before): (&Target, &Target)| now.is_seen || now.dipole.is_about(&before.dipole);
        self.all.len() == before.all.len() && self.all.iter().zip(&before.all).all(has_settled)
    }

    /// Without those that the fluxgate does not have, of those that `known` has not, where they are many: so many are something else.
    fn with_few_unseen(self, known: &Self, duration_s: f64) -> Self {
        let (old, new) = self.all.split_at(known.all.len());
        let unseen = new.iter().filter(|target| !target.is_seen).count();
        if unseen as f64 <= 1.0 + TARGETS_UNSEEN_PER_S * duration_s {
            return self;
        }
        let all = old.iter().chain(new.iter().filter(|target| target.is_seen)).copied().collect();
        Self { all, further: self.further }
    }
}

impl Target {
    /// Whether another dipole is rather what this one, which the fluxgate does not have, has wrong: it is fitted once more instead.
    fn is_known_badly(&self, other: &Dipole) -> bool {
        let apart_s = (self.dipole.epoch_s - other.epoch_s).abs();
        !self.is_seen && apart_s < TARGET_CLOSE_DISTANCES * self.dipole.distance_s.max(other.distance_s)
    }

    /// Whether another dipole may be what this one does not describe.
    fn has_part(&self, other: &Dipole) -> bool {
        let apart_s = (self.dipole.epoch_s - other.epoch_s).abs();
        let [own_nt, other_nt] = [&self.dipole, other].map(|dipole| dipole.largest_lobe().peak_nt.abs());
        let is_smaller = other_nt < TARGET_PART_MOST * own_nt;
        is_smaller && apart_s < TARGET_CLOSE_DISTANCES * self.dipole.distance_s
    }
}

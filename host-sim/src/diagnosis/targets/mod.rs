//! Targets: passing iron, whose dipoles both sensors read. They are what a survey is for, and no gap: found beside the
//! effects, left out where they are large, fitted where they are small, and listed.

mod dipole;
mod fluxgate;
pub(crate) mod judged;
mod nuisance;
mod residual;
mod rest;
mod scan;
pub(crate) mod search;
mod trimmed;

use super::base::blocks_of;
use super::noise::blocks::Block;
use super::policy::{
    TARGET_CLOSE_DISTANCES, TARGET_ERROR, TARGET_LEAST_LEFT, TARGET_MASKED_SIGMAS, TARGET_PART_MOST,
    TARGET_TAIL_SIGMAS, TARGETS_UNSEEN_PER_S,
};
use dipole::Dipole;
pub(crate) use dipole::Lobe;
pub(crate) use rest::Rest;
use trimmed::count;

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
}

/// The targets of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Targets {
    all: Vec<Target>,
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

    /// Usable rows without those where a target is so large that no dipole describes it well enough. Where targets leave
    /// little else, more of each is trusted.
    pub(crate) fn without_cores(&self, epochs_s: &[f64], usable: &[bool]) -> Vec<bool> {
        let tried = TARGET_MASKED_SIGMAS.map(|sigmas| self.without_larger(sigmas, epochs_s, usable));
        let is_enough = |left: &Vec<bool>| count(left) >= TARGET_LEAST_LEFT * count(usable);
        tried.into_iter().find(is_enough).unwrap_or_else(|| usable.to_vec())
    }

    /// Usable rows without those where a target is larger than so many standard deviations of the noise.
    fn without_larger(&self, sigmas: f64, epochs_s: &[f64], usable: &[bool]) -> Vec<bool> {
        let mut usable = usable.to_vec();
        for Target { dipole, noise_nt, .. } in &self.all {
            let reach_s = dipole.reach_s(sigmas * noise_nt);
            let first = epochs_s.partition_point(|s| *s < dipole.epoch_s - reach_s);
            let end = epochs_s.partition_point(|s| *s <= dipole.epoch_s + reach_s);
            if reach_s > 0.0 {
                usable[first..end].fill(false);
            }
        }
        usable
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
        Self { all: self.all.into_iter().filter(|target| kept.contains(target)).collect() }
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
        Self { all: old.iter().chain(new.iter().filter(|target| target.is_seen)).copied().collect() }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// How many of the rows of two minutes a target leaves whose peak is so many standard deviations of the noise.
    fn left_beside(sigmas: f64) -> f64 {
        let noise_nt = 0.05;
        let dipole = Dipole { epoch_s: 60.0, distance_s: 2.0, amplitudes_nt: [sigmas * noise_nt, 0.0, 0.0] };
        let target = Target { dipole, probability: 0.99, is_part: false, is_seen: true, glrt: 0.0, noise_nt };
        let epochs_s: Vec<f64> = (0..1200).map(|row| 0.1 * f64::from(row)).collect();
        count(&Targets { all: vec![target] }.without_cores(&epochs_s, &[true; 1200]))
    }

    #[test]
    fn a_target_is_fitted_but_for_the_core_of_a_large_one() {
        assert_eq!(left_beside(90.0), 1200.0);
        // Its third profile, (1 + u^2)^(-5/2), is a tenth of its peak at u = 1.23, which is 2.5 s on either side.
        assert!((left_beside(1000.0) - 1150.0).abs() < 6.0, "{}", left_beside(1000.0));
        assert!(left_beside(10_000.0) < left_beside(1000.0));
    }
}

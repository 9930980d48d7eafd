//! Targets: passing iron, whose dipoles both sensors read. They are what a survey is for, and no gap: found beside the
//! effects, left out where they are large, fitted where they are small, and listed.

mod dipole;
mod fluxgate;
mod residual;
mod rest;
mod scan;
mod trimmed;

use super::base::blocks_of;
use super::noise::blocks::Block;
use super::noise::whitening::Whitening;
use super::policy::{
    RATE_HZ, TARGET_CLEAR_DISTANCES_S, TARGET_CLEAR_GLRT, TARGET_CLEAR_LEFT, TARGET_CLEAR_LOG_ODDS,
    TARGET_CLEAR_MISFIT, TARGET_CLEAR_NOISE, TARGET_CLOSE_DISTANCES, TARGET_DESCRIBED_LARGEST, TARGET_DESCRIBED_SIGMAS,
    TARGET_GLRT, TARGET_LEAST_LEFT, TARGET_LEFT_MOST, TARGET_MASKED_SIGMAS, TARGET_MISFIT_MOST, TARGET_PART_MOST,
    TARGET_RATIOS, TARGET_ROUNDS, TARGET_SEEN_STRENGTH, TARGET_SHADOW_DISTANCES, TARGET_SHADOW_MOST_S,
    TARGET_TAIL_SIGMAS, TARGETS_UNSEEN_PER_S,
};
use super::reconstruct::prepared::Prepared;
use crate::simulator::signals::Signals;
use dipole::Dipole;
pub(crate) use dipole::Lobe;
use fluxgate::magnitude;
use rayon::prelude::*;
use residual::{Fitted, Residual};
pub(crate) use rest::Rest;
use scan::{Spot, noise_beside, spots};
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
    /// Whether the dipole leaves no more where it is than there is beside it: then more of it is fitted.
    is_described: bool,
}

/// The targets of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Targets {
    all: Vec<Target>,
}

/// Which targets may be taken for one; each also those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Trust {
    /// Those that both sensors have.
    SeenByBoth,
    /// Those of the scalar that nothing but a target looks like.
    Clear,
    /// Those of the scalar that are too weak for the fluxgate to tell.
    Unseen,
}

impl Targets {
    /// Those that are listed, in time.
    pub(crate) fn listed(&self) -> Vec<Target> {
        let mut listed: Vec<Target> = self.all.iter().filter(|target| !target.is_part).copied().collect();
        listed.sort_by(|a, b| a.dipole.epoch_s.total_cmp(&b.dipole.epoch_s));
        listed
    }

    /// Usable rows without those where a target is so large that no dipole describes it well enough. Where targets leave
    /// little else, more of each is trusted.
    pub(crate) fn without_cores(&self, epochs_s: &[f64], usable: &[bool]) -> Vec<bool> {
        let tried = TARGET_MASKED_SIGMAS.map(|sigmas| self.without_larger(sigmas, epochs_s, usable));
        let is_enough = |left: &Vec<bool>| count(left) >= TARGET_LEAST_LEFT * count(usable);
        tried.into_iter().find(is_enough).unwrap_or_else(|| usable.to_vec())
    }

    /// Usable rows without those where a target is larger than so many standard deviations of the noise, or as many as its
    /// dipole describes.
    fn without_larger(&self, sigmas: f64, epochs_s: &[f64], usable: &[bool]) -> Vec<bool> {
        let mut usable = usable.to_vec();
        for Target { dipole, noise_nt, is_described, .. } in &self.all {
            let is_fitted = *is_described && dipole.reach_s(TARGET_DESCRIBED_LARGEST * noise_nt) == 0.0;
            let sigmas = if is_fitted { sigmas.max(TARGET_DESCRIBED_SIGMAS) } else { sigmas };
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

    /// With those of some dipoles that are targets; `rest` is that of the scalar.
    fn with_more(&self, found: &[Found], other: &Residual<'_>, trust: Trust, rest: &Rest) -> Self {
        let mut targets = self.clone();
        for Found { fitted, noise } in found {
            let is_clear = || fitted.dipole.largest_lobe().peak_nt.abs() >= rest.clear_nt();
            let is_new = |is_seen| is_seen || !targets.all.iter().any(|other| other.is_known_badly(&fitted.dipole));
            let judged = probability(fitted, *noise, other, trust, is_clear);
            if let Some((probability, is_seen)) = judged.filter(|(_, is_seen)| is_new(*is_seen)) {
                let is_part = targets.all.iter().any(|other| other.has_part(&fitted.dipole));
                let (is_described, noise_nt) = (fitted.is_all(*noise), rest.noise_nt);
                let Fitted { dipole, glrt, .. } = *fitted;
                targets.all.push(Target { dipole, probability, is_part, is_seen, glrt, noise_nt, is_described });
            }
        }
        targets
    }

    /// GLRT of those that `known` does not have, all together.
    pub(crate) fn glrt_beyond(&self, known: &Self) -> f64 {
        self.all[known.all.len()..].iter().map(|target| target.glrt).sum()
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

/// That a dipole fitted to one sensor is a target, by what the `other` says; none where it is not taken for one.
/// `is_clear` tells whether it would be one if the other sensor says nothing. With it, whether the other has it, too.
fn probability(
    fitted: &Fitted,
    noise: f64,
    other: &Residual<'_>,
    trust: Trust,
    is_clear: impl Fn() -> bool,
) -> Option<(f64, bool)> {
    let seen = other.seen(&fitted.dipole);
    // Logarithm of the likelihood that the other has it over that it has nothing.
    let log_ratio = 0.5 * (2.0 * seen.ratio - 1.0) * seen.strength * seen.strength;
    let tells = seen.strength >= TARGET_SEEN_STRENGTH;
    if tells && (TARGET_RATIOS[0]..=TARGET_RATIOS[1]).contains(&seen.ratio) {
        return Some((odds(log_ratio + 2.0), true));
    }
    if trust < Trust::Clear || !is_clear() {
        return None;
    }
    if is_nothing_else(fitted, noise) && log_ratio + TARGET_CLEAR_LOG_ODDS >= 0.0 {
        return Some((odds(log_ratio + TARGET_CLEAR_LOG_ODDS + 1.0), false));
    }
    let is_dipole = !tells && fitted.left() <= TARGET_LEFT_MOST * noise;
    (trust == Trust::Unseen && is_dipole).then(|| (odds(log_ratio + 1.0), false))
}

/// Whether a dipole is so clear and leaves so little that nothing but a target looks like it.
fn is_nothing_else(fitted: &Fitted, noise: f64) -> bool {
    let [nearest_s, furthest_s] = TARGET_CLEAR_DISTANCES_S;
    (nearest_s..=furthest_s).contains(&fitted.dipole.distance_s)
        && noise <= TARGET_CLEAR_NOISE
        && fitted.glrt >= TARGET_CLEAR_GLRT * noise
        && fitted.misfit() <= TARGET_CLEAR_MISFIT
        && fitted.left() <= TARGET_CLEAR_LEFT * noise
}

/// A probability from the logarithm of the odds.
fn odds(log: f64) -> f64 {
    (1.0 / (1.0 + (-log).exp())).clamp(0.5, 0.999)
}

/// Spots without those that may be the flank of a better one: they are looked at again once that is known.
fn in_the_open(spots: Vec<Spot>) -> Vec<Spot> {
    let mut open: Vec<Spot> = Vec::new();
    let mut all = Vec::new();
    for spot in spots {
        let is_shadow = |larger: &Spot| {
            let reach_s = TARGET_SHADOW_DISTANCES * larger.distance_s.max(spot.distance_s);
            larger.row.abs_diff(spot.row) as f64 <= RATE_HZ * reach_s.min(TARGET_SHADOW_MOST_S)
        };
        if !all.iter().any(is_shadow) {
            open.push(spot);
        }
        all.push(spot);
    }
    open
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

/// A dipole that a sensor shows.
struct Found {
    fitted: Fitted,
    /// Mean square of the noise beside it, whitened.
    noise: f64,
}

impl Found {
    /// Those that explain enough, and describe what they explain, the best spot first.
    fn all(residual: &Residual<'_>) -> Vec<Self> {
        let near = in_the_open(spots(residual)).into_par_iter().map(|spot| Self::near(residual, &spot));
        near.filter(Self::is_dipole).collect()
    }

    fn near(residual: &Residual<'_>, spot: &Spot) -> Self {
        let epoch_s = residual.epochs_s[spot.row];
        let start = Dipole { epoch_s, distance_s: spot.distance_s, amplitudes_nt: [0.0; 3] };
        let fitted = residual.fitted_from(&start);
        Self { noise: noise_beside(residual, spot.row, fitted.dipole.distance_s), fitted }
    }

    fn is_dipole(&self) -> bool {
        self.fitted.glrt / self.noise >= TARGET_GLRT && self.fitted.misfit() <= TARGET_MISFIT_MOST
    }
}

/// Looks for the targets of a recording.
pub(crate) struct TargetSearch<'b> {
    pub(crate) table: &'b Prepared,
    pub(crate) signals: &'b Signals,
}

impl TargetSearch<'_> {
    /// Those that both sensors show, or the scalar beyond doubt, on what the 18 terms leave: `rest` is that beside some targets.
    pub(crate) fn at_start(&self, rest: impl Fn(&Targets) -> Rest) -> Targets {
        let mut targets = Targets::default();
        for _ in 0..TARGET_ROUNDS {
            let rest = rest(&targets);
            let more = self.beside(&self.again(&targets, &rest), &rest, Trust::Clear);
            let is_all = more.has_settled_from(&targets);
            targets = more;
            if is_all {
                break;
            }
        }
        targets
    }

    /// `known` and those that the sensors show beside them; `rest` is what a fit of the scalar leaves.
    pub(crate) fn beside(&self, known: &Targets, rest: &Rest, trust: Trust) -> Targets {
        let epochs_s = self.signals.epochs_s();
        let usable = &known.without_cores(epochs_s, &self.table.usable);
        let magnitude = magnitude(self.table, self.signals, usable, |usable| known.blocks(epochs_s, usable));
        let (scalar, fluxgate) = (Residual::of(rest, epochs_s), Residual::of(&magnitude, epochs_s));
        if magnitude.std_nt() < rest.std_nt() {
            // What is quieter shows more: here the fluxgate, but both must have it.
            let found = known.with_more(&Found::all(&fluxgate), &scalar, Trust::SeenByBoth, rest);
            if found.all.len() > known.all.len() {
                return found;
            }
        }
        let found = known.with_more(&Found::all(&scalar), &fluxgate, trust, rest);
        found.with_few_unseen(known, epochs_s.last().copied().unwrap_or(0.0))
    }

    /// The targets fitted once more, one after the other, now that 18 terms and noise are known without them.
    fn again(&self, targets: &Targets, rest: &Rest) -> Targets {
        if targets.all.is_empty() {
            return targets.clone();
        }
        let epochs_s = self.signals.epochs_s();
        let blocks = blocks_of(epochs_s, &self.table.usable);
        let whitening = Whitening::new(&blocks, rest.whitening.predictor().clone(), None);
        let add = |column: &mut [f64], dipole: &Dipole, sign: f64| {
            column.iter_mut().zip(epochs_s).for_each(|(nt, s)| *nt += sign * dipole.anomaly_nt(*s));
        };
        let mut left_nt = rest.residual_nt.clone();
        targets.all.iter().for_each(|target| add(&mut left_nt, &target.dipole, -1.0));
        let mut targets = targets.clone();
        for target in &mut targets.all {
            add(&mut left_nt, &target.dipole, 1.0);
            let whitened = whitening.apply(&left_nt);
            let residual = Residual::whitened(&whitening, epochs_s, &left_nt, &whitened);
            let fitted = residual.followed(residual.judged(&target.dipole));
            let row = epochs_s.partition_point(|s| *s < fitted.dipole.epoch_s).min(epochs_s.len() - 1);
            target.dipole = fitted.dipole;
            target.is_described = fitted.is_all(noise_beside(&residual, row, fitted.dipole.distance_s));
            add(&mut left_nt, &target.dipole, -1.0);
        }
        targets
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many of the rows of two minutes a target leaves whose peak is so many standard deviations of the noise.
    fn left_beside(sigmas: f64, is_described: bool) -> f64 {
        let noise_nt = 0.05;
        let dipole = Dipole { epoch_s: 60.0, distance_s: 2.0, amplitudes_nt: [sigmas * noise_nt, 0.0, 0.0] };
        let target =
            Target { dipole, probability: 0.99, is_part: false, is_seen: true, glrt: 0.0, noise_nt, is_described };
        let epochs_s: Vec<f64> = (0..1200).map(|row| 0.1 * f64::from(row)).collect();
        count(&Targets { all: vec![target] }.without_cores(&epochs_s, &[true; 1200]))
    }

    #[test]
    fn a_target_that_its_dipole_describes_is_fitted_but_for_a_large_one() {
        assert_eq!(left_beside(9.0, false), 1200.0);
        assert_eq!(left_beside(90.0, true), 1200.0);
        assert!(left_beside(90.0, false) < 1180.0);
        assert!(left_beside(900.0, true) > left_beside(900.0, false) && left_beside(900.0, true) < 1200.0);
        assert_eq!(left_beside(1100.0, true), left_beside(1100.0, false));
    }
}

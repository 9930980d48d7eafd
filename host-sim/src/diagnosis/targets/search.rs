//! The search for targets: what both sensors show, or the scalar alone beyond doubt.

use rayon::prelude::*;

use super::dipole::Dipole;
use super::fluxgate::magnitude;
use super::judged::{Trust, probability};
use super::residual::{Fitted, Residual};
use super::rest::Rest;
use super::scan::{Spot, noise_beside, spots};
use super::{Target, Targets};
use crate::diagnosis::base::blocks_of;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::policy::{
    RATE_HZ, TARGET_GLRT, TARGET_MISFIT_MOST, TARGET_ROUNDS, TARGET_SHADOW_DISTANCES, TARGET_SHADOW_MOST_S,
};
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::simulator::signals::Signals;

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
        let of = |residual: &Residual<'_>, fitted: Fitted| Self {
            noise: noise_beside(residual, spot.row, fitted.dipole.distance_s),
            fitted,
        };
        residual.freed(&fitted).map_or_else(|| of(residual, fitted), |(residual, fitted)| of(&residual, fitted))
    }

    fn is_dipole(&self) -> bool {
        self.fitted.glrt / self.noise >= TARGET_GLRT && self.fitted.misfit() <= TARGET_MISFIT_MOST
    }
}

impl Targets {
    /// With those of some dipoles that are targets; `rest` is that of the scalar.
    fn with_more(&self, found: &[Found], other: &Residual<'_>, trust: Trust, rest: &Rest) -> Self {
        let mut targets = self.clone();
        for Found { fitted, noise } in found {
            let is_clear = || fitted.dipole.largest_lobe().peak_nt.abs() >= rest.clear_nt();
            let is_new = |is_seen: bool| {
                let is_known = |other: &Target| {
                    other.dipole.has_met(&fitted.dipole) || (!is_seen && other.is_known_badly(&fitted.dipole))
                };
                !targets.all.iter().any(is_known)
            };
            let judged = probability(fitted, *noise, other, trust, is_clear);
            if let Some((probability, is_seen)) = judged.filter(|(_, is_seen)| is_new(*is_seen)) {
                let is_part = targets.all.iter().any(|other| other.has_part(&fitted.dipole));
                let noise_nt = rest.noise_nt;
                let Fitted { dipole, glrt, .. } = *fitted;
                // It is held to be known as badly as any.
                let error = targets.all.iter().map(|other| other.error).fold(0.0, f64::max);
                targets.all.push(Target { dipole, probability, is_part, is_seen, glrt, noise_nt, error });
            }
        }
        targets
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
        if targets.all.is_empty() {
            return targets;
        }
        let (epochs_s, rest) = (self.signals.epochs_s(), rest(&targets));
        targets.with_errors(&rest.residual_nt, rest.noise_nt, epochs_s, &blocks_of(epochs_s, &self.table.usable))
    }

    /// `known` and those that the sensors show beside them; `rest` is what a fit of the scalar leaves.
    pub(crate) fn beside(&self, known: &Targets, rest: &Rest, trust: Trust) -> Targets {
        let epochs_s = self.signals.epochs_s();
        let usable = &known.without_cores(epochs_s, &self.table.usable);
        let magnitude = magnitude(self.table, self.signals, usable, |usable| known.blocks(epochs_s, usable));
        let (scalar, fluxgate) = (Residual::of(rest, epochs_s), Residual::of(&magnitude, epochs_s));
        let by_fluxgate = || known.with_more(&Found::all(&fluxgate), &scalar, Trust::SeenByBoth, rest);
        // What bends the 18 terms most; what they bend is no target once that is known.
        let by_best_of_fluxgate = || {
            let best = Found::all(&fluxgate).into_iter().max_by(|a, b| a.fitted.glrt.total_cmp(&b.fitted.glrt));
            known.with_more(best.as_slice(), &scalar, Trust::SeenByBoth, rest)
        };
        let by_scalar = || known.with_more(&Found::all(&scalar), &fluxgate, trust, rest);
        let has_more = |found: &Targets| found.all.len() > known.all.len();
        // What is quieter shows more. The other has its turn where that shows nothing: the 18 terms bend the scalar, not the fluxgate.
        let found = if magnitude.std_nt() < rest.std_nt() {
            Some(by_fluxgate()).filter(has_more).unwrap_or_else(by_scalar)
        } else {
            Some(by_scalar()).filter(has_more).unwrap_or_else(by_best_of_fluxgate)
        };
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
            // Where its rows are masked the 18 terms may be anything: a dipole that is far larger or smaller then is what they have wrong.
            if fitted.dipole.is_as_large_as(&target.dipole) {
                (target.dipole, target.glrt) = (fitted.dipole, fitted.glrt);
            }
            add(&mut left_nt, &target.dipole, -1.0);
        }
        targets.without_met()
    }
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

//! A group of shapes held against what is left.

use super::left::Left;
use crate::diagnosis::policy::{DRIVER_BEYOND_HELD_OUT, PROPOSAL_LEAST_GAIN};
use crate::diagnosis::shapes::expression::{Expr, summed};
use crate::diagnosis::shapes::group::{Group, Shown, net_gain};
use crate::diagnosis::shapes::ridge::{Folded, Ridge};
use crate::diagnosis::shapes::scene::Scene;

/// Share that a shape leaves at least, as far as is counted.
const LEAST_LEFT: f64 = 1e-9;

/// A group held against a residual.
pub(crate) struct Judged {
    pub(crate) group: Group,
    /// Shapes that show, and the columns that the residual would show of them, scaled to about one norm, with the scales.
    pub(crate) shapes: Vec<Expr>,
    pub(crate) scales: Vec<f64>,
    pub(crate) folded: Folded,
    /// That does best on parts held out.
    pub(crate) prior: f64,
    /// Logarithm of how much likelier it makes the residual.
    pub(crate) gain: f64,
    /// The same of the residual turned round in time: mean and spread.
    pub(crate) by_chance: (f64, f64),
    /// Reduction of the sum of squares on parts held out.
    pub(crate) taken: f64,
}

impl Judged {
    /// Of the group on a residual; none where none of its shapes shows, or where it does no more than it would without its input.
    pub(crate) fn of(group: Group, left: &Left<'_>, scene: &Scene) -> Option<Self> {
        let fitted = (&left.problem, &left.fit.projection);
        let without_input = group.without_input().and_then(|without| without.weighed(fitted, &left.z, scene));
        let judged = Self::of_all(group, left, scene)?;
        without_input.is_none_or(|(without, ..)| judged.gain > without + PROPOSAL_LEAST_GAIN).then_some(judged)
    }

    fn of_all(group: Group, left: &Left<'_>, scene: &Scene) -> Option<Self> {
        let shown = group.shown(&left.problem, &left.fit.projection, scene)?;
        let folded = Folded::new(&shown.columns, &left.z, &left.parts);
        let ridge = Ridge::of(&folded.all);
        let (prior, gain) = ridge.best();
        let (tighter, taken) = folded.held_out(prior);
        let by_chance = shown.gain_by_chance(&ridge, &left.z);
        let Shown { shapes, scales, .. } = shown;
        let gain = gain - group.tried.ln();
        Some(Self { group, shapes, scales, folded, prior: tighter, gain, by_chance, taken })
    }

    /// What its shapes add to the reading, shrunk as does best on parts held out, nT, one value a row.
    pub(crate) fn course(&self, scene: &Scene) -> Option<Vec<f64>> {
        let weights = Ridge::of(&self.folded.all).weights(self.prior);
        summed(weights.iter().zip(&self.scales).map(|(weight, scale)| weight * scale).zip(&self.shapes), scene)
    }

    /// Gain over what chance gives, in standard deviations of that.
    pub(crate) fn beyond_chance(&self) -> f64 {
        (self.gain - self.by_chance.0) / self.by_chance.1.max(2.0)
    }

    /// Share of the sum of squares that one plain column would have to take to gain as much.
    pub(crate) fn share_by_evidence(&self) -> f64 {
        1.0 - (-2.0 * self.net_gain().max(0.0) / self.folded.all.n.max(1.0)).exp()
    }

    /// Gain over what chance gives of what it leaves: turned round in time, what it explains has its colour too. What parts held out do not
    /// bear out counts to a limit only.
    pub(crate) fn gain_of_rest(&self) -> f64 {
        let left = 1.0 - (self.taken / self.folded.all.zz.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0 - LEAST_LEFT);
        let held_out = -0.5 * self.folded.all.n * left.ln();
        net_gain(self.gain, (left * self.by_chance.0, left * self.by_chance.1)).min(held_out + DRIVER_BEYOND_HELD_OUT)
    }

    /// Gain over what chance gives.
    pub(crate) fn net_gain(&self) -> f64 {
        net_gain(self.gain, self.by_chance)
    }
}

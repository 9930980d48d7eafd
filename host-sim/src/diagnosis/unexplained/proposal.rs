//! An effect that is proposed: the few shapes of a group that do as well as all of them, or all of them shrunk; accepted only for what
//! it closes on parts of the recording that neither chose its shapes nor fitted their sizes.

use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;

use super::judged::Judged;
use super::left::Left;
use crate::diagnosis::evidence::shrink::{GapClosed, Halves, closed_of_parts};
use crate::diagnosis::policy::{
    PROPOSAL_LEAST_CLOSED, PROPOSAL_LEAST_GAIN, PROPOSAL_LEAST_TAKEN, PROPOSAL_MOST_TERMS, PROPOSAL_SPARSE_AS_GOOD,
    PROPOSAL_TRIED,
};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::shapes::expression::{Expr, rounded, summed};
use crate::diagnosis::shapes::ridge::{Folded, Products, Ridge, reduction};
use crate::diagnosis::shapes::scene::Scene;
use crate::effects::Channel;

/// Shapes that a closed form may have.
const MOST_SPARSE: usize = 6;
/// Of the prior of a sparse fit, over the group's: next to none.
const LOOSE: f64 = 1e3;

/// A shape with its sizes, and what it does.
#[derive(Clone, Debug)]
pub(crate) struct Proposal {
    pub(crate) channel: Channel,
    pub(crate) input: String,
    /// nT for each unit of a shape.
    pub(crate) terms: Vec<(f64, Expr)>,
    /// Whether the few shapes did as well as all.
    pub(crate) is_closed_form: bool,
    pub(crate) closed: GapClosed,
}

/// How a fit of a group's shapes is made.
#[derive(Clone, Copy)]
enum Way {
    /// All of them, shrunk.
    Shrunk(f64),
    /// So many, one after the other.
    Sparse(usize),
}

impl Proposal {
    /// Of a group that drives what is left. `that_fit` says how many of its terms, from the first on, a file can hold; none where it holds
    /// none.
    pub(crate) fn of(
        judged: &Judged,
        left: &Left<'_>,
        that_fit: impl Fn(&Self) -> usize,
        draw: &mut ChaCha8Rng,
    ) -> Option<Self> {
        let written: Vec<usize> = (0..judged.shapes.len()).collect();
        let folded = &judged.folded;
        let shrunk = Way::Shrunk(judged.prior);
        let sparse = (1..=MOST_SPARSE.min(written.len())).map(Way::Sparse);
        let held_out = |way: &Way| total(&held_out(folded, *way));
        let all = held_out(&shrunk);
        let few = sparse.clone().map(|way| held_out(&way)).fold(f64::NEG_INFINITY, f64::max);
        let is_closed_form = few >= PROPOSAL_SPARSE_AS_GOOD * all;
        // Of what is strong a hundredth is seen on the next recording: another shape stays while it takes more than noise would.
        let as_good = few - PROPOSAL_LEAST_TAKEN * left.variance;
        let way = match is_closed_form {
            true => sparse.into_iter().find(|way| held_out(way) >= as_good)?,
            false => shrunk,
        };
        let whole = Self::fitted(judged, left, &written, way, is_closed_form, draw);
        match that_fit(&whole) {
            0 => None,
            count if count == whole.terms.len() => Some(whole),
            // The file is what is proposed: the shapes that it can hold are fitted again, and what they close is told.
            count => {
                let kept = |k: &usize| whole.terms[..count].iter().any(|(_, shape)| *shape == judged.shapes[*k]);
                let written: Vec<usize> = written.iter().copied().filter(kept).collect();
                Some(Self::fitted(judged, left, &written, shrunk, false, draw))
            }
        }
    }

    /// Some shapes of a group with the sizes that a way gives them.
    fn fitted(
        judged: &Judged,
        left: &Left<'_>,
        written: &[usize],
        way: Way,
        is_closed_form: bool,
        draw: &mut ChaCha8Rng,
    ) -> Self {
        let folded = judged.folded.of(written);
        let weights = weights(&folded.all, way);
        let terms = written.iter().zip(weights.iter()).filter(|(_, weight)| **weight != 0.0);
        let terms = terms.map(|(&k, weight)| (rounded(weight * judged.scales[k]), judged.shapes[k].clone())).collect();
        Self {
            channel: left.problem.channel,
            input: judged.group.input.clone(),
            terms: largest(terms, judged, left),
            is_closed_form,
            closed: closed(&folded, way, left, draw),
        }
    }

    /// What it adds to the reading, nT, one value a row.
    pub(crate) fn course(&self, scene: &Scene) -> Option<Vec<f64>> {
        summed(self.terms.iter().map(|(weight, shape)| (*weight, shape)), scene)
    }

    /// Whether it closes enough beyond doubt, and beyond what so many tries find by chance.
    pub(crate) fn is_accepted(&self, judged: &Judged) -> bool {
        self.closed.ci95[0] > PROPOSAL_LEAST_CLOSED && judged.net_gain() > PROPOSAL_LEAST_GAIN + PROPOSAL_TRIED.ln()
    }

    /// Share of what is left of another recording that goes with it, nothing fitted to that but the 18 terms, the background and the effects
    /// that are named.
    pub(crate) fn frozen(&self, there: &Left<'_>, scene: &Scene, draw: &mut ChaCha8Rng) -> Option<GapClosed> {
        let column = there.swept(&[self.course(scene)?]).remove(0);
        let halves = there.parts.iter().map(|part| {
            let z = &there.z[part.samples.clone()];
            let after = z.iter().zip(&column[part.samples.clone()]).map(|(z, x)| (z - x).powi(2)).sum();
            Halves { before: dot(z, z), after, noise: there.variance * z.len() as f64 }
        });
        Some(closed_of_parts(&halves.collect::<Vec<_>>(), there.variance, draw))
    }
}

/// The terms that add most, as many as a file is given.
fn largest(terms: Vec<(f64, Expr)>, judged: &Judged, left: &Left<'_>) -> Vec<(f64, Expr)> {
    let size = |(weight, shape): &(f64, Expr)| {
        let scale = judged.shapes.iter().position(|other| other == shape).map_or(1.0, |k| judged.scales[k]);
        (weight / scale).abs() * (left.z.len() as f64).sqrt()
    };
    let mut terms = terms;
    terms.sort_by(|a, b| size(b).total_cmp(&size(a)));
    terms.truncate(PROPOSAL_MOST_TERMS);
    terms
}

fn weights(products: &Products, way: Way) -> DVector<f64> {
    match way {
        Way::Shrunk(prior) => Ridge::of(products).weights(prior),
        Way::Sparse(count) => sparse(products, count),
    }
}

/// Forward selection: each time the shape that lowers the sum of squares most, all chosen fitted again.
fn sparse(products: &Products, count: usize) -> DVector<f64> {
    let m = products.q.len();
    let mut chosen: Vec<usize> = Vec::new();
    let mut best = DVector::zeros(m);
    for _ in 0..count {
        let tried = (0..m).filter(|k| !chosen.contains(k)).map(|k| {
            let columns: Vec<usize> = chosen.iter().copied().chain([k]).collect();
            let own = products.of(&columns);
            let most = own.gram.diagonal().max().max(f64::MIN_POSITIVE);
            let weights = Ridge::of(&own).weights(LOOSE * 1e6 / most);
            (reduction(&own, &weights), columns, weights)
        });
        let Some((_, columns, weights)) = tried.max_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        best = DVector::zeros(m);
        columns.iter().zip(weights.iter()).for_each(|(&k, weight)| best[k] = *weight);
        chosen = columns;
    }
    best
}

/// Reduction of each fold by what the others choose and fit.
fn held_out(folded: &Folded, way: Way) -> Vec<f64> {
    (0..folded.folds.len()).map(|fold| reduction(&folded.folds[fold], &weights(&folded.training(fold), way))).collect()
}

fn total(values: &[f64]) -> f64 {
    values.iter().sum()
}

/// The share that goes, with its interval from the folds.
fn closed(folded: &Folded, way: Way, left: &Left<'_>, draw: &mut ChaCha8Rng) -> GapClosed {
    let share = left.excess / left.z.len().max(1) as f64;
    let of_fold = |(fold, by): (&Products, f64)| Halves {
        before: fold.zz,
        after: fold.zz - by,
        noise: fold.zz - (share * fold.n).min(fold.zz),
    };
    let halves: Vec<Halves> = folded.folds.iter().zip(held_out(folded, way)).map(of_fold).collect();
    // Noise over the parts comes from the whole, as the excess does.
    closed_of_parts(&halves, left.variance, draw)
}

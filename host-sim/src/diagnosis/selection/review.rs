//! A second look at what was found: is it needed, and would another effect do better?

use super::state::{Accepted, State};
use crate::diagnosis::policy::{BETTER, OPPOSITE, RIVAL_MARGIN};
use crate::diagnosis::regression::problem::Fit;
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::search::Candidate;

/// What would do in the place of an effect, and its evidence there.
struct Rivals {
    fitted: Vec<Candidate>,
    own_effect: usize,
    variance: f64,
    samples: f64,
}

impl Rivals {
    fn evidence(&self, candidate: &Candidate) -> f64 {
        candidate.evidence(self.variance, self.samples)
    }

    /// Those of other effects, as they are told.
    fn others(&self) -> Vec<(usize, f64)> {
        let others = self.fitted.iter().filter(|rival| rival.term.effect != self.own_effect);
        others.map(|rival| (rival.term.effect, self.evidence(rival))).collect()
    }

    /// The best one that is no noise.
    fn best_additive(&self) -> Option<&Candidate> {
        self.fitted.iter().find(|rival| rival.variance.is_none())
    }
}

impl State<'_> {
    /// Take each effect out: is it needed, and would another do better? With it, whether anything changed.
    pub(super) fn reviewed(self) -> (Self, bool) {
        let (mut state, mut has_changed, mut index) = (self, false, 0);
        while index < state.accepted.len() {
            state = state.judged(index);
            if !state.is_still_accepted(index) {
                (state, has_changed) = (state.without(index), true);
                continue;
            }
            let (compared, is_replaced) = state.compared(index);
            (state, has_changed, index) = (compared, has_changed || is_replaced, index + 1);
        }
        if has_changed { (state.forward(), true) } else { (state, false) }
    }

    /// Hold an effect against every other in its place; the better one stays. With it, whether it was replaced.
    fn compared(mut self, accepted: usize) -> (Self, bool) {
        let own = self.accepted[accepted].candidate.clone();
        let evidence = own.evidence(self.variance(), self.samples());
        self.accepted[accepted].evidence = evidence;
        let Some(index) = self.term_index(accepted).filter(|_| !self.is_exhausted()) else {
            self.accepted[accepted].rivals.clear();
            return (self, false);
        };
        let without = self.fit_without(index);
        let rivals = self.rivals_of(&own, evidence, &without);
        self.accepted[accepted].rivals = rivals.others();
        let better = rivals.best_additive().filter(|best| rivals.evidence(best) > evidence + BETTER);
        let Some(best) = better.cloned() else { return (self, false) };
        let is_own = best.term.effect == own.term.effect;
        let others = if is_own { rivals.others() } else { vec![(own.term.effect, evidence)] };
        let log_p = self.log_p_in(&best, &without);
        let mut terms = self.fit.terms.clone();
        terms[index] = best.term.clone();
        self.accepted[accepted] =
            Accepted { log_p, evidence: rivals.evidence(&best), rivals: others, ..Accepted::new(best) };
        (self.refitted(&terms).whitened().tried_again(), true)
    }

    /// Effects nearly as good as `own` in its place, each fitted jointly with the rest.
    fn rivals_of(&self, own: &Candidate, evidence: f64, without: &Fit) -> Rivals {
        let (variance, samples) = (self.variance(), self.samples());
        let mut excluded = self.used();
        // Its own effect too, with other values: a moment or a period was found before the rest was known.
        excluded.retain(|&effect| effect != own.term.effect);
        let least = evidence - RIVAL_MARGIN.of(evidence);
        let table = self.scanned(without, &excluded);
        let near: Vec<Candidate> =
            table.into_rows().filter(|candidate| candidate.evidence(variance, samples) > least).collect();
        Rivals { fitted: self.refined(&near, without), own_effect: own.term.effect, variance, samples }
    }

    /// Two effects that add almost the opposite of each other are one at most: the lesser goes, and then the other unless
    /// it is needed by itself.
    pub(super) fn without_opposites(self) -> Self {
        let mut state = self;
        while let Some((first, second)) = state.opposites() {
            let cost = |accepted: usize| state.term_index(accepted).map_or(0.0, |index| state.fit_without(index).sse());
            let (lesser, other) = if cost(first) < cost(second) { (first, second) } else { (second, first) };
            let effect = state.accepted[other].effect();
            state = state.without(lesser).without_unless_needed(effect);
        }
        state
    }

    fn without_unless_needed(self, effect: usize) -> Self {
        let Some(index) = self.accepted.iter().position(|accepted| accepted.effect() == effect) else { return self };
        let state = self.judged(index);
        if state.is_still_accepted(index) { state } else { state.without(index) }
    }

    /// Two accepted effects that cancel.
    fn opposites(&self) -> Option<(usize, usize)> {
        let whitened =
            |index: usize| Some((index, self.problem.whitening.apply(&self.fit.columns[self.term_index(index)?])));
        let columns: Vec<(usize, Vec<f64>)> = (0..self.accepted.len()).filter_map(whitened).collect();
        columns.iter().enumerate().find_map(|(k, (first, a))| {
            let cancels = |(second, b): &&(usize, Vec<f64>)| {
                dot(a, b) < OPPOSITE * (dot(a, a) * dot(b, b)).sqrt() && !self.is_one_fault(*first, *second)
            };
            columns[k + 1..].iter().find(cancels).map(|(second, _)| (*first, *second))
        })
    }

    /// Whether two effects are of one family, so that both may be at work and nearly cancel: a clock that drifts and is
    /// late as well.
    fn is_one_fault(&self, first: usize, second: usize) -> bool {
        let family = |index: usize| self.problem.library[self.accepted[index].effect()].spec().family;
        family(first).is_some() && family(first) == family(second)
    }
}

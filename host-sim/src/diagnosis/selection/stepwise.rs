//! Steps of the selection: one effect more, or one less.

use super::state::{Accepted, State};
use crate::diagnosis::policy::MOST_EFFECTS;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::search::{Candidate, GlrtTable, reach_of_cone, scan_again};
use crate::effects::Search;

/// Steps in which moments and switching times are tried again, of the smallest useful ones.
const TRIED_AGAIN: f64 = 2.0;

impl<'a> State<'a> {
    /// With one effect after the other, as long as one is worth it.
    pub(super) fn forward(self) -> Self {
        let mut state = self;
        while state.accepted.len() < MOST_EFFECTS && !state.is_exhausted() {
            match state.next_best(|state, candidate| state.is_accepted(candidate)) {
                Some(best) => state = state.with(best).last_confirmed(),
                None => match state.proved_by_its_own_noise() {
                    Some(next) => state = next,
                    None => break,
                },
            }
        }
        state
    }

    /// With one effect more that is worth it once the noise model knows of it: what an effect adds where the direction changes
    /// quickly looks like noise of the direction until it is fitted.
    fn proved_by_its_own_noise(&self) -> Option<Self> {
        if self.noise.variance_cv() == 0.0 {
            return None;
        }
        let best = self.next_best(|state, candidate| state.would_be_accepted(candidate))?;
        let state = self.clone().with(best);
        let last = state.accepted.len() - 1;
        let state = state.judged(last);
        (state.is_still_accepted(last) && state.holds(last)).then_some(state)
    }

    /// A cone beyond doubt, or else the candidate that explains most once it is fitted with what is there, of those that are wanted. Where
    /// none of the most promising is, the others have their turn.
    fn next_best(&self, is_wanted: impl Fn(&Self, &Candidate) -> bool) -> Option<Candidate> {
        let is_accepted = |candidate: &Candidate| is_wanted(self, candidate);
        let table = self.scanned(&self.fit, &self.used());
        let mut left: Vec<Candidate> = table.into_rows().filter(is_accepted).collect();
        if let Some(first) = left.iter().find(|candidate| self.comes_first(candidate)) {
            return Some(first.clone());
        }
        while !left.is_empty() {
            let refined = self.refined(&left, &self.fit);
            left.retain(|candidate| refined.iter().all(|tried| tried.term.effect != candidate.term.effect));
            if let Some(best) = refined.into_iter().find(is_accepted) {
                return Some(best);
            }
        }
        None
    }

    /// All candidates on what a fit leaves, best evidence first.
    pub(super) fn scanned(&self, fit: &Fit, excluded: &[usize]) -> GlrtTable {
        self.count_scan();
        GlrtTable::of(&self.problem, fit, excluded)
            .without(|candidate| self.is_edge_of_band(candidate))
            .by_evidence(self.variance(), self.samples())
    }

    /// With a candidate accepted, and everything estimated anew.
    pub(super) fn with(mut self, candidate: Candidate) -> Self {
        let mut terms = self.fit.terms.clone();
        if candidate.variance.is_some() {
            self.random.push(candidate.clone());
        } else {
            terms.push(candidate.term.clone());
        }
        self.accepted.push(Accepted::new(candidate));
        self.refitted(&terms).whitened().tried_again().whitened().random_renewed()
    }

    /// Moments and switching times once more, now that everything else is fitted.
    pub(super) fn tried_again(self) -> Self {
        (0..self.fit.terms.len()).fold(self, |state, index| {
            let term = state.problem.tried(&state.fit, index, TRIED_AGAIN);
            if term == state.fit.terms[index] {
                return state;
            }
            let mut terms = state.fit.terms.clone();
            terms[index] = term;
            let fit = state.problem.fit(&terms);
            if fit.sse() < state.fit.sse() { state.with_fit(fit) } else { state }
        })
    }

    /// Each random effect fitted again, now that the noise model knows of it.
    fn random_renewed(self) -> Self {
        if self.random.is_empty() {
            return self;
        }
        (0..self.random.len()).fold(self, Self::one_renewed).whitened()
    }

    /// One random effect fitted again, with the noise that the others leave.
    fn one_renewed(mut self, index: usize) -> Self {
        let problem = self.beside_other_random(index);
        let fit = problem.fit(&self.fit.terms);
        let old = self.random.remove(index);
        let found = scan_again(&problem, &fit, &old).unwrap_or(old);
        for accepted in self.accepted.iter_mut().filter(|accepted| accepted.effect() == found.term.effect) {
            accepted.candidate = found.clone();
        }
        self.random.insert(index, found);
        self
    }

    /// The problem with the noise that all random effects but one leave.
    fn beside_other_random(&self, index: usize) -> RegressionProblem<'a> {
        let mut others = self.random_nt2(&self.random);
        others.remove(index);
        self.problem.whitened_by(&self.noise.with_random(&others).whitening)
    }

    /// Each cone at the likeliest place, with where the likely ones end, by what the fit that knows of it leaves: one that does not is bent
    /// by its noise.
    pub(super) fn with_reach(self) -> Self {
        (0..self.random.len()).fold(self, |mut state, index| {
            if state.search(&state.random[index]) != Search::Cone {
                return state;
            }
            let problem = state.beside_other_random(index);
            let residual_whitened = problem.whitening.apply(&state.problem.residual_nt(&state.fit));
            let reach = reach_of_cone(&problem, &residual_whitened, &state.random[index]);
            let candidate = &mut state.random[index];
            candidate.term.at[..3].copy_from_slice(&reach.likeliest);
            let effect = candidate.term.effect;
            let own = state.accepted.iter_mut().find(|accepted| accepted.effect() == effect);
            own.into_iter().for_each(|own| own.reach = Some(reach));
            state.whitened()
        })
    }

    /// The effect that was added last stays if it is still worth it with the new noise model; else it is taken out for
    /// good.
    fn last_confirmed(self) -> Self {
        let last = self.accepted.len() - 1;
        let state = self.judged(last);
        if !state.is_still_accepted(last) || !state.holds(last) { state.without(last) } else { state }
    }

    /// With the GLRT and chance of one effect counted anew, the others held.
    pub(super) fn judged(mut self, accepted: usize) -> Self {
        let log_p = match self.term_index(accepted) {
            Some(index) => {
                let without = self.fit_without(index);
                let (glrt, term) = (without.sse() - self.fit.sse(), self.fit.terms[index].clone());
                let candidate = &mut self.accepted[accepted].candidate;
                (candidate.glrt, candidate.term) = (glrt, term);
                self.log_p_in(&self.accepted[accepted].candidate, &without)
            }
            None => self.log_p(&self.accepted[accepted].candidate),
        };
        self.accepted[accepted].log_p = log_p;
        self
    }

    /// Without one effect, which is not looked at again.
    pub(super) fn without(mut self, accepted: usize) -> Self {
        let effect = self.accepted[accepted].effect();
        let mut terms = self.fit.terms.clone();
        match self.term_index(accepted) {
            Some(index) => drop(terms.remove(index)),
            None => self.random.retain(|candidate| candidate.term.effect != effect),
        }
        self.accepted.remove(accepted);
        self.excluded.push(effect);
        self.refitted(&terms).whitened()
    }
}

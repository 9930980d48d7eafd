//! Candidates fitted jointly with what was found before.

use rayon::prelude::*;

use super::state::State;
use crate::diagnosis::policy::{MOST_REFINED, REFINED_MARGIN};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::search::Candidate;
use crate::effects::Domain;

/// Steps at first of parameters that are tried, of the smallest useful ones.
const TRIED: f64 = 4.0;

impl State<'_> {
    /// The best candidates, each fitted jointly with what is there; best evidence first.
    pub(super) fn refined(&self, candidates: &[Candidate], without: &Fit) -> Vec<Candidate> {
        let (variance, samples) = (self.variance(), self.samples());
        let evidence = |candidate: &Candidate| candidate.evidence(variance, samples);
        let Some(best) = candidates.iter().map(evidence).reduce(f64::max) else { return Vec::new() };
        let margin = REFINED_MARGIN.of(best);
        let promising = candidates.iter().filter(|candidate| evidence(candidate) > best - margin).take(MOST_REFINED);
        let promising: Vec<Candidate> = promising.cloned().collect();
        // Side by side: most of a fit is in one piece. A state cannot be shared, its problem can.
        let problem = &self.problem;
        let refined = promising.into_par_iter().map(|candidate| problem.refined(candidate, without));
        let mut refined: Vec<Candidate> = refined.collect();
        refined.sort_by(|a, b| evidence(b).total_cmp(&evidence(a)));
        refined
    }
}

impl RegressionProblem<'_> {
    /// A candidate fitted jointly with what is in a fit.
    fn refined(&self, mut candidate: Candidate, without: &Fit) -> Candidate {
        if candidate.variance.is_some() {
            return candidate;
        }
        let mut terms = without.terms.clone();
        terms.push(candidate.term.clone());
        let last = terms.len() - 1;
        let mut fit = self.fit_tried(&terms, last, TRIED);
        let parameters = self.library[candidate.term.effect].spec().parameters;
        for whole in (0..parameters.len()).filter(|&k| parameters[k].domain == Domain::Whole) {
            fit = self.counted(fit, last, whole);
        }
        let glrt = without.sse() - fit.sse();
        candidate.term = fit.terms[last].clone();
        candidate.glrt = if self.is_plausible(&candidate.term) { glrt } else { 0.0 };
        candidate
    }

    /// A whole parameter of a term one up or down, as long as that leaves less: coefficients fitted with a wrong one favour
    /// it.
    fn counted(&self, mut fit: Fit, index: usize, parameter: usize) -> Fit {
        for by in [-1.0, 1.0] {
            loop {
                let mut terms = fit.terms.clone();
                let value = &mut terms[index].at[parameter];
                // 0 is no effect.
                *value += if *value + by == 0.0 { 2.0 * by } else { by };
                let other = self.fit(&terms);
                if other.sse() >= fit.sse() {
                    break;
                }
                fit = other;
            }
        }
        fit
    }
}

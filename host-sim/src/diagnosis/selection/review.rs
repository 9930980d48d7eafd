//! A second look at what was found: is it needed, and would another effect do better?

use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::search::Candidate;
use crate::diagnosis::selection::acceptance::LOG_FALSE_ALARM;
use crate::diagnosis::selection::refine::MARGIN;
use crate::diagnosis::selection::{Named, Search};

/// Correlation of what two effects add below which they cancel.
const OPPOSITE: f64 = -0.85;

impl Search<'_> {
    /// Take each effect out: is it needed, and would another do better? Returns whether anything changed.
    pub(crate) fn review(&mut self) -> bool {
        let mut changed = false;
        let mut named = 0;
        while named < self.named.len() {
            let log_p = self.log_p_of(named);
            self.named[named].log_p = log_p;
            if log_p > LOG_FALSE_ALARM {
                self.remove(named);
                changed = true;
                continue;
            }
            if self.compare(named) {
                changed = true;
            }
            named += 1;
        }
        if changed {
            self.forward();
        }
        changed
    }

    /// Hold an effect against every other in its place; the better one stays. Returns whether it was replaced.
    fn compare(&mut self, named: usize) -> bool {
        let (variance, samples) = (self.variance(), self.samples());
        let own = self.named[named].candidate.clone();
        let evidence = own.evidence(variance, samples);
        self.named[named].evidence = evidence;
        let Some(index) = self.term_index(named) else {
            self.named[named].rivals.clear();
            return false;
        };
        let without = self.without(index);
        let mut left_out = self.used();
        // Its own effect too, with other values: a moment or a period was found before the rest was known.
        left_out.retain(|&effect| effect != own.term.effect);
        let near = self.scanned(&without, &left_out);
        let near: Vec<Candidate> = near
            .into_iter()
            .filter(|candidate| {
                candidate.evidence(variance, samples) > evidence - MARGIN.0.max(MARGIN.1 * evidence.abs())
            })
            .collect();
        let rivals = self.refined(&near, &without);
        let others = |rivals: &[Candidate]| -> Vec<(usize, f64)> {
            let others = rivals.iter().filter(|rival| rival.term.effect != own.term.effect);
            others.map(|rival| (rival.term.effect, rival.evidence(variance, samples))).collect()
        };
        self.named[named].rivals = others(&rivals);
        let Some(best) = rivals.iter().find(|rival| rival.variance.is_none()).cloned() else { return false };
        if best.evidence(variance, samples) <= evidence + 0.5 {
            return false;
        }
        let mut terms = self.fit.terms.clone();
        terms[index] = best.term.clone();
        let rivals =
            if best.term.effect == own.term.effect { others(&rivals) } else { vec![(own.term.effect, evidence)] };
        let better = best.evidence(variance, samples);
        let log_p = self.log_p(&best);
        self.named[named] = Named { candidate: best, log_p, evidence: better, rivals };
        self.refit(&terms);
        self.whiten();
        self.try_out();
        true
    }

    /// Two effects that add almost the opposite of each other are one at most: the lesser goes, and then the other unless
    /// it is needed by itself.
    pub(crate) fn refuse_opposites(&mut self) {
        while let Some((first, second)) = self.opposites() {
            let cost = |named: usize| self.term_index(named).map_or(0.0, |index| self.without(index).sse());
            let (lesser, other) = if cost(first) < cost(second) { (first, second) } else { (second, first) };
            let effect = self.named[other].candidate.term.effect;
            self.remove(lesser);
            let Some(other) = self.named.iter().position(|named| named.candidate.term.effect == effect) else {
                continue;
            };
            if self.log_p_of(other) > LOG_FALSE_ALARM {
                self.remove(other);
            }
        }
    }

    /// Two named effects that cancel.
    fn opposites(&self) -> Option<(usize, usize)> {
        let columns: Vec<(usize, Vec<f64>)> = (0..self.named.len())
            .filter_map(|named| Some((named, self.problem.whitening.apply(&self.fit.columns[self.term_index(named)?]))))
            .collect();
        let family = |named: usize| self.problem.library[self.named[named].candidate.term.effect].spec().family;
        // Two of one family may be at work together and nearly cancel: a clock that drifts and is late as well.
        let is_one_fault = |first: usize, second: usize| family(first).is_some() && family(first) == family(second);
        columns.iter().enumerate().find_map(|(k, (first, a))| {
            let cancels = |(second, b): &&(usize, Vec<f64>)| {
                dot(a, b) < OPPOSITE * (dot(a, a) * dot(b, b)).sqrt() && !is_one_fault(*first, *second)
            };
            columns[k + 1..].iter().find(cancels).map(|(second, _)| (*first, *second))
        })
    }
}

//! How well a manoeuvre tells two effects apart: the power of the one that the other cannot imitate, whatever its
//! parameters, in units of the noise, with 18 terms and background fitted as ever. That is the evidence that a diagnosis
//! of the manoeuvre would have on average.

use std::sync::Arc;

use crate::diagnosis::manoeuvre::design::{LENGTH_S, Manoeuvre, Place};
use crate::diagnosis::noise::blocks::blocks;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem, solve};
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::GlrtTable;
use crate::effects::Library;
use crate::simulator::signals::{LONGEST_STEP_S, Signals};

/// An effect that was found, and those that would do nearly as well.
pub(crate) struct Pair<'a> {
    pub(crate) library: &'a Library,
    pub(crate) term: &'a Term,
    pub(crate) rivals: Vec<usize>,
    /// The recording that they were found on.
    pub(crate) recorded: &'a RegressionProblem<'a>,
    /// Variance of the whitened noise there.
    pub(crate) variance: f64,
}

/// Evidence for the effect against the nearest of its rivals that a minute of a manoeuvre gives.
pub(crate) fn per_minute(pair: &Pair<'_>, manoeuvre: &Manoeuvre, place: &Place) -> f64 {
    let signals = manoeuvre.signals(place);
    let driver = |effect: usize| pair.library[effect].spec().driver;
    let is_absent = |effect: usize| driver(effect).is_some() && driver(effect) == manoeuvre.without;
    let rivals = pair.rivals.iter().copied();
    let least = if is_absent(pair.term.effect) {
        // It adds nothing there: what counts is what its rivals would.
        let added = |rival| if is_absent(rival) { 0.0 } else { pair.added(&signals, pair.imitation(rival)) };
        rivals.map(added).fold(f64::INFINITY, f64::min)
    } else {
        let problem = pair.sailed(signals.clone(), &pair.repeated());
        let without = problem.fit(&[]);
        let left = |rival| if is_absent(rival) { without.sse() } else { left(&problem, &without, rival) };
        rivals.map(left).fold(f64::INFINITY, f64::min)
    };
    if least.is_finite() { least / pair.variance / (LENGTH_S / 60.0) } else { 0.0 }
}

/// Power of what a bench reads that a rival leaves at its best.
pub(crate) fn left(problem: &RegressionProblem<'_>, without: &Fit, rival: usize) -> f64 {
    let others: Vec<usize> = (0..problem.library.len()).filter(|&effect| effect != rival).collect();
    let found = GlrtTable::of(problem, without, &others).into_rows().find(|candidate| candidate.variance.is_none());
    // What is random imitates nothing.
    let Some(candidate) = found else { return without.sse() };
    problem.fit_tried(std::slice::from_ref(&candidate.term), 0, 4.0).sse().min(without.sse())
}

impl<'a> Pair<'a> {
    /// The effect as it would be there: what happens once happens half way.
    fn repeated(&self) -> Term {
        let mut term = self.term.clone();
        if let Some(index) = self.library[term.effect].spec().moment() {
            term.at[index] = 0.5 * LENGTH_S;
        }
        term
    }

    /// What the sensors would read there, without noise.
    fn sailed(&self, signals: Signals, term: &Term) -> RegressionProblem<'a> {
        let blocks = blocks(signals.epochs_s(), &vec![true; signals.len()], LONGEST_STEP_S + 1e-6);
        let whitening = Whitening::new(&blocks, self.recorded.whitening.predictor().clone(), None);
        let none = vec![0.0; signals.len()];
        let problem = RegressionProblem::new(self.library, self.recorded.channel, signals, none, Arc::new(whitening));
        problem.with_reading(problem.read_nt(term))
    }

    /// Power of what a term adds there beyond 18 terms and background.
    fn added(&self, signals: &Signals, term: Option<Term>) -> f64 {
        term.map_or(0.0, |term| self.sailed(signals.clone(), &term).fit(&[]).sse())
    }

    /// A rival with the values with which it imitates the effect on the recording; of those that are linear throughout.
    fn imitation(&self, rival: usize) -> Option<Term> {
        let at = vec![0.0; self.library[rival].spec().parameters.len()];
        let mut term = Term { effect: rival, at, coordinates: Vec::new() };
        let duration_s = self.recorded.duration_s();
        let is_linear = term.derivative_steps(self.library, duration_s).is_empty()
            && term.discrete_steps(self.library, duration_s).is_empty();
        if !is_linear {
            return None;
        }
        let signals = &self.recorded.signals;
        let whitened = |column: &Vec<f64>| self.recorded.whitening.apply(column);
        let columns: Vec<Vec<f64>> = term.regressors(self.library, signals).iter().map(whitened).collect();
        let target = whitened(&self.term.column(self.library, signals));
        (_, term.coordinates, _) = solve(&columns, &target);
        (!columns.is_empty()).then_some(term)
    }
}

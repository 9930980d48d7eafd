//! An effect in a planned recording: how strong it must be to be found, and to be told from another one.

use crate::diagnosis::manoeuvre::{SAFETY, left_by};
use crate::diagnosis::noise::model::tolerance;
use crate::diagnosis::policy::INDISTINGUISHABLE;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::products::norm;
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::GlrtTable;
use crate::diagnosis::selection::{Selection, log_false_alarm};
use crate::effects::{Channel, Domain};

use super::told::PLANNED_STRENGTH;

/// Strengths beyond this are no answer: a gap that is a thousand times the noise is seen on the deck.
const STRONGEST: f64 = 1000.0;
/// Rounds that bring a parameter to the strength wanted: what is added grows with it or with its square.
const ROUNDS: usize = 12;
/// How often a strength is found anew, how much it may change in one step, and from which change on it is.
const REFINEMENTS: usize = 3;
const LONGEST_STEP: f64 = 4.0;
const CLOSE: f64 = 1.3;

/// An effect put into a recording without noise, [`PLANNED_STRENGTH`] times as strong as the noise.
pub(super) struct Sown<'a> {
    problem: RegressionProblem<'a>,
    pub(super) term: Term,
    /// Of what was put in, as far as its parameters go.
    strength: f64,
    /// With nothing but the 18 terms.
    without: Fit,
    /// Variance of the whitened noise.
    pub(super) variance: f64,
}

impl<'a> Sown<'a> {
    /// `None` for an effect of the other channel, one that is random from row to row, and one that adds nothing there.
    pub(super) fn of(selection: &Selection<'a>, effect: usize) -> Option<Self> {
        let (recorded, variance) = (&selection.problem, selection.variance);
        let spec = recorded.library[effect].spec();
        if spec.channel != recorded.channel || spec.random {
            return None;
        }
        Self::at(recorded, effect, PLANNED_STRENGTH, variance)
    }

    /// The same as strong as that, as near as its parameters go.
    fn at(recorded: &RegressionProblem<'a>, effect: usize, wanted: f64, variance: f64) -> Option<Self> {
        let term = at_strength(recorded, effect, wanted, variance)?;
        let strength = strength_of(recorded, &term, variance);
        let problem = recorded.with_reading(recorded.read_nt(&term));
        let without = problem.fit(&[]);
        (strength > 0.0).then_some(Self { problem, term, strength, without, variance })
    }

    pub(super) fn effect(&self) -> usize {
        self.term.effect
    }

    pub(super) fn channel(&self) -> Channel {
        self.problem.channel
    }

    pub(super) fn problem(&self) -> &RegressionProblem<'a> {
        &self.problem
    }

    pub(super) fn name_of(&self, effect: usize) -> &'static str {
        self.problem.library[effect].spec().name
    }

    /// The effects that it may be taken for: those of its channel that are not random, and not the same with another load.
    pub(super) fn others(&self) -> impl Iterator<Item = usize> + '_ {
        let name = self.name_of(self.effect());
        (0..self.problem.library.len()).filter(move |&other| {
            let spec = self.problem.library[other].spec();
            spec.name != name && spec.channel == self.problem.channel && !spec.random
        })
    }

    /// Strength from which it is found: the chance of its GLRT is then beyond that of a false alarm.
    pub(super) fn found_from(&self) -> Option<f64> {
        let others: Vec<usize> = (0..self.problem.library.len()).filter(|&other| other != self.effect()).collect();
        let mut candidate = GlrtTable::of(&self.problem, &self.without, &others).into_rows().next()?;
        let least = log_false_alarm(self.problem.library[self.effect()].spec().search);
        let variance = self.variance * (1.0 + tolerance(self.problem.whitening.samples()));
        let at_strength = candidate.glrt / (self.strength * self.strength);
        // By bisection on the logarithm: the chance falls with the strength throughout.
        let (mut low, mut high) = ((STRONGEST * 1e-6).ln(), STRONGEST.ln());
        let mut is_found = |strength: f64| {
            candidate.glrt = at_strength * strength * strength / SAFETY;
            candidate.log_p(variance) <= least
        };
        if !is_found(STRONGEST) {
            return None;
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if is_found(middle.exp()) { high = middle } else { low = middle }
        }
        Some(high.exp())
    }

    /// Strength from which it is told from another one, whatever that one's parameters. The evidence grows with the square of the
    /// strength, but where it is no sum of columns: what one delay leaves of another grows with the fourth power. It is then put in as
    /// strong as that once more.
    pub(super) fn apart_from(&self, other: usize) -> Option<f64> {
        let mut strength = self.strength / self.known(other).sqrt();
        let mut tried = self.strength;
        let refinements = if self.term.coordinates.is_empty() { REFINEMENTS } else { 0 };
        for _ in 0..refinements {
            let step = (strength / tried).clamp(1.0 / LONGEST_STEP, LONGEST_STEP);
            if step.ln().abs() < CLOSE.ln() {
                break;
            }
            let again = Self::at(&self.problem, self.effect(), tried * step, self.variance)?;
            tried = again.strength;
            strength = tried / again.known(other).sqrt();
        }
        (strength <= STRONGEST).then_some(strength)
    }

    /// Evidence that it is not another one, whatever that one's parameters, over what it takes.
    pub(super) fn known(&self, other: usize) -> f64 {
        let evidence = left_by(&self.problem, &self.without, other) / self.variance;
        evidence.max(f64::MIN_POSITIVE) / (SAFETY * INDISTINGUISHABLE)
    }

    /// Its parameters where it is as strong as the noise.
    pub(super) fn at_strength_1(&self) -> Vec<(&'static str, f64)> {
        let library = self.problem.library;
        let term = at_strength(&self.problem, self.effect(), 1.0, self.variance);
        let values = term.map(|term| term.parameters(library)).unwrap_or_default();
        library[self.effect()].spec().parameters.iter().map(|parameter| parameter.name).zip(values).collect()
    }
}

/// An effect with parameters that make it so strong, as near as they can; the linear ones all as strong as each other.
fn at_strength(problem: &RegressionProblem<'_>, effect: usize, strength: f64, variance: f64) -> Option<Term> {
    let at = problem.library[effect].typical(&problem.signals);
    let mut term = Term { effect, at, coordinates: Vec::new() };
    let norms: Vec<f64> = term
        .regressors(problem.library, &problem.signals)
        .iter()
        .map(|column| norm(&problem.whitening.apply(column)))
        .collect();
    if norms.iter().any(|&norm| norm > 0.0) {
        term.coordinates = norms.iter().map(|&norm| if norm > 0.0 { 1.0 / norm } else { 0.0 }).collect();
        let by = strength / strength_of(problem, &term, variance);
        term.coordinates.iter_mut().for_each(|coordinate| *coordinate *= by);
        return Some(term);
    }
    let parameters = problem.library[effect].spec().parameters;
    let size = parameters.iter().position(|parameter| parameter.domain == Domain::Real)?;
    let [low, high] = parameters[size].range;
    for _ in 0..ROUNDS {
        let now = strength_of(problem, &term, variance);
        if now <= 0.0 {
            return None;
        }
        // The square root: what is added may grow with the square.
        term.at[size] = (term.at[size] * (strength / now).sqrt()).clamp(low, high);
    }
    Some(term)
}

/// Rms of what a term adds beside the background, over that of the noise, both whitened.
fn strength_of(problem: &RegressionProblem<'_>, term: &Term, variance: f64) -> f64 {
    let whitened = problem.whitening.apply(&term.column(problem.library, &problem.signals));
    norm(&whitened) / (variance * whitened.len().max(1) as f64).sqrt()
}

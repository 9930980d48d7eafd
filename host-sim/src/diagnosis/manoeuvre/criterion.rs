//! How well a manoeuvre tells two effects apart: the power of the one that the other cannot imitate, whatever its
//! parameters, in units of the noise, with 18 terms and background fitted as ever. That is the evidence that a diagnosis
//! of the manoeuvre would have on average.

use super::design::{LENGTH_S, Manoeuvre, Place};
use crate::diagnosis::bench::{Bench, Fit, solve};
use crate::diagnosis::blocks::blocks;
use crate::diagnosis::scan::scan;
use crate::diagnosis::term::{Library, Term, smooth_parameters, tried_parameters};
use crate::diagnosis::whiten::Whitener;
use crate::effects::Channel;
use crate::simulator::signals::{LONGEST_STEP_S, Signals};

/// An effect that was found, and those that would do nearly as well.
pub(super) struct Pair<'a> {
    pub(super) library: &'a Library,
    pub(super) term: &'a Term,
    pub(super) rivals: Vec<usize>,
    /// The recording that they were found on.
    pub(super) recorded: &'a Bench<'a>,
    /// Variance of the whitened noise there.
    pub(super) variance: f64,
}

/// Whether it happens once, at a time.
pub(super) fn is_event(name: &str) -> bool {
    ["permanent_step", "sample_slip"].contains(&name)
}

/// Evidence for the effect against the nearest of its rivals that a minute of a manoeuvre gives.
pub(super) fn per_minute(pair: &Pair<'_>, manoeuvre: &Manoeuvre, place: &Place) -> f64 {
    let signals = Signals::new(manoeuvre.world(place));
    let is_absent = |effect: usize| manoeuvre.absent.contains(&pair.library[effect].spec().name);
    let rivals = pair.rivals.iter().copied();
    let least = if is_absent(pair.term.effect) {
        // It adds nothing there: what counts is what its rivals would.
        let added = |rival| if is_absent(rival) { 0.0 } else { pair.added(&signals, pair.imitation(rival)) };
        rivals.map(added).fold(f64::INFINITY, f64::min)
    } else {
        let bench = pair.sailed(signals.clone(), &pair.repeated());
        let without = bench.fit(&[]);
        let left = |rival| if is_absent(rival) { without.sse() } else { left(&bench, &without, rival) };
        rivals.map(left).fold(f64::INFINITY, f64::min)
    };
    if least.is_finite() { least / pair.variance / (LENGTH_S / 60.0) } else { 0.0 }
}

/// Power of what a bench reads that a rival leaves at its best.
fn left(bench: &Bench<'_>, without: &Fit, rival: usize) -> f64 {
    let others: Vec<usize> = (0..bench.library.len()).filter(|&effect| effect != rival).collect();
    let found = scan(bench, without, &others).into_iter().find(|candidate| candidate.variance.is_none());
    // What is random imitates nothing.
    let Some(candidate) = found else { return without.sse() };
    bench.fit_tried(std::slice::from_ref(&candidate.term), 0, 4.0).sse().min(without.sse())
}

impl<'a> Pair<'a> {
    /// The effect as it would be there: what happens once happens half way.
    fn repeated(&self) -> Term {
        let mut term = self.term.clone();
        let parameters = self.library[term.effect].spec().parameters;
        if let Some(index) = parameters.iter().position(|parameter| parameter.name == "time_s") {
            term.at[index] = 0.5 * LENGTH_S;
        }
        term
    }

    /// What the sensors would read there, without noise.
    fn sailed(&self, signals: Signals, term: &Term) -> Bench<'a> {
        let channel = self.recorded.channel;
        let mut reading = match channel {
            Channel::Scalar => signals.rows().scalar_nt.clone(),
            Channel::Fluxgate => vec![0.0; signals.len()],
        };
        reading.iter_mut().zip(term.column(self.library, &signals)).for_each(|(reading, more)| *reading += more);
        let blocks = blocks(signals.epochs_s(), &vec![true; signals.len()], LONGEST_STEP_S + 1e-6);
        let whitener = Whitener::new(&blocks, self.recorded.whitener.predictor().clone(), None);
        Bench::new(self.library, channel, signals, reading, whitener)
    }

    /// Power of what a term adds there beyond 18 terms and background.
    fn added(&self, signals: &Signals, term: Option<Term>) -> f64 {
        term.map_or(0.0, |term| self.sailed(signals.clone(), &term).fit(&[]).sse())
    }

    /// A rival with the values with which it imitates the effect on the recording; of those that are linear throughout.
    fn imitation(&self, rival: usize) -> Option<Term> {
        let spec = self.library[rival].spec();
        let at = vec![0.0; spec.parameters.len()];
        let duration_s = self.recorded.duration_s();
        if !smooth_parameters(spec.name, &at, duration_s).is_empty()
            || !tried_parameters(spec.name, &at, duration_s).is_empty()
        {
            return None;
        }
        let signals = &self.recorded.signals;
        let whitened = |column: &Vec<f64>| self.recorded.whitener.apply(column);
        let mut term = Term { effect: rival, at, coordinates: Vec::new() };
        let columns: Vec<Vec<f64>> = term.signatures(self.library, signals).iter().map(whitened).collect();
        let target = whitened(&self.term.column(self.library, signals));
        (_, term.coordinates, _) = solve(&columns, &target);
        (!columns.is_empty()).then_some(term)
    }
}

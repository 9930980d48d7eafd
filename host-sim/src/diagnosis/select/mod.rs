//! Which effects are at work in a channel: the best one is added, everything is fitted again, and so on, until what is
//! left is no more than noise. Then each is taken out again, to see whether it is needed and what else would do.

mod noise;
mod refine;
mod review;
mod worth;

pub(super) use noise::{GATHERED, MISJUDGED, unevenness_of};

use super::bench::{Bench, Fit};
use super::blocks::Block;
use super::scan::{Candidate, scan};
use super::spectrum::Spectrum;
use super::term::Library;
use super::whiten::{Predictor, Whitener};
use crate::effects::Channel;
use crate::simulator::signals::Signals;

/// Effects in a channel at most.
const MOST: usize = 6;
/// Two effects whose evidence differs by less are not told apart.
pub(super) const INDISTINGUISHABLE: f64 = 10.0;

/// An effect that was found.
#[derive(Clone, Debug)]
pub(super) struct Named {
    pub(super) candidate: Candidate,
    /// Logarithm of the chance to gain as much without it, the others held.
    pub(super) log_p: f64,
    /// What it gains over nothing in its place, by [`Candidate::evidence`].
    pub(super) evidence: f64,
    /// The same of every other effect in its place.
    pub(super) rivals: Vec<(usize, f64)>,
}

/// A channel after the search.
pub(super) struct Analysis<'a> {
    pub(super) bench: Bench<'a>,
    /// With everything that was found.
    pub(super) fit: Fit,
    /// With nothing, whitened in the end's way.
    pub(super) before: Fit,
    pub(super) spectrum: Option<Spectrum>,
    pub(super) named: Vec<Named>,
    /// Every effect's evidence on what is left in the end, and its chance logarithm.
    pub(super) last_scan: Vec<(usize, f64, f64)>,
    /// Weights of the samples by the noise of the direction alone, without any effect.
    pub(super) noise_weights: Vec<f64>,
    /// Variance of the whitened noise, 1 when the noise model is right.
    pub(super) variance: f64,
    /// How much the variance of the samples differs by the noise of the direction, of its mean, rms.
    pub(super) unevenness: f64,
}

/// A channel to be searched.
pub(super) struct Asked<'a, 'b> {
    pub(super) library: &'a Library,
    pub(super) channel: Channel,
    pub(super) signals: Signals,
    /// What was read, one a row, nT.
    pub(super) reading: Vec<f64>,
    pub(super) blocks: &'b [Block],
    /// Effects that may be named.
    pub(super) allowed: &'b [usize],
    /// Noise of the fluxgate's direction, rad rms across it: what it can add to the noise of the scalar.
    pub(super) direction_noise_rad: f64,
}

/// Search a channel.
pub(super) fn search<'a>(asked: Asked<'a, '_>) -> Analysis<'a> {
    let mut search = Search::new(asked);
    search.forward();
    for _ in 0..2 {
        if !search.review() {
            break;
        }
    }
    search.refuse_opposites();
    search.finish()
}

struct Search<'a> {
    bench: Bench<'a>,
    fit: Fit,
    blocks: Vec<Block>,
    spectrum: Option<Spectrum>,
    /// Growth of each sample's variance by the noise of the direction.
    direction: Option<Vec<f64>>,
    direction_noise_rad: f64,
    /// Effects that are random, found so far.
    random: Vec<Candidate>,
    /// What was found, additive and random, in the order of finding.
    named: Vec<Named>,
    left_out: Vec<usize>,
    last_scan: Vec<(usize, f64, f64)>,
}

impl<'a> Search<'a> {
    fn new(asked: Asked<'a, '_>) -> Self {
        let Asked { library, channel, signals, reading, blocks, allowed, direction_noise_rad } = asked;
        let whitener = Whitener::new(blocks, Predictor::white(1.0), None);
        let bench = Bench::new(library, channel, signals, reading, whitener);
        let fit = bench.fit(&[]);
        let left_out = (0..library.len()).filter(|index| !allowed.contains(index)).collect();
        let mut search = Self {
            bench,
            fit,
            blocks: blocks.to_vec(),
            spectrum: None,
            direction: None,
            direction_noise_rad,
            random: Vec::new(),
            named: Vec::new(),
            left_out,
            last_scan: Vec::new(),
        };
        search.whiten();
        search.whiten();
        search
    }

    fn used(&self) -> Vec<usize> {
        let found = self.named.iter().map(|named| named.candidate.term.effect);
        self.left_out.iter().copied().chain(found).collect()
    }

    fn forward(&mut self) {
        while self.named.len() < MOST {
            let Some(best) = self.next_best() else { break };
            self.add(best);
            self.confirm_last();
        }
    }

    /// The candidate that explains most once it is fitted with what is there. Where none of the most promising does, the
    /// others have their turn.
    fn next_best(&self) -> Option<Candidate> {
        let is_worth = |candidate: &Candidate| self.is_worth(candidate);
        let mut left: Vec<Candidate> = self.scanned(&self.fit, &self.used()).into_iter().filter(is_worth).collect();
        while !left.is_empty() {
            let refined = self.refined(&left, &self.fit);
            left.retain(|candidate| refined.iter().all(|tried| tried.term.effect != candidate.term.effect));
            if let Some(best) = refined.into_iter().find(is_worth) {
                return Some(best);
            }
        }
        None
    }

    /// All candidates, best evidence first.
    fn scanned(&self, fit: &Fit, left_out: &[usize]) -> Vec<Candidate> {
        let (variance, samples) = (self.variance(), self.samples());
        let mut candidates = scan(&self.bench, fit, left_out);
        candidates.retain(|candidate| !self.is_edge_of_swell(candidate));
        candidates.sort_by(|a, b| b.evidence(variance, samples).total_cmp(&a.evidence(variance, samples)));
        candidates
    }

    fn add(&mut self, candidate: Candidate) {
        let mut terms = self.fit.terms.clone();
        if candidate.variance.is_some() {
            self.random.push(candidate.clone());
        } else {
            terms.push(candidate.term.clone());
        }
        self.named.push(Named { candidate, log_p: 0.0, evidence: 0.0, rivals: Vec::new() });
        self.refit(&terms);
        self.whiten();
        self.try_out();
        self.whiten();
        self.renew_random();
    }

    /// Moments and switching times once more, now that everything else is fitted.
    fn try_out(&mut self) {
        for index in 0..self.fit.terms.len() {
            let term = self.bench.tried(&self.fit, index, 2.0);
            if term != self.fit.terms[index] {
                let mut terms = self.fit.terms.clone();
                terms[index] = term;
                let fit = self.bench.fit(&terms);
                if fit.sse() < self.fit.sse() {
                    self.fit = fit;
                    self.bench.adopt(&self.fit);
                }
            }
        }
    }

    /// The effect that was added last stays if it is still worth it with the new noise model; else it is taken out for
    /// good.
    fn confirm_last(&mut self) {
        let last = self.named.len() - 1;
        let log_p = self.log_p_of(last);
        self.named[last].log_p = log_p;
        if log_p > worth::LOG_FALSE_ALARM || !self.holds(last) {
            self.remove(last);
        }
    }

    /// Index among the additive terms of what was found.
    fn term_index(&self, named: usize) -> Option<usize> {
        if self.named[named].candidate.variance.is_some() {
            return None;
        }
        Some(self.named[..named].iter().filter(|other| other.candidate.variance.is_none()).count())
    }

    /// The fit without one of the terms.
    fn without(&self, index: usize) -> Fit {
        self.bench.fit(&self.fit.others(index))
    }

    fn log_p_of(&mut self, named: usize) -> f64 {
        if let Some(index) = self.term_index(named) {
            let gain = self.without(index).sse() - self.fit.sse();
            self.named[named].candidate.gain = gain;
            self.named[named].candidate.term = self.fit.terms[index].clone();
        }
        self.log_p(&self.named[named].candidate)
    }

    fn remove(&mut self, named: usize) {
        let effect = self.named[named].candidate.term.effect;
        let mut terms = self.fit.terms.clone();
        match self.term_index(named) {
            Some(index) => drop(terms.remove(index)),
            None => self.random.retain(|candidate| candidate.term.effect != effect),
        }
        self.named.remove(named);
        self.left_out.push(effect);
        self.refit(&terms);
        self.whiten();
    }

    fn finish(mut self) -> Analysis<'a> {
        self.whiten();
        // How much random effects make the noise grow was told anew by the last noise model.
        for named in &mut self.named {
            let own = self.random.iter().find(|candidate| candidate.term.effect == named.candidate.term.effect);
            named.candidate = own.unwrap_or(&named.candidate).clone();
        }
        for named in 0..self.named.len() {
            self.named[named].log_p = self.log_p_of(named);
        }
        let (variance, samples) = (self.variance(), self.samples());
        let candidates = self.scanned(&self.fit, &self.used());
        self.last_scan =
            candidates.iter().map(|c| (c.term.effect, c.evidence(variance, samples), self.log_p(c))).collect();
        let before = self.bench.fit(&[]);
        let unevenness = self.unevenness();
        let all_alike = || vec![1.0; self.bench.whitener.samples()];
        let noise_weights = self.direction.as_deref().map_or_else(all_alike, noise::weights_of);
        let Self { bench, fit, spectrum, named, last_scan, .. } = self;
        Analysis { bench, fit, before, spectrum, named, last_scan, noise_weights, variance, unevenness }
    }
}

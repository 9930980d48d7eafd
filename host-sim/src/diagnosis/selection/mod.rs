//! Which effects are at work in a channel: the best one is added, everything is fitted again, and so on, until what is
//! left is no more than noise. Then each is taken out again, to see whether it is needed and what else would do.

mod acceptance;
mod noise;
mod refine;
mod review;

pub(crate) use noise::{NOISE_DENSITY_RATIO, VARIANCE_MODEL_ERROR, variance_cv_of};

use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::spectrum::NoiseSpectrum;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Library;
use crate::diagnosis::search::{Candidate, scan};
use crate::effects::Channel;
use crate::simulator::signals::Signals;

/// Effects in a channel at most.
const MOST: usize = 6;
/// Two effects whose evidence differs by less are not told apart.
pub(crate) const INDISTINGUISHABLE: f64 = 10.0;

/// An effect that was found.
#[derive(Clone, Debug)]
pub(crate) struct Named {
    pub(crate) candidate: Candidate,
    /// Logarithm of the chance to gain as much without it, the others held.
    pub(crate) log_p: f64,
    /// What it gains over nothing in its place, by [`Candidate::evidence`].
    pub(crate) evidence: f64,
    /// The same of every other effect in its place.
    pub(crate) rivals: Vec<(usize, f64)>,
}

/// A channel after the search.
pub(crate) struct Analysis<'a> {
    pub(crate) problem: RegressionProblem<'a>,
    /// With everything that was found.
    pub(crate) fit: Fit,
    /// With nothing, whitened in the end's way.
    pub(crate) before: Fit,
    pub(crate) spectrum: Option<NoiseSpectrum>,
    pub(crate) named: Vec<Named>,
    /// Every effect's evidence on what is left in the end, and its chance logarithm.
    pub(crate) last_scan: Vec<(usize, f64, f64)>,
    /// Weights of the samples by the noise of the direction alone, without any effect.
    pub(crate) noise_weights: Vec<f64>,
    /// Variance of the whitened noise, 1 when the noise model is right.
    pub(crate) variance: f64,
    /// How much the variance of the samples differs by the noise of the direction, of its mean, rms.
    pub(crate) variance_cv: f64,
}

/// A channel to be searched.
pub(crate) struct Asked<'a, 'b> {
    pub(crate) library: &'a Library,
    pub(crate) channel: Channel,
    pub(crate) signals: Signals,
    /// What was read, one a row, nT.
    pub(crate) reading: Vec<f64>,
    pub(crate) blocks: &'b [Block],
    /// Effects that may be named.
    pub(crate) allowed: &'b [usize],
    /// Noise of the fluxgate's direction, rad rms across it: what it can add to the noise of the scalar.
    pub(crate) direction_noise_rad: f64,
}

/// Search a channel.
pub(crate) fn search<'a>(asked: Asked<'a, '_>) -> Analysis<'a> {
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
    problem: RegressionProblem<'a>,
    fit: Fit,
    blocks: Vec<Block>,
    spectrum: Option<NoiseSpectrum>,
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
        let whitening = Whitening::new(blocks, Predictor::white(1.0), None);
        let problem = RegressionProblem::new(library, channel, signals, reading, whitening);
        let fit = problem.fit(&[]);
        let left_out = (0..library.len()).filter(|index| !allowed.contains(index)).collect();
        let mut search = Self {
            problem,
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
        let is_accepted = |candidate: &Candidate| self.is_accepted(candidate);
        let mut left: Vec<Candidate> = self.scanned(&self.fit, &self.used()).into_iter().filter(is_accepted).collect();
        while !left.is_empty() {
            let refined = self.refined(&left, &self.fit);
            left.retain(|candidate| refined.iter().all(|tried| tried.term.effect != candidate.term.effect));
            if let Some(best) = refined.into_iter().find(is_accepted) {
                return Some(best);
            }
        }
        None
    }

    /// All candidates, best evidence first.
    fn scanned(&self, fit: &Fit, left_out: &[usize]) -> Vec<Candidate> {
        let (variance, samples) = (self.variance(), self.samples());
        let mut candidates = scan(&self.problem, fit, left_out);
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
            let term = self.problem.tried(&self.fit, index, 2.0);
            if term != self.fit.terms[index] {
                let mut terms = self.fit.terms.clone();
                terms[index] = term;
                let fit = self.problem.fit(&terms);
                if fit.sse() < self.fit.sse() {
                    self.fit = fit;
                    self.problem.adopt(&self.fit);
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
        if log_p > acceptance::LOG_FALSE_ALARM || !self.holds(last) {
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
        self.problem.fit(&self.fit.others(index))
    }

    fn log_p_of(&mut self, named: usize) -> f64 {
        if let Some(index) = self.term_index(named) {
            let glrt = self.without(index).sse() - self.fit.sse();
            self.named[named].candidate.glrt = glrt;
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
        let before = self.problem.fit(&[]);
        let variance_cv = self.variance_cv();
        let all_alike = || vec![1.0; self.problem.whitening.samples()];
        let noise_weights = self.direction.as_deref().map_or_else(all_alike, noise::weights_of);
        let Self { problem, fit, spectrum, named, last_scan, .. } = self;
        Analysis { problem, fit, before, spectrum, named, last_scan, noise_weights, variance, variance_cv }
    }
}

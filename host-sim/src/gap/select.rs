//! Which effects are at work in a channel: the best one is added, everything is fitted again, and so on, until what is
//! left is no more than noise. Then each is taken out again, to see whether it is needed and what else would do.

use super::bench::{Bench, Fit};
use super::blocks::Block;
use super::scan::{Candidate, direction_growth, scan};
use super::span::dot;
use super::spectrum::Spectrum;
use super::term::{Library, Term, tried_parameters};
use super::whiten::{Predictor, Whitener};
use crate::simulator::effect::Channel;
use crate::simulator::signals::Signals;

/// Logarithm of the chance to name any one effect that is not there: with twenty of them, one clean recording in 2,000.
/// On measured noise models it is several times that.
const LOG_FALSE_ALARM: f64 = -11.0;
/// Effects in a channel at most.
const MOST: usize = 6;
/// Candidates whose fit is refined: within this of the best, and this share of its gain; and so many.
const MARGIN: (f64, f64, usize) = (25.0, 0.35, 5);
/// Share of what was found already that one more effect must explain at least; more where a variance is in play.
const SMALL: f64 = 0.004;
const SMALL_RANDOM: f64 = 0.02;
/// One colour stands for both the noise and a random effect: what that misses looks like another one.
const SMALL_BOTH_RANDOM: f64 = 0.2;
/// Ends of the band of `swell_induction`, and how near to them a tone is the cut.
const SWELL_EDGES_HZ: [f64; 2] = [0.05, 0.5];
const EDGE_HZ: f64 = 0.02;
/// Whitened noise is never quieter: less is a reading without noise, of which nothing can be said.
const LEAST_VARIANCE: f64 = 0.05;
/// No sensor is quieter, nT.
const LEAST_NOISE_NT: f64 = 5e-4;
/// Correlation of what two effects add below which they cancel.
const OPPOSITE: f64 = -0.85;
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
}

/// Search a channel. `reading` is one a row; `effects` are those that may be named.
pub(super) fn search<'a>(
    library: &'a Library,
    channel: Channel,
    signals: Signals,
    reading: Vec<f64>,
    blocks: &[Block],
    allowed: &[usize],
) -> Analysis<'a> {
    let mut search = Search::new(library, channel, signals, reading, blocks, allowed);
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
    /// Effects that are random, found so far.
    random: Vec<Candidate>,
    /// What was found, additive and random, in the order of finding.
    named: Vec<Named>,
    left_out: Vec<usize>,
    last_scan: Vec<(usize, f64, f64)>,
}

impl<'a> Search<'a> {
    fn new(
        library: &'a Library,
        channel: Channel,
        signals: Signals,
        reading: Vec<f64>,
        blocks: &[Block],
        allowed: &[usize],
    ) -> Self {
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
            random: Vec::new(),
            named: Vec::new(),
            left_out,
            last_scan: Vec::new(),
        };
        search.whiten();
        search.whiten();
        search
    }

    /// Noise model from what is left now, and everything fitted again with it.
    fn whiten(&mut self) {
        let residual = self.bench.residual_nt(&self.fit);
        let plain = Whitener::new(&self.blocks, Predictor::white(1.0), None);
        let projected = plain.apply(&residual);
        let mut rows = vec![0.0; residual.len()];
        plain.rows().zip(&projected).for_each(|(row, value)| rows[row] = *value);
        self.spectrum = Spectrum::of(&rows, &self.blocks);
        let predictor = match &self.spectrum {
            Some(spectrum) => {
                let mut autocovariance = spectrum.autocovariance();
                autocovariance[0] += LEAST_NOISE_NT * LEAST_NOISE_NT;
                Predictor::levinson(&autocovariance)
            }
            None => Predictor::white(
                (dot(&projected, &projected) / projected.len().max(1) as f64).sqrt().max(LEAST_NOISE_NT),
            ),
        };
        self.direction = None;
        self.bench.whitener = Whitener::new(&self.blocks, predictor.clone(), self.weights());
        if self.bench.channel == Channel::Scalar {
            self.direction = direction_growth(&self.bench, &self.bench.whitener.apply(&residual));
            if self.direction.is_some() {
                self.bench.whitener = Whitener::new(&self.blocks, predictor, self.weights());
            }
        }
        let terms = self.fit.terms.clone();
        self.refit(&terms);
    }

    fn weights(&self) -> Option<Vec<f64>> {
        let mut growth = self.direction.clone();
        for more in self.random.iter().filter_map(|candidate| candidate.variance.as_ref()) {
            match &mut growth {
                None => growth = Some(more.growth.clone()),
                Some(growth) => growth.iter_mut().zip(&more.growth).for_each(|(a, b)| *a *= b),
            }
        }
        growth.map(|growth| growth.iter().map(|g| 1.0 / g.sqrt()).collect())
    }

    fn refit(&mut self, terms: &[Term]) {
        self.fit = self.bench.fit(terms);
        self.bench.adopt(&self.fit);
    }

    /// Variance of the whitened noise: from the middle of its distribution, which nothing rare moves.
    fn variance(&self) -> f64 {
        variance_of(&self.fit.rest, self.bench.whitener.freedom() - self.fit.span.rank() as f64)
    }

    fn samples(&self) -> f64 {
        self.bench.whitener.freedom().max(10.0)
    }

    fn used(&self) -> Vec<usize> {
        let found = self.named.iter().map(|named| named.candidate.term.effect);
        self.left_out.iter().copied().chain(found).collect()
    }

    fn forward(&mut self) {
        while self.named.len() < MOST {
            let candidates = self.scanned(&self.fit, &self.used());
            let variance = self.variance();
            let significant: Vec<Candidate> =
                candidates.into_iter().filter(|c| c.log_p(variance) < LOG_FALSE_ALARM && !self.is_small(c)).collect();
            let best = self
                .refined(significant, &self.fit)
                .into_iter()
                .find(|c| !self.is_small(c) && c.log_p(variance) < LOG_FALSE_ALARM);
            let Some(best) = best else { break };
            self.add(best);
            if !self.confirm_last() {
                break;
            }
        }
    }

    /// Whether a candidate explains so little, next to what was found already, that the imperfection of that may be it.
    fn is_small(&self, candidate: &Candidate) -> bool {
        let found: f64 = self.named.iter().map(|named| named.candidate.gain).sum();
        let share = match (candidate.variance.is_some(), self.named.iter().any(|n| n.candidate.variance.is_some())) {
            (false, false) => SMALL,
            (true, true) => SMALL_BOTH_RANDOM,
            _ => SMALL_RANDOM,
        };
        candidate.gain < found * share
    }

    /// Whether it is a tone where the band of the swell that was found ends: what a finite recording cuts off there differs
    /// from what the sea did.
    fn is_edge_of_swell(&self, candidate: &Candidate) -> bool {
        let name = |candidate: &Candidate| candidate.term.name(self.bench.library);
        name(candidate) == "mains_alias"
            && SWELL_EDGES_HZ.iter().any(|edge| (candidate.term.at[0] - edge).abs() < EDGE_HZ)
            && self.named.iter().any(|named| name(&named.candidate) == "swell_induction")
    }

    /// All candidates, best evidence first.
    fn scanned(&self, fit: &Fit, left_out: &[usize]) -> Vec<Candidate> {
        let (variance, samples) = (self.variance(), self.samples());
        let mut candidates = scan(&self.bench, fit, left_out);
        candidates.retain(|candidate| !self.is_edge_of_swell(candidate));
        candidates.sort_by(|a, b| b.evidence(variance, samples).total_cmp(&a.evidence(variance, samples)));
        candidates
    }

    /// The best candidates, each fitted jointly with what is there; best evidence first.
    fn refined(&self, candidates: Vec<Candidate>, without: &Fit) -> Vec<Candidate> {
        let (variance, samples) = (self.variance(), self.samples());
        let evidence = |candidate: &Candidate| candidate.evidence(variance, samples);
        let Some(best) = candidates.iter().map(evidence).reduce(f64::max) else { return Vec::new() };
        let margin = MARGIN.0.max(MARGIN.1 * best.abs());
        let mut refined: Vec<Candidate> = candidates
            .into_iter()
            .filter(|candidate| evidence(candidate) > best - margin)
            .take(MARGIN.2)
            .map(|candidate| self.refine(candidate, without))
            .collect();
        refined.sort_by(|a, b| evidence(b).total_cmp(&evidence(a)));
        refined
    }

    fn refine(&self, mut candidate: Candidate, without: &Fit) -> Candidate {
        if candidate.variance.is_some() {
            return candidate;
        }
        let mut terms = without.terms.clone();
        terms.push(candidate.term.clone());
        let last = terms.len() - 1;
        let mut fit = self.bench.fit(&terms);
        if !tried_parameters(candidate.term.name(self.bench.library), &candidate.term.at, 1.0).is_empty() {
            terms.clone_from(&fit.terms);
            terms[last] = self.bench.tried(&fit, last, 4.0);
            let again = self.bench.fit(&terms);
            if again.sse() < fit.sse() {
                fit = again;
            }
        }
        if candidate.term.name(self.bench.library) == "sample_slip" {
            fit = self.slipped(fit, last);
        }
        let gain = without.sse() - fit.sse();
        candidate.term = fit.terms[last].clone();
        candidate.gain = if self.bench.is_plausible(&candidate.term) { gain } else { 0.0 };
        candidate
    }

    /// One sample more or less, as long as that leaves less: coefficients fitted with a wrong slip favour it.
    fn slipped(&self, mut fit: Fit, index: usize) -> Fit {
        for by in [-1.0, 1.0] {
            loop {
                let mut terms = fit.terms.clone();
                let samples = &mut terms[index].at[1];
                *samples += if *samples + by == 0.0 { 2.0 * by } else { by };
                let other = self.bench.fit(&terms);
                if other.sse() >= fit.sse() {
                    break;
                }
                fit = other;
            }
        }
        fit
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

    /// Whether the effect that was added last is still worth it with the new noise model; else it is taken out for good.
    fn confirm_last(&mut self) -> bool {
        let last = self.named.len() - 1;
        let log_p = self.log_p_of(last);
        self.named[last].log_p = log_p;
        if log_p < LOG_FALSE_ALARM {
            return true;
        }
        self.remove(last);
        false
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
        let mut terms = self.fit.terms.clone();
        terms.remove(index);
        self.bench.fit(&terms)
    }

    fn log_p_of(&mut self, named: usize) -> f64 {
        let variance = self.variance();
        if let Some(index) = self.term_index(named) {
            let gain = self.without(index).sse() - self.fit.sse();
            self.named[named].candidate.gain = gain;
            self.named[named].candidate.term = self.fit.terms[index].clone();
        }
        self.named[named].candidate.log_p(variance)
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

    /// Take each effect out: is it needed, and would another do better? Returns whether anything changed.
    fn review(&mut self) -> bool {
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
        left_out.retain(|&effect| effect != own.term.effect || self.left_out.contains(&effect));
        left_out.push(own.term.effect);
        let near = self.scanned(&without, &left_out);
        let near: Vec<Candidate> = near
            .into_iter()
            .filter(|candidate| {
                candidate.evidence(variance, samples) > evidence - MARGIN.0.max(MARGIN.1 * evidence.abs())
            })
            .collect();
        let rivals = self.refined(near, &without);
        self.named[named].rivals =
            rivals.iter().map(|rival| (rival.term.effect, rival.evidence(variance, samples))).collect();
        let Some(best) = rivals.into_iter().find(|rival| rival.variance.is_none()) else { return false };
        if best.evidence(variance, samples) <= evidence + 0.5 {
            return false;
        }
        let mut terms = self.fit.terms.clone();
        terms[index] = best.term.clone();
        let rivals = vec![(own.term.effect, evidence)];
        let better = best.evidence(variance, samples);
        let log_p = best.log_p(variance);
        self.named[named] = Named { candidate: best, log_p, evidence: better, rivals };
        self.refit(&terms);
        self.whiten();
        self.try_out();
        true
    }

    /// Two effects that add almost the opposite of each other are one at most: the lesser goes, and then the other unless
    /// it is needed by itself.
    fn refuse_opposites(&mut self) {
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
            .filter_map(|named| Some((named, self.bench.whitener.apply(&self.fit.columns[self.term_index(named)?]))))
            .collect();
        columns.iter().enumerate().find_map(|(k, (first, a))| {
            let cancels = |b: &[f64]| dot(a, b) < OPPOSITE * (dot(a, a) * dot(b, b)).sqrt();
            columns[k + 1..].iter().find(|(_, b)| cancels(b)).map(|(second, _)| (*first, *second))
        })
    }

    fn finish(mut self) -> Analysis<'a> {
        self.whiten();
        for named in 0..self.named.len() {
            self.named[named].log_p = self.log_p_of(named);
        }
        let (variance, samples) = (self.variance(), self.samples());
        let candidates = self.scanned(&self.fit, &self.used());
        self.last_scan =
            candidates.iter().map(|c| (c.term.effect, c.evidence(variance, samples), c.log_p(variance))).collect();
        if std::env::var("DBG").is_ok() {
            for c in &candidates {
                eprintln!(
                    "SCAN {:?} {} {:.2} {:.1} f{}",
                    self.bench.channel,
                    c.term.name(self.bench.library),
                    c.log_p(variance),
                    c.gain / variance,
                    c.freedom
                );
            }
        }
        let before = self.bench.fit(&[]);
        let noise_weights = match &self.direction {
            Some(growth) => growth.iter().map(|g| 1.0 / g.sqrt()).collect(),
            None => vec![1.0; self.bench.whitener.samples()],
        };
        let Self { bench, fit, spectrum, named, last_scan, .. } = self;
        Analysis { bench, fit, before, spectrum, named, last_scan, noise_weights, variance }
    }
}

/// Variance of whitened noise: from the median of its squares, but never above the mean of them.
fn variance_of(rest: &[f64], freedom: f64) -> f64 {
    if rest.is_empty() || freedom < 1.0 {
        return 1.0;
    }
    let mut squares: Vec<f64> = rest.iter().map(|z| z * z).collect();
    let mean = squares.iter().sum::<f64>() / freedom;
    let middle = squares.len() / 2;
    let (_, median, _) = squares.select_nth_unstable_by(middle, f64::total_cmp);
    // The median of chi-squared with one degree of freedom.
    let from_median = *median / 0.454_936 * rest.len() as f64 / freedom;
    from_median.min(mean).max(LEAST_VARIANCE)
}

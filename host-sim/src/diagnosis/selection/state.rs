//! The state of a selection: a value that each step replaces by the next one.

use std::cell::{Cell, OnceCell};

use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::model::{IsNoise, NoiseInput, NoiseModel};
use crate::diagnosis::noise::motion::MotionSpan;
use crate::diagnosis::null::tails::{mean_square_of_heavy_tails, normal_scores};
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::policy::{LEAST_VARIANCE, MOST_SCANS};
use crate::diagnosis::reconstruct::direction_noise::DirectionNoise;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;
use crate::diagnosis::search::{Candidate, Reach};
use crate::effects::Channel;

/// An effect that was found.
#[derive(Clone, Debug)]
pub(crate) struct Accepted {
    pub(crate) candidate: Candidate,
    /// Logarithm of the chance to gain as much without it, the others held.
    pub(crate) log_p: f64,
    /// Its evidence over nothing in its place, by [`Candidate::evidence`].
    pub(crate) evidence: f64,
    /// The same of every other effect in its place.
    pub(crate) rivals: Vec<(usize, f64)>,
    /// Of a cone, where the likely ones end.
    pub(crate) reach: Option<Reach>,
}

impl Accepted {
    /// Before it has been held against anything.
    pub(super) fn new(candidate: Candidate) -> Self {
        Self { candidate, log_p: 0.0, evidence: 0.0, rivals: Vec::new(), reach: None }
    }

    /// Index of the effect in the library.
    pub(super) fn effect(&self) -> usize {
        self.candidate.term.effect
    }
}

/// Problem, noise, fit and what was accepted, each that of the same step.
#[derive(Clone)]
pub(super) struct State<'a> {
    pub(super) problem: RegressionProblem<'a>,
    pub(super) noise: NoiseModel,
    pub(super) fit: Fit,
    /// Variance of what the fit leaves as far as it is noise, once it was asked for.
    variance: OnceCell<f64>,
    /// What the fit leaves over the root of that, heavy tails as normal ones, once it was asked for.
    without_tails: OnceCell<Vec<f64>>,
    /// What follows the motion.
    motion: MotionSpan,
    /// Noise of the fluxgate's direction; none where it does not enter.
    direction_noise: Option<DirectionNoise>,
    is_noise: IsNoise,
    /// Effects that are random, as the noise model has them.
    pub(super) random: Vec<Candidate>,
    /// What was accepted, additive and random, in the order of acceptance.
    pub(super) accepted: Vec<Accepted>,
    /// Effects that must not be looked at.
    pub(super) excluded: Vec<usize>,
    /// How often all effects were looked for.
    scans: Cell<usize>,
}

impl<'a> State<'a> {
    /// Nothing accepted, the noise estimated from what the 18 terms alone leave.
    pub(super) fn new(
        problem: RegressionProblem<'a>,
        blocks: &[Block],
        direction_noise: Option<DirectionNoise>,
        excluded: Vec<usize>,
        is_noise: IsNoise,
    ) -> Self {
        let noise = NoiseModel::white(blocks);
        // What the fluxgate's errors leave of its magnitude all follows the motion: nothing else would be told apart from it.
        let motion = match (problem.channel, is_noise) {
            (Channel::Scalar, IsNoise::OfASensor) => MotionSpan::of(&problem.signals, blocks),
            _ => MotionSpan::none(blocks),
        };
        let fit = problem.fit(&[]);
        let state = Self {
            problem,
            noise,
            fit,
            variance: OnceCell::new(),
            without_tails: OnceCell::new(),
            motion,
            direction_noise,
            is_noise,
            random: Vec::new(),
            accepted: Vec::new(),
            excluded,
            scans: Cell::new(0),
        };
        state.whitened().whitened()
    }

    /// One search of all effects more.
    pub(super) fn count_scan(&self) {
        self.scans.set(self.scans.get() + 1);
    }

    /// Whether the search has gone on for so long that it ends with what it has.
    pub(super) fn is_exhausted(&self) -> bool {
        self.scans.get() >= MOST_SCANS
    }

    /// With these terms fitted.
    pub(super) fn refitted(self, terms: &[Term]) -> Self {
        let fit = self.problem.fit(terms);
        self.with_fit(fit)
    }

    /// With a fit, linearised about its coefficients.
    pub(super) fn with_fit(self, fit: Fit) -> Self {
        let problem = self.problem.linearised_at(&fit);
        Self { problem, fit, variance: OnceCell::new(), without_tails: OnceCell::new(), ..self }
    }

    /// With the noise model that the residual says, and everything fitted again with it.
    pub(super) fn whitened(self) -> Self {
        let noise = self.noise.estimate(&NoiseInput {
            residual_nt: &self.problem.residual_nt(&self.fit),
            motion: &self.motion,
            signals: &self.problem.signals,
            direction_noise: self.direction_noise.as_ref(),
            random_nt2: &self.random_nt2(&self.random),
            is_noise: self.is_noise,
            holds_terms: self.problem.holds_terms(),
        });
        let terms = self.fit.terms.clone();
        let problem = self.problem.whitened_by(&noise.whitening);
        let random = self.random.into_iter().zip(&noise.random);
        let random = random.map(|(candidate, growth)| candidate.growing_by(growth.as_deref())).collect();
        Self { problem, noise, random, ..self }.refitted(&terms)
    }

    /// What each random effect adds to the variance of each row, nT^2.
    pub(super) fn random_nt2(&self, random: &[Candidate]) -> Vec<Option<Vec<f64>>> {
        random.iter().map(|candidate| self.problem.random_nt2(&candidate.term)).collect()
    }

    /// Effects that were accepted, and those that must not be looked at.
    pub(super) fn used(&self) -> Vec<usize> {
        self.excluded.iter().copied().chain(self.accepted.iter().map(Accepted::effect)).collect()
    }

    /// Index among the additive terms of what was accepted; none of what is random.
    pub(super) fn term_index(&self, accepted: usize) -> Option<usize> {
        let is_additive = |other: &&Accepted| other.candidate.variance.is_none();
        self.accepted[accepted]
            .candidate
            .variance
            .is_none()
            .then(|| self.accepted[..accepted].iter().filter(is_additive).count())
    }

    /// Index among the random effects of what was accepted and is random.
    pub(super) fn random_index(&self, accepted: usize) -> usize {
        self.accepted[..accepted].iter().filter(|other| other.candidate.variance.is_some()).count()
    }

    /// The fit without one of the terms.
    pub(super) fn fit_without(&self, index: usize) -> Fit {
        self.problem.fit(&self.fit.others(index))
    }

    /// Variance of the whitened noise, 1 where the noise model is right: from the middle of its distribution, which nothing rare moves,
    /// and from its tails where they are heavy all the time.
    pub(super) fn variance(&self) -> f64 {
        *self.variance.get_or_init(|| {
            let whitening = &self.problem.whitening;
            let observed: Vec<f64> = whitening.observed(&self.fit.residual_whitened).collect();
            variance_of(&observed, whitening.dof() - self.fit.projection.rank() as f64)
        })
    }

    /// What the fit leaves, of variance 1, were every value as large as a normal one of the same rank in its tails.
    pub(super) fn without_tails(&self) -> &[f64] {
        self.without_tails.get_or_init(|| {
            let spread = self.variance().sqrt();
            normal_scores(&self.fit.residual_whitened.iter().map(|z| z / spread).collect::<Vec<_>>())
        })
    }

    /// Independent samples.
    pub(super) fn samples(&self) -> f64 {
        self.problem.whitening.dof().max(10.0)
    }
}

/// Variance of whitened noise: from the median of its squares or from heavy tails, but never above the mean of them.
fn variance_of(residual: &[f64], dof: f64) -> f64 {
    if residual.is_empty() || dof < 1.0 {
        return 1.0;
    }
    let mean = residual.iter().map(|z| z * z).sum::<f64>() / dof;
    let of_middle = robust_mean_square(residual);
    let spread = of_middle.max(f64::MIN_POSITIVE).sqrt();
    let scaled: Vec<f64> = residual.iter().map(|z| z / spread).collect();
    let of_noise = of_middle * mean_square_of_heavy_tails(&scaled).unwrap_or(1.0).max(1.0);
    (of_noise * residual.len() as f64 / dof).min(mean).max(LEAST_VARIANCE)
}

//! What no named effect explains of a channel: its residual with all that is named, the 18 terms, the background and the targets in
//! the fit, and how much of it is above noise.

use std::sync::{Arc, OnceLock};

use crate::diagnosis::evidence::folds::{Part, parts};
use crate::diagnosis::findings::ChannelFindings;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::median;
use crate::diagnosis::once::made_once;
use crate::diagnosis::policy::{MOST_NOISE_NT2_PER_HZ, RATE_HZ};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::regression::term::Term;
use crate::simulator::signals::Signals;

/// Samples that a fold holds out together: ten seconds, longer than the noise remembers and than a period of most swell.
const PART_SAMPLES: usize = 100;
/// Frequencies at which the quietest band is looked for.
const FLOOR_BANDS: usize = 64;
/// Rounds of reweighting: the correlation of the course with a hidden current does not change in its third digit after them.
const REWEIGHTED: usize = 10;
/// Standard deviation of normal values over the middle of their sizes.
const MAD_TO_STD: f64 = 1.4826;

/// What is left of a channel.
pub(crate) struct Left<'a> {
    pub(crate) problem: RegressionProblem<'a>,
    /// The fit of what is named.
    pub(crate) fit: Fit,
    /// Whitened, everything fitted projected out.
    pub(crate) z: Vec<f64>,
    /// Sum of its squares above noise.
    pub(crate) excess: f64,
    /// Parts that are held out.
    pub(crate) parts: Vec<Part>,
    /// Variance of the noise in it.
    pub(crate) variance: f64,
    /// Found when it is first asked for.
    robust_nt: OnceLock<Vec<Option<f64>>>,
}

impl<'a> Left<'a> {
    /// Beside the effects that are named: what else was found may be pieces of this.
    pub(crate) fn of(channel: &ChannelFindings<'a>, named: &[&str]) -> Self {
        let (own, beside) = (&channel.selection, channel.named_from());
        let is_named = |term: &&Term| named.contains(&term.name(own.problem.library));
        let terms: Vec<Term> = beside.fit.terms.iter().filter(is_named).cloned().collect();
        let hides = own.noise.std_nt().is_some_and(|nt| nt * nt > most_noise_nt2());
        let (problem, variance) = match hides {
            true => (unhidden(&own.problem), 1.0),
            false => (own.problem.clone(), own.sensor_variance),
        };
        let fit = if terms.is_empty() && !hides { own.before.clone() } else { problem.fit(&terms) };
        Self::beside(problem, fit, variance)
    }

    /// The same with some effects fitted.
    pub(crate) fn with(self, terms: &[Term]) -> Self {
        if terms.is_empty() {
            return self;
        }
        let fit = self.problem.fit(terms);
        Self::beside(self.problem, fit, self.variance)
    }

    /// The effects in the fit that mean the same on another recording.
    pub(crate) fn portable(&self) -> Vec<Term> {
        let is_portable = |term: &&Term| self.problem.library[term.effect].spec().portable;
        self.fit.terms.iter().filter(is_portable).cloned().collect()
    }

    /// The same against white noise as loud as the quietest band of the noise model: what comes and goes with edges has a smooth spectrum,
    /// and a model of the noise takes it for colour.
    pub(crate) fn on_the_floor(&self) -> Self {
        let predictor = self.problem.whitening.predictor();
        let most =
            (0..=FLOOR_BANDS).map(|k| predictor.response(0.5 * k as f64 / FLOOR_BANDS as f64)).fold(0.0, f64::max);
        let floor = Predictor::white((self.variance / most.max(f64::MIN_POSITIVE)).sqrt());
        let problem = self.problem.whitened_by(&Arc::new(Whitening::new(self.problem.whitening.blocks(), floor, None)));
        let fit = problem.fit(&self.fit.terms);
        Self::beside(problem, fit, 1.0)
    }

    /// What a fit leaves, beside noise of a variance.
    fn beside(problem: RegressionProblem<'a>, fit: Fit, variance: f64) -> Self {
        let z = fit.residual_whitened.clone();
        let dof = problem.whitening.dof() - fit.projection.rank() as f64;
        let excess = (dot(&z, &z) - dof.max(1.0) * variance).max(0.0);
        let parts = parts(&problem.whitening.ranges(), PART_SAMPLES);
        Self { problem, fit, z, excess, parts, variance, robust_nt: OnceLock::new() }
    }

    /// Columns over the rows, as this residual would show them.
    pub(crate) fn swept(&self, columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.problem.projected(columns, &self.fit.projection)
    }

    /// Clean signals with the terms that fit the reading without a course, nT, one value a row.
    pub(crate) fn signals_beside(&self, course_nt: &[f64]) -> Arc<Signals> {
        let reading_nt = self.problem.reading_nt().iter().zip(course_nt).map(|(reading, nt)| reading - nt);
        let problem = self.problem.with_reading(reading_nt.collect());
        let fit = problem.fit(&self.fit.terms);
        problem.linearised_at(&fit).signals
    }

    /// The residual of a fit that no noise model colours, nT, one a row: whatever was taken for noise, the 18 terms fit it as it is.
    /// With a course taken off the reading before.
    pub(crate) fn plain_nt(&self, taken_nt: &[f64]) -> Vec<f64> {
        let mut reading_nt = self.problem.reading_nt().to_vec();
        reading_nt.iter_mut().zip(taken_nt).for_each(|(reading, taken)| *reading -= taken);
        let plain = unhidden(&self.problem).with_reading(reading_nt);
        plain.residual_nt(&plain.fit(&self.fit.terms))
    }

    /// The residual of a plain fit to most of the rows without its background, nT, one a row that is used: where something comes and
    /// goes, the 18 terms and the background of least squares take a part of it with them, and those of the rows that agree with each other
    /// do not (Cauchy's weights, reweighted least squares).
    pub(crate) fn robust_nt(&self) -> &[Option<f64>] {
        made_once::<Vec<_>>(&self.robust_nt, || self.find_robust_nt())
    }

    fn find_robust_nt(&self) -> Vec<Option<f64>> {
        let mut problem = unhidden(&self.problem);
        let mut off = off(&problem, &problem.fit(&self.fit.terms));
        for _ in 0..REWEIGHTED {
            let middle = median(off.iter().map(|off| off.abs()).collect()).max(f64::MIN_POSITIVE);
            let weights = off.iter().map(|off| (1.0 + (off / (MAD_TO_STD * middle)).powi(2)).powf(-0.5)).collect();
            let whitening = &problem.whitening;
            let weighed = Whitening::new(whitening.blocks(), whitening.predictor().clone(), Some(weights));
            problem = problem.whitened_by(&Arc::new(weighed));
            off = self::off(&problem, &problem.fit(&self.fit.terms));
        }
        let reading_nt = problem.reading_nt();
        let mut residual = vec![None; reading_nt.len()];
        for (row, off) in problem.whitening.rows().zip(off) {
            residual[row] = reading_nt[row].is_finite().then_some(off * most_noise_nt2().sqrt());
        }
        residual
    }

    /// Standard deviations by which it is above noise, about.
    pub(crate) fn strength(&self) -> f64 {
        (self.excess / self.variance.max(f64::MIN_POSITIVE)).sqrt()
    }
}

/// What a fit leaves of each sample, whatever it weighs.
fn off(problem: &RegressionProblem<'_>, fit: &Fit) -> Vec<f64> {
    fit.residual_whitened.iter().zip(problem.whitening.weights()).map(|(z, weight)| z / weight).collect()
}

/// Variance of the noise that no sensor exceeds, nT^2.
fn most_noise_nt2() -> f64 {
    MOST_NOISE_NT2_PER_HZ * 0.5 * RATE_HZ
}

/// A problem whose noise model has taken the gap for noise, without one: white noise of the most that a sensor has.
fn unhidden<'a>(problem: &RegressionProblem<'a>) -> RegressionProblem<'a> {
    let white = Predictor::white(most_noise_nt2().sqrt());
    problem.whitened_by(&Arc::new(Whitening::new(problem.whitening.blocks(), white, None)))
}

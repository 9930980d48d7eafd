//! From one channel of a recording to the effects that are at work in it.

use std::sync::Arc;

use super::state::{Accepted, State};
use crate::diagnosis::evidence::accounted::Whitened;
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::model::{IsNoise, NoiseModel};
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::policy::REVIEWS;
use crate::diagnosis::reconstruct::direction_noise::DirectionNoise;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::search::Candidate;
use crate::effects::{Channel, Library, Search};
use crate::simulator::signals::Signals;

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
    pub(crate) direction_noise: Option<DirectionNoise>,
    pub(crate) is_noise: IsNoise,
    /// Whether the 18 terms are not refitted.
    pub(crate) holds_terms: bool,
    /// Random effects that were found before.
    pub(crate) known: Vec<Candidate>,
}

/// A channel after the search.
pub(crate) struct Selection<'a> {
    pub(crate) problem: RegressionProblem<'a>,
    pub(crate) noise: NoiseModel,
    /// With everything that was accepted.
    pub(crate) fit: Fit,
    /// With nothing, whitened in the end's way.
    pub(crate) before: Fit,
    pub(crate) accepted: Vec<Accepted>,
    /// Every other effect on what is left in the end.
    pub(crate) last_scan: Vec<Scanned>,
    /// Variance of the whitened noise, 1 when the noise model is right.
    pub(crate) variance: f64,
    /// What of it is a sensor's and no gap.
    pub(crate) sensor_variance: f64,
    /// Effects that might have been named.
    pub(crate) allowed: Vec<usize>,
    /// Whether the search ended with what it had, because it had gone on for long.
    pub(crate) is_cut_short: bool,
}

impl<'a> Selection<'a> {
    /// The search once more, all that was left of it taken for noise: what is found then is more than a piece of what nobody knows.
    /// Random effects are not looked for, as noise that is larger somewhere may be a piece of anything; a cone that was found, which has an
    /// edge, is judged once more.
    pub(crate) fn beside_rest(&self) -> Self {
        let Self { problem, allowed, noise, .. } = self;
        let search = |index: &usize| problem.library[*index].spec().search;
        let is_additive = |index: &usize| !matches!(search(index), Search::Variance { .. } | Search::Cone);
        let accepted = self.accepted.iter().map(|accepted| &accepted.candidate);
        let known = accepted.filter(|candidate| search(&candidate.term.effect) == Search::Cone);
        let asked = Asked {
            library: problem.library,
            channel: problem.channel,
            signals: (*problem.signals).clone(),
            reading: problem.reading_nt().to_vec(),
            blocks: problem.whitening.blocks(),
            allowed: &allowed.iter().copied().filter(is_additive).collect::<Vec<_>>(),
            direction_noise: None,
            is_noise: IsNoise::AllThatIsLeft,
            holds_terms: problem.holds_terms(),
            known: known.cloned().collect(),
        };
        let found = select(asked);
        let whitened = |sensor| found.problem.whitening.predictor().whitened_variance(sensor);
        let sensor_variance = noise.spectrum.as_ref().map_or(0.0, whitened);
        Self { sensor_variance: sensor_variance.min(found.variance), ..found }
    }

    /// What each random effect adds to the variance of each row, nT^2.
    pub(crate) fn random_nt2(&self) -> Vec<Option<Vec<f64>>> {
        let accepted = self.accepted.iter().map(|accepted| &accepted.candidate);
        let random = accepted.filter(|candidate| candidate.variance.is_some());
        random.map(|candidate| self.problem.random_nt2(&candidate.term)).collect()
    }

    /// What the fit leaves, whitened.
    pub(crate) fn whitened(&self) -> Whitened<'_> {
        Whitened {
            whitening: &self.problem.whitening,
            noise: &self.noise,
            residual_whitened: &self.fit.residual_whitened,
            variance: self.variance,
        }
    }
}

/// An effect that was looked for in the end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scanned {
    pub(crate) effect: usize,
    pub(crate) evidence: f64,
    /// Logarithm of its chance under noise.
    pub(crate) log_p: f64,
}

/// Search a channel.
pub(crate) fn select<'a>(asked: Asked<'a, '_>) -> Selection<'a> {
    let allowed = asked.allowed.to_vec();
    let mut state = start(asked).forward();
    for _ in 0..REVIEWS {
        let (reviewed, has_changed) = state.reviewed();
        state = reviewed;
        if !has_changed {
            break;
        }
    }
    finish(state.without_opposites().without_unproved(), allowed)
}

fn start<'a>(asked: Asked<'a, '_>) -> State<'a> {
    let Asked { library, channel, signals, reading, blocks, allowed, direction_noise, is_noise, holds_terms, known } =
        asked;
    let whitening = Whitening::new(blocks, Predictor::white(1.0), None);
    let problem = RegressionProblem::new(library, channel, signals, reading, Arc::new(whitening));
    let problem = problem.holding_terms(holds_terms && channel == Channel::Scalar);
    let excluded = (0..library.len()).filter(|index| !allowed.contains(index)).collect();
    // It enters through the 18 terms, which the fluxgate's magnitude has not.
    let direction_noise = direction_noise.filter(|_| channel == Channel::Scalar);
    known.into_iter().fold(State::new(problem, blocks, direction_noise, excluded, is_noise), State::with)
}

fn finish(state: State<'_>, allowed: Vec<usize>) -> Selection<'_> {
    // Before all effects are looked for once more.
    let is_cut_short = state.is_exhausted();
    let mut state = state.whitened().with_reach();
    // How much random effects make the noise grow was told anew by the last noise model.
    for accepted in &mut state.accepted {
        let own = state.random.iter().find(|candidate| candidate.term.effect == accepted.effect());
        accepted.candidate = own.unwrap_or(&accepted.candidate).clone();
    }
    let state = (0..state.accepted.len()).fold(state, State::judged);
    let (variance, samples) = (state.variance(), state.samples());
    let table = state.scanned(&state.fit, &state.used());
    let scanned = table.into_rows().map(|candidate| Scanned {
        effect: candidate.term.effect,
        evidence: candidate.evidence(variance, samples),
        log_p: state.log_p_of_many(&candidate, state.log_p(&candidate)),
    });
    let (last_scan, before) = (scanned.collect(), state.problem.fit(&[]));
    let State { problem, noise, fit, accepted, .. } = state;
    let sensor_variance = variance;
    Selection { problem, noise, fit, before, accepted, last_scan, variance, sensor_variance, allowed, is_cut_short }
}

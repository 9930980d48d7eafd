//! The noise of a channel as a value: its colour, the noise of the direction, and what random effects add.

use std::sync::Arc;

use super::blocks::Block;
use super::direction::{DirectionGrowth, direction_growth};
use super::direction_spectrum::DirectionSpectrum;
use super::events::{events_nt, is_loud_enough};
use super::motion::MotionSpan;
use super::spectrum::NoiseSpectrum;
use super::variance::innovation_variance;
use super::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::rms;
use crate::diagnosis::policy::{
    LEAST_NOISE_NT, NOISE_MODEL_TOLERANCE, NOISE_MODEL_TOLERANCE_SAMPLES, QUIETER_THAN_TARGETS, RATE_HZ,
};
use crate::diagnosis::reconstruct::direction_noise::DirectionNoise;
use crate::simulator::signals::Signals;

/// Rounds in which events are taken out: each tells them from a quieter noise.
const EVENT_ROUNDS: usize = 6;

/// The noise of a channel, and the whitening that follows from it. It is never changed: the next one is estimated from the
/// residual that this one leaves.
#[derive(Clone, Debug)]
pub(crate) struct NoiseModel {
    blocks: Arc<[Block]>,
    /// NoiseSpectrum of the noise that is there in all rows; none where the recording is too short for one.
    pub(crate) spectrum: Option<NoiseSpectrum>,
    predictor: Predictor,
    /// Noise of the direction, where it shows.
    pub(crate) direction: Option<DirectionGrowth>,
    /// Growth of each sample's variance by each random effect; none of one that the channel does not show.
    pub(crate) random: Vec<Option<Vec<f64>>>,
    pub(crate) whitening: Arc<Whitening>,
}

/// What a noise model is estimated from.
pub(crate) struct NoiseInput<'b> {
    /// Residual of a fit, one a row, nT.
    pub(crate) residual_nt: &'b [f64],
    /// What follows the motion, in the blocks of the model.
    pub(crate) motion: &'b MotionSpan,
    pub(crate) signals: &'b Signals,
    /// Noise of the fluxgate's direction; none where it does not enter.
    pub(crate) direction_noise: Option<&'b DirectionNoise>,
    /// What each random effect adds to the variance of each row, nT^2.
    pub(crate) random_nt2: &'b [Option<Vec<f64>>],
    /// What is taken for noise.
    pub(crate) is_noise: IsNoise,
    /// Whether the 18 terms are those of a simulation that was laid on the recording, by its direction.
    pub(crate) holds_terms: bool,
}

/// What of a residual is taken for noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum IsNoise {
    /// What a sensor may have: neither lines and bursts, nor what follows the motion, nor what is too loud.
    OfASensor,
    /// All that is left, whatever its cause: what is found beside it stands out of it.
    AllThatIsLeft,
}

impl NoiseModel {
    /// White noise of unit variance: what is known before anything is fitted.
    pub(crate) fn white(blocks: &[Block]) -> Self {
        Self::of_predictor(blocks, Predictor::white(1.0))
    }

    /// Noise that a predictor makes white, in all rows alike.
    pub(crate) fn of_predictor(blocks: &[Block], predictor: Predictor) -> Self {
        Self {
            blocks: blocks.into(),
            spectrum: None,
            whitening: Arc::new(Whitening::new(blocks, predictor.clone(), None)),
            predictor,
            direction: None,
            random: Vec::new(),
        }
    }

    /// The model that follows from a residual. This one tells random effects from what is there all the time.
    pub(crate) fn estimate(&self, input: &NoiseInput<'_>) -> Self {
        let left_nt = input.motion.beside_background(input.residual_nt);
        let spectrum = match input.is_noise {
            IsNoise::OfASensor => {
                let of_direction = self.of_direction(input);
                let of = |left_nt: &[f64]| self.spectrum_of(left_nt, input, of_direction.as_ref());
                of(&left_nt).map(|all| self.beside_events(all, &left_nt, input, of))
            }
            IsNoise::AllThatIsLeft => {
                let left_nt = input.motion.on_rows(&left_nt, input.residual_nt.len());
                NoiseSpectrum::of_all(&left_nt, &self.blocks, 0.5)
            }
        };
        let predictor = match &spectrum {
            Some(spectrum) => Predictor::of(spectrum),
            None => Predictor::white(rms(&left_nt).max(LEAST_NOISE_NT)),
        };
        let coloured = Self { spectrum, predictor, direction: None, ..self.clone() }.with_random(input.random_nt2);
        coloured.with_direction(input)
    }

    /// With the noise of the direction, where it enters and shows.
    fn with_direction(self, input: &NoiseInput<'_>) -> Self {
        let Some(noise) = input.direction_noise else { return self };
        let whitened = self.whitening.apply(input.residual_nt);
        match direction_growth(input.signals, &self.whitening, &whitened, noise) {
            Some(growth) => Self { direction: Some(growth), ..self }.with_random(input.random_nt2),
            None => self,
        }
    }

    /// NoiseSpectrum of the noise that is there in all rows: of what the background leaves, but where far less is left without what
    /// follows the motion. The latter alone would not do, as a few large values that no column knows are all over it.
    fn spectrum_of(
        &self,
        left_nt: &[f64],
        input: &NoiseInput<'_>,
        of_direction: Option<&DirectionSpectrum>,
    ) -> Option<NoiseSpectrum> {
        let (motion, rows) = (input.motion, input.residual_nt.len());
        let random_nt2 = (!input.random_nt2.is_empty()).then(|| sum(input.random_nt2, rows));
        let of = |left_nt: &[f64], left| self.spectrum_without(left_nt, left, random_nt2.as_deref(), of_direction);
        let by_background = of(&motion.on_rows(left_nt, rows), motion.left_by_background())?;
        let by_motion = motion.beside(left_nt).and_then(|left_nt| of(&motion.on_rows(&left_nt, rows), motion.left()));
        Some(match by_motion {
            Some(by_motion) => by_background.where_not_far_above(&by_motion),
            None => by_background,
        })
    }

    /// The spectrum that the noise of the direction has in the interference; none where it does not enter. Where terms are held nothing is
    /// refitted: how the simulation was laid on is known no better than that noise lets it, and would stand out of it.
    fn of_direction(&self, input: &NoiseInput<'_>) -> Option<DirectionSpectrum> {
        if input.holds_terms {
            return None;
        }
        let signals = input.signals;
        let draws_nt = input.direction_noise?.interference_nt(signals, signals.coefficients());
        DirectionSpectrum::of_draws(&draws_nt.collect::<Vec<_>>(), &self.blocks)
    }

    /// The same without what comes at single moments, where far less is left without it: what is switched has the spectrum of a random
    /// walk, but all in a few of its steps.
    /// `of` is that of what is left over the rows.
    fn beside_events(
        &self,
        spectrum: NoiseSpectrum,
        left_nt: &[f64],
        input: &NoiseInput<'_>,
        of: impl Fn(&[f64]) -> Option<NoiseSpectrum>,
    ) -> NoiseSpectrum {
        let mut spectrum = spectrum;
        let mut quiet_nt = left_nt.to_vec();
        for _ in 0..EVENT_ROUNDS {
            let Some(events_nt) = events_nt(&Predictor::of(&spectrum), &self.blocks, &quiet_nt) else { break };
            quiet_nt.iter_mut().zip(&events_nt).for_each(|(left, event)| *left -= event);
            let rows = input.residual_nt.len();
            quiet_nt = input.motion.beside_background(&input.motion.on_rows(&quiet_nt, rows));
            let Some(without) = of(&quiet_nt) else { break };
            let quieter = spectrum.clone().where_not_far_above(&without);
            if !is_loud_enough(&Predictor::of(&quieter), &self.blocks, left_nt) {
                break;
            }
            spectrum = quieter;
        }
        spectrum
    }

    /// Of what is left over the rows, where `left` is left of white noise, without what random effects add to each row, nT^2.
    fn spectrum_without(
        &self,
        left_nt: &[f64],
        left: &[Vec<f64>],
        random_nt2: Option<&[f64]>,
        of_direction: Option<&DirectionSpectrum>,
    ) -> Option<NoiseSpectrum> {
        let of_all = || NoiseSpectrum::of(left_nt, &self.blocks, left, of_direction);
        match random_nt2 {
            None => of_all(),
            Some(random_nt2) => {
                let before = self.spectrum.clone().or_else(of_all)?;
                Some(before.without(left_nt, &self.blocks, left, random_nt2, of_direction))
            }
        }
    }

    /// Rms of the noise that is there in all rows, nT; none where the recording is too short for a spectrum.
    pub(crate) fn std_nt(&self) -> Option<f64> {
        self.spectrum.as_ref().map(NoiseSpectrum::std_nt)
    }

    /// The same colour with other random effects: each sample is weighted by its own variance.
    pub(crate) fn with_random(&self, random_nt2: &[Option<Vec<f64>>]) -> Self {
        let direction = self.direction_growth().map(weights_of);
        let whitening = Whitening::new(&self.blocks, self.predictor.clone(), direction);
        if random_nt2.is_empty() {
            return Self { whitening: Arc::new(whitening), random: Vec::new(), ..self.clone() };
        }
        let grown = |added: &Vec<f64>| innovation_variance(&whitening, added).iter().map(|added| 1.0 + added).collect();
        let random: Vec<Option<Vec<f64>>> = random_nt2.iter().map(|added| added.as_ref().map(grown)).collect();
        let mut growth = vec![1.0; whitening.samples()];
        for own in random.iter().flatten() {
            growth.iter_mut().zip(own).for_each(|(sum, own)| *sum += own - 1.0);
        }
        if let Some(direction) = self.direction_growth() {
            growth.iter_mut().zip(direction).for_each(|(growth, direction)| *growth *= direction);
        }
        let whitening = Whitening::new(&self.blocks, self.predictor.clone(), Some(weights_of(&growth)));
        Self { whitening: Arc::new(whitening), random, ..self.clone() }
    }

    /// Power density of whitened noise by frequency, Hz, over that of white noise: white noise in some of the rows, which random effects
    /// add, is not white any more once all rows are whitened alike.
    pub(crate) fn whitened_density(&self) -> impl Fn(f64) -> f64 + '_ {
        let (added, mean) = (self.random_share(), self.predictor.squared_weights().iter().sum::<f64>());
        let response = move |hz: f64| if added == 0.0 { 1.0 } else { self.predictor.response(hz / RATE_HZ) / mean };
        move |hz| 1.0 - added + added * response(hz)
    }

    /// What some of the random effects, by their index, add to the variance of each sample, over what that is without any.
    pub(crate) fn added_by(&self, is_counted: impl Fn(usize) -> bool) -> Vec<f64> {
        let mut added = vec![0.0; self.whitening.samples()];
        let counted = self.random.iter().enumerate().filter(|(index, _)| is_counted(*index));
        for growth in counted.filter_map(|(_, growth)| growth.as_ref()) {
            added.iter_mut().zip(growth).for_each(|(sum, growth)| *sum += growth - 1.0);
        }
        added
    }

    /// Share of the power of whitened noise that random effects add.
    fn random_share(&self) -> f64 {
        let added = self.added_by(|_| true);
        let samples = added.len().max(1) as f64;
        added.into_iter().map(|added| added / (1.0 + added)).sum::<f64>() / samples
    }
}

/// What predicts all that the background leaves of a residual, nT, one a row, whatever its cause, from the quieter minutes, as large
/// targets may be in many; none where a recording is too short for a spectrum.
pub(crate) fn predictor_of_all(residual_nt: &[f64], blocks: &[Block]) -> Option<Predictor> {
    let background = MotionSpan::none(blocks);
    let left_nt = background.on_rows(&background.beside_background(residual_nt), residual_nt.len());
    NoiseSpectrum::of_all(&left_nt, blocks, QUIETER_THAN_TARGETS).map(|all| Predictor::of(&all))
}

/// What the noise model may be off by, as a share of the variance, with so many samples to make it from.
pub(crate) fn tolerance(samples: usize) -> f64 {
    NOISE_MODEL_TOLERANCE + NOISE_MODEL_TOLERANCE_SAMPLES / (samples.max(1) as f64).sqrt()
}

/// What random effects add to the variance of each row together.
fn sum(random_nt2: &[Option<Vec<f64>>], rows: usize) -> Vec<f64> {
    let mut sum = vec![0.0; rows];
    for added in random_nt2.iter().flatten() {
        sum.iter_mut().zip(added).for_each(|(sum, more)| *sum += more);
    }
    sum
}

/// Weights of samples whose variance grows.
pub(super) fn weights_of(growth: &[f64]) -> Vec<f64> {
    growth.iter().map(|g| 1.0 / g.sqrt()).collect()
}

//! The estimator of the level: generalised least squares, gated, in absolute units.

use super::super::robust::{gate_weight, tracked};
use super::super::square_root_information::SquareRootInformation;
use super::super::{Information, Prior};
use super::columns::History;
use super::config::{Level, uninformed};
use super::whitening::{Whitening, WhiteningState};
use crate::front_end::Observation;
use crate::model::{Coefficients, Row, TermVector};
use crate::policy::{DEFAULT_NOISE_NT, FAILURE_SHARE, GATE, INNOVATION_CLIP, LEVEL_LEAST_VARIANCE, RECENTRE_EVERY};

/// What it remembers.
#[derive(Clone, Debug)]
pub struct LevelEstimator {
    factor: SquareRootInformation,
    coefficients: Coefficients,
    /// Of a whitened row, nT^2.
    noise_variance: f32,
    history: History,
    whitening: Option<WhiteningState>,
    reference_pt: i32,
    /// Normalised innovation of now, or what is left of a larger one.
    surprise: f32,
    failure_share: f32,
    epochs_since_start: u32,
}

impl AsRef<Coefficients> for LevelEstimator {
    fn as_ref(&self) -> &Coefficients {
        &self.coefficients
    }
}

impl LevelEstimator {
    /// One of no use before [`start`](Self::start).
    pub const BLANK: Self = Self {
        factor: SquareRootInformation::EMPTY,
        coefficients: Coefficients::ZERO,
        noise_variance: 0.0,
        history: History::BLANK,
        whitening: None,
        reference_pt: 0,
        surprise: 0.0,
        failure_share: 0.0,
        epochs_since_start: 0,
    };

    /// One that knows nothing yet.
    pub fn uninformed() -> Self {
        let mut state = Self::BLANK;
        state.start(&Prior::from(Coefficients::ZERO));
        state
    }

    /// Before the first epoch, with what a calibration has learnt of the level.
    pub fn start(&mut self, prior: &Prior) {
        match &prior.level {
            Some(level) => {
                self.factor = level.factor(1.0);
                self.coefficients = *level.centre();
                self.noise_variance = (level.noise_nt() * level.noise_nt()).max(LEVEL_LEAST_VARIANCE);
            }
            None => {
                self.factor = uninformed();
                self.noise_variance = DEFAULT_NOISE_NT * DEFAULT_NOISE_NT;
            }
        }
    }

    /// Take in an epoch. Returns the columns that the coefficients of before are to be multiplied with.
    pub(crate) fn step(&mut self, level: &Level, tick: u32, observation: &Observation) -> TermVector {
        let Observation { terms, scalar_pt, is_first, .. } = observation;
        if *is_first {
            self.whitening = None;
            self.history = History::BLANK;
            self.reference_pt = *scalar_pt;
        }
        let scalar_nt = (scalar_pt - self.reference_pt) as f32 / 1000.0;
        let (columns, row) = self.history.step(tick, terms, scalar_nt, level.rate_hz);
        if let Some(row) = row {
            self.learn(level, &row);
        }
        columns
    }

    fn learn(&mut self, level: &Level, row: &Row) {
        let state = self.whitening.get_or_insert_with(|| Whitening::steady(row));
        let row = level.whitening.step(state, row);
        let error_nt = row.scalar_nt - self.coefficients.predict_nt(&row.terms);
        let uncertainty = self.factor.leverage(&row.terms);
        let innovation = libm::fabsf(error_nt) / libm::sqrtf(self.noise_variance + uncertainty);
        let rate = level.noise_rate * self.noise_variance / (self.noise_variance + uncertainty);
        self.noise_variance = tracked(self.noise_variance, innovation, rate).max(LEVEL_LEAST_VARIANCE);
        // The flank of a target is as small as the noise, and what the gate lets through of it bends a heading that is seen for the
        // first time: after a target the gate opens slowly.
        self.surprise = innovation.max(level.held * self.surprise);
        self.update(level, &row, gate_weight(self.surprise, GATE) / self.noise_variance);
        self.watch(level, innovation);
    }

    /// Rows count by their noise: those of a wild beginning must not outweigh what comes after it.
    fn update(&mut self, level: &Level, row: &Row, weight: f32) {
        self.factor.forget(level.sqrt_forgetting);
        self.factor.add_weighted(row, weight);
        if let Some(coefficients) = Coefficients::from_basis(self.factor.least_squares()) {
            self.coefficients = coefficients;
        }
        self.epochs_since_start = self.epochs_since_start.saturating_add(1);
        if self.epochs_since_start.is_multiple_of(RECENTRE_EVERY) {
            self.factor.recentre(&self.coefficients);
        }
    }

    /// Count failed predictions, and start anew where a sensor has been moved, from nothing: coefficients of another body are
    /// further from this one's than zero is.
    fn watch(&mut self, level: &Level, innovation: f32) {
        let failed = f32::from(u8::from(innovation > INNOVATION_CLIP));
        self.failure_share += level.failure_rate * (failed - self.failure_share);
        if self.failure_share > FAILURE_SHARE && self.epochs_since_start > level.restart_epochs {
            self.factor = uninformed();
            self.coefficients = Coefficients::ZERO;
            self.surprise = 0.0;
            // What it has grown to is the failure's: it would take minutes to fall, and rows would count for nothing.
            self.noise_variance = DEFAULT_NOISE_NT * DEFAULT_NOISE_NT;
            self.failure_share = 0.0;
            self.epochs_since_start = 0;
        }
    }

    /// What it knows, for the next time; `None` when that is not finite.
    pub fn information(&self) -> Option<Information> {
        Information::of(&self.factor, libm::sqrtf(self.noise_variance))
    }
}

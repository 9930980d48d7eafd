//! The estimator that the settings choose, with its state.

use crate::estimate::{
    Adaptive, Bank, Estimator, Fixed, MEMBERS, Prior, Quality, Rls, SaddlePoint, SquareRootInformation,
};
use crate::model::{Coefficients, Row};
use crate::settings::{Method, Settings};

/// An estimator and what it remembers.
#[derive(Clone, Debug)]
// One pipeline on the body, none of it moves: the small variant may waste the space of the large one.
#[allow(clippy::large_enum_variant)]
pub(crate) enum RunningEstimator {
    Fixed(Fixed, <Fixed as Estimator>::State),
    Rls(Rls, <Rls as Estimator>::State),
    SaddlePoint(SaddlePoint, <SaddlePoint as Estimator>::State),
    Adaptive(Adaptive, <Adaptive as Estimator>::State),
}

impl RunningEstimator {
    /// The cheapest, with zero coefficients.
    // A function: as a constant it would stand in the flash in the size of the largest variant, 10 kB.
    pub(crate) fn none() -> Self {
        Self::Fixed(Fixed, Fixed::IDLE)
    }

    /// The estimator of the settings' method, which knows nothing yet.
    pub(crate) fn idle(settings: &Settings) -> Self {
        let Settings { band_pass, penalty, forgetting, dual_step, .. } = *settings;
        match settings.method {
            Method::None | Method::Fixed => Self::none(),
            Method::Rls => Self::Rls(Rls::new(forgetting, penalty.lambda2), Rls::IDLE),
            Method::SaddlePoint => {
                Self::SaddlePoint(SaddlePoint::new(penalty, forgetting, dual_step), SaddlePoint::IDLE)
            }
            Method::Adaptive => Self::Adaptive(Adaptive::new(forgetting, penalty.lambda2, band_pass), Adaptive::IDLE),
        }
    }

    pub(crate) fn start(&mut self, prior: &Prior) {
        match self {
            Self::Fixed(estimator, state) => estimator.start(state, prior),
            Self::Rls(estimator, state) => estimator.start(state, prior),
            Self::SaddlePoint(estimator, state) => estimator.start(state, prior),
            Self::Adaptive(estimator, bank) => estimator.start(bank, prior),
        }
    }

    /// Learn from an epoch.
    pub(crate) fn update(&mut self, row: &Row) {
        match self {
            Self::Fixed(estimator, state) => estimator.update(state, row),
            Self::Rls(estimator, state) => estimator.update(state, row),
            Self::SaddlePoint(estimator, state) => estimator.update(state, row),
            Self::Adaptive(estimator, bank) => estimator.update(bank, row),
        }
    }

    /// An epoch has passed that was not learnt.
    pub(crate) fn skip(&mut self) {
        if let Self::Adaptive(_, bank) = self {
            bank.skip();
        }
    }

    pub(crate) fn coefficients(&self) -> &Coefficients {
        match self {
            Self::Fixed(_, state) => state,
            Self::Rls(_, state) | Self::SaddlePoint(_, state) => state.as_ref(),
            Self::Adaptive(_, bank) => bank.as_ref(),
        }
    }

    pub(crate) fn information(&self) -> Option<&SquareRootInformation> {
        match self {
            Self::Fixed(..) => None,
            Self::Rls(_, state) | Self::SaddlePoint(_, state) => Some(state.factor()),
            Self::Adaptive(_, bank) => Some(bank.information()),
        }
    }

    pub(crate) fn noise_gain(&self) -> f32 {
        match self {
            Self::Adaptive(adaptive, bank) => bank.noise_gain(adaptive),
            _ => 1.0,
        }
    }

    pub(crate) fn probabilities(&self) -> Option<[f32; MEMBERS]> {
        self.bank().map(Bank::probabilities)
    }

    pub(crate) fn quality(&self) -> Option<&Quality> {
        self.bank().map(Bank::quality)
    }

    /// Whether it is the adaptive method, and all that this remembers.
    pub(crate) fn bank(&self) -> Option<&Bank> {
        match self {
            Self::Adaptive(_, bank) => Some(bank),
            _ => None,
        }
    }
}

//! One epoch in, one output out: the same on the body and on the desk.

use crate::epoch::{Compensated, Epoch, Output, Status};
use crate::estimate::{
    Adaptive, Estimator, Fixed, MEMBERS, Prior, Quality, Rls, SaddlePoint, SquareRootInformation, Steering,
    SteeringState,
};
use crate::front_end::{FrontEnd, FrontEndState, Observation};
use crate::model::Coefficients;
use crate::settings::{Method, Settings, SettingsError};

/// Front end and estimator, with their state.
#[derive(Clone, Debug)]
pub struct Pipeline {
    front_end: FrontEnd,
    front_end_state: FrontEndState,
    estimator: Running,
    steering: Steering,
    steering_state: SteeringState,
    level_nt: f64,
}

/// The chosen estimator in motion.
#[derive(Clone, Debug)]
// One pipeline on the body, none of it moves: the small variant may waste the space of the large one.
#[allow(clippy::large_enum_variant)]
enum Running {
    Fixed(Fixed, <Fixed as Estimator>::State),
    Rls(Rls, <Rls as Estimator>::State),
    SaddlePoint(SaddlePoint, <SaddlePoint as Estimator>::State),
    Adaptive(Adaptive, <Adaptive as Estimator>::State),
}

impl Running {
    /// The estimator of the settings' method, which knows nothing yet.
    fn idle(settings: &Settings) -> Self {
        let Settings { band_pass, penalty, forgetting, dual_step, .. } = *settings;
        match settings.method {
            Method::None | Method::Fixed => Self::Fixed(Fixed, Fixed::IDLE),
            Method::Rls => Self::Rls(Rls::new(forgetting, penalty.lambda2), Rls::IDLE),
            Method::SaddlePoint => {
                Self::SaddlePoint(SaddlePoint::new(penalty, forgetting, dual_step), SaddlePoint::IDLE)
            }
            Method::Adaptive => Self::Adaptive(Adaptive::new(forgetting, penalty.lambda2, band_pass), Adaptive::IDLE),
        }
    }

    fn start(&mut self, prior: &Prior) {
        match self {
            Self::Fixed(estimator, state) => estimator.start(state, prior),
            Self::Rls(estimator, state) => estimator.start(state, prior),
            Self::SaddlePoint(estimator, state) => estimator.start(state, prior),
            Self::Adaptive(estimator, bank) => estimator.start(bank, prior),
        }
    }

    fn coefficients(&self) -> &Coefficients {
        match self {
            Self::Fixed(_, state) => state,
            Self::Rls(_, state) | Self::SaddlePoint(_, state) => state.as_ref(),
            Self::Adaptive(_, bank) => bank.as_ref(),
        }
    }

    fn update(&mut self, observation: &Observation) {
        let row = &observation.band_passed;
        match self {
            Self::Fixed(estimator, state) => estimator.update(state, row),
            Self::Rls(estimator, state) => estimator.update(state, row),
            Self::SaddlePoint(estimator, state) => estimator.update(state, row),
            Self::Adaptive(estimator, bank) => estimator.update(bank, row),
        }
    }
}

impl Running {
    /// An epoch that is not learnt.
    fn pass(&mut self) {
        if let Self::Adaptive(_, bank) = self {
            bank.pass();
        }
    }
}

/// What is computed from the settings once.
// Not within its callers, as `passive_in`.
#[inline(never)]
fn designs(settings: &Settings) -> Result<(FrontEnd, Steering), SettingsError> {
    settings.validate()?;
    let front_end = FrontEnd::new(settings.band_pass)?;
    Ok((front_end, Steering::new(front_end.band_pass())))
}

impl Pipeline {
    /// A pipeline before its first epoch. `prior` is what a calibration has found: its coefficients, or these with the
    /// information behind them, which the adaptive method makes use of; [`Coefficients::ZERO`] when there is none.
    pub fn new(settings: &Settings, prior: impl Into<Prior>) -> Result<Self, SettingsError> {
        let (front_end, steering) = designs(settings)?;
        let mut pipeline = Self::passive(front_end, steering);
        pipeline.idle(settings);
        pipeline.start(settings, &prior.into());
        Ok(pipeline)
    }

    /// The same where it stays: ten kilobytes, of which the stack of a microcontroller has no room for many copies.
    pub fn start_in<'a>(
        place: &'a mut Option<Self>,
        settings: &Settings,
        prior: &Prior,
    ) -> Result<&'a mut Self, SettingsError> {
        let pipeline = Self::passive_in(place, settings)?;
        pipeline.idle(settings);
        pipeline.start(settings, prior);
        Ok(pipeline)
    }

    // Not within its caller, as `start`: the copies of the one shall have left the stack before those of the other.
    #[inline(never)]
    fn passive_in<'a>(place: &'a mut Option<Self>, settings: &Settings) -> Result<&'a mut Self, SettingsError> {
        let (front_end, steering) = designs(settings)?;
        Ok(Self::insert(place, front_end, steering))
    }

    #[inline(never)]
    fn insert(place: &mut Option<Self>, front_end: FrontEnd, steering: Steering) -> &mut Self {
        place.insert(Self::passive(front_end, steering))
    }

    fn passive(front_end: FrontEnd, steering: Steering) -> Self {
        Self {
            front_end,
            front_end_state: FrontEndState::default(),
            estimator: Running::Fixed(Fixed, Fixed::IDLE),
            steering,
            steering_state: SteeringState::default(),
            level_nt: 0.0,
        }
    }

    #[inline(never)]
    fn start(&mut self, settings: &Settings, prior: &Prior) {
        if settings.method != Method::None {
            self.estimator.start(prior);
        }
    }

    // Not within its caller, as `passive_in`, nor within `start`: it makes the estimator on the stack before it moves it
    // into place.
    #[inline(never)]
    fn idle(&mut self, settings: &Settings) {
        self.estimator = Running::idle(settings);
    }

    /// One epoch. Everything in the output but the after-update residual is predicted before the epoch is learnt.
    pub fn step(&mut self, epoch: &Epoch) -> Output {
        match self.front_end.step(&mut self.front_end_state, epoch) {
            Err(rejection) => {
                self.estimator.pass();
                Output { tick: epoch.tick, status: Status::Rejected(rejection), compensated: None }
            }
            Ok(observation) => {
                let (status, compensated) = self.compensate(&observation);
                Output { tick: epoch.tick, status, compensated: Some(compensated) }
            }
        }
    }

    fn compensate(&mut self, observation: &Observation) -> (Status, Compensated) {
        let row = &observation.band_passed;
        let predicted = *self.coefficients();
        let steered_nt =
            if self.steers() { self.steering.step(&mut self.steering_state, self.front_end.band_pass()) } else { 0.0 };
        let interference_nt = predicted.interference_nt(&observation.terms) + self.level_nt + f64::from(steered_nt);
        let residual_nt = row.scalar_nt - predicted.predict_nt(&row.terms);
        if observation.settled {
            self.learn(observation, &predicted);
        } else {
            self.estimator.pass();
        }
        let interference_pt = libm::round(interference_nt * 1000.0) as i32;
        let compensated = Compensated {
            interference_nt: interference_nt as f32,
            compensated_pt: observation.scalar_pt.saturating_sub(interference_pt),
            band_passed_nt: row.scalar_nt,
            residual_nt,
            residual_after_update_nt: row.scalar_nt - self.coefficients().predict_nt(&row.terms),
        };
        (if observation.settled { Status::Used } else { Status::Settling }, compensated)
    }

    /// Update the coefficients without a step in the interference. The band-pass tells the estimators nothing of the
    /// level, so that `A beta` jumps by thousands of nT when barely determined coefficients move; the interference
    /// follows the new coefficients from where it is, but for what [`Steering`] moves it by.
    fn learn(&mut self, observation: &Observation, before: &Coefficients) {
        self.estimator.update(observation);
        let change = before.change_to(self.coefficients());
        self.level_nt -= change.interference_nt(&observation.terms);
        if let Some(filter) = self.front_end_state.filter().filter(|_| self.steers()) {
            self.steering_state.change(&change, &observation.terms, filter);
        }
    }

    /// The other methods are as published, and as cheap.
    fn steers(&self) -> bool {
        matches!(self.estimator, Running::Adaptive(..))
    }

    /// The coefficients from all epochs so far.
    pub fn coefficients(&self) -> &Coefficients {
        self.estimator.coefficients()
    }

    /// The information behind the coefficients; `None` for a method that gathers none.
    pub fn information(&self) -> Option<&SquareRootInformation> {
        match &self.estimator {
            Running::Fixed(..) => None,
            Running::Rls(_, state) | Running::SaddlePoint(_, state) => Some(state.factor()),
            Running::Adaptive(_, bank) => Some(bank.information()),
        }
    }

    /// How much each member of the adaptive method's bank counts, from the one that keeps all of the calibration to the
    /// plain one; `None` for the other methods.
    pub fn probabilities(&self) -> Option<[f32; MEMBERS]> {
        match &self.estimator {
            Running::Adaptive(_, bank) => Some(bank.probabilities()),
            _ => None,
        }
    }

    /// Variance of the noise in the rows behind [`information`](Self::information), over that of the residual.
    pub fn noise_gain(&self) -> f32 {
        match &self.estimator {
            Running::Adaptive(adaptive, bank) => bank.noise_gain(adaptive),
            _ => 1.0,
        }
    }

    /// What the adaptive method says of its output for the latest epoch; `None` for the others. It is no part of
    /// [`Output`]: the log keeps ten epochs to a sector, and a replay has it to the bit.
    pub fn quality(&self) -> Option<&Quality> {
        match &self.estimator {
            Running::Adaptive(_, bank) => Some(bank.quality()),
            _ => None,
        }
    }
}

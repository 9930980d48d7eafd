//! One epoch in, one output out: the same on the body and on the desk.

use crate::epoch::{Compensated, Epoch, Output, Status};
use crate::estimate::{
    Level, LevelEstimator, LevelOutput, MEMBERS, Prior, Quality, SquareRootInformation, Steering, SteeringState,
    Written,
};
use crate::front_end::{FrontEnd, FrontEndState, Observation};
use crate::model::Coefficients;
use crate::running::RunningEstimator;
use crate::settings::{Method, Settings, SettingsError};

/// Front end and estimator, with their state.
#[derive(Clone, Debug)]
pub struct Pipeline {
    front_end: FrontEnd,
    front_end_state: FrontEndState,
    estimator: RunningEstimator,
    steering: Steering,
    steering_state: SteeringState,
    level_nt: f64,
    level: Level,
    level_estimator: LevelEstimator,
    level_output: LevelOutput,
}

/// What is computed from the settings once.
// Never inline, here and below: each of these builds kilobytes in its own stack frame, and frames that follow one
// another instead of adding up are what keeps the peak of the body's stack within its 56 KiB.
#[inline(never)]
fn designs(settings: &Settings) -> Result<(FrontEnd, Steering, Level), SettingsError> {
    settings.validate()?;
    let front_end = FrontEnd::new(settings.band_pass)?;
    Ok((front_end, Steering::new(front_end.band_pass()), Level::new(settings.band_pass)?))
}

impl Pipeline {
    /// A pipeline before its first epoch. `prior` is what a calibration has found: its coefficients, or these with the
    /// information behind them, which the adaptive method makes use of; [`Coefficients::ZERO`] when there is none.
    pub fn new(settings: &Settings, prior: impl Into<Prior>) -> Result<Self, SettingsError> {
        let mut pipeline = Self::passive(designs(settings)?);
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

    #[inline(never)]
    fn passive_in<'a>(place: &'a mut Option<Self>, settings: &Settings) -> Result<&'a mut Self, SettingsError> {
        let designs = designs(settings)?;
        Ok(Self::insert(place, designs))
    }

    #[inline(never)]
    fn insert(place: &mut Option<Self>, designs: (FrontEnd, Steering, Level)) -> &mut Self {
        place.insert(Self::passive(designs))
    }

    fn passive((front_end, steering, level): (FrontEnd, Steering, Level)) -> Self {
        Self {
            front_end,
            front_end_state: FrontEndState::default(),
            estimator: RunningEstimator::none(),
            steering,
            steering_state: SteeringState::default(),
            level_nt: 0.0,
            level,
            level_estimator: LevelEstimator::BLANK,
            level_output: LevelOutput::START,
        }
    }

    #[inline(never)]
    fn start(&mut self, settings: &Settings, prior: &Prior) {
        if settings.method != Method::None {
            self.estimator.start(prior);
            self.level_estimator.start(prior);
        }
    }

    #[inline(never)]
    fn idle(&mut self, settings: &Settings) {
        self.estimator = RunningEstimator::idle(settings);
    }

    /// One epoch. Everything in the output but the after-update residual is predicted before the epoch is learnt.
    pub fn step(&mut self, epoch: &Epoch) -> Output {
        match self.front_end.step(&mut self.front_end_state, epoch) {
            Err(rejection) => {
                self.estimator.skip();
                Output { tick: epoch.tick, status: Status::Rejected(rejection), compensated: None }
            }
            Ok(observation) => {
                let (status, compensated) = self.compensate(epoch.tick, &observation);
                Output { tick: epoch.tick, status, compensated: Some(compensated) }
            }
        }
    }

    fn compensate(&mut self, tick: u32, observation: &Observation) -> (Status, Compensated) {
        let row = &observation.band_passed;
        let predicted = *self.coefficients();
        let steered_nt = f64::from(self.steer());
        let residual_nt = row.scalar_nt - predicted.predict_nt(&row.terms);
        let followed_nt = predicted.interference_nt(&observation.terms) + self.level_nt + steered_nt;
        let interference_nt = self.levelled(tick, observation, followed_nt, residual_nt);
        if observation.settled {
            self.learn(observation, &predicted);
        } else {
            self.estimator.skip();
        }
        let compensated = Compensated {
            interference_nt: interference_nt as f32,
            compensated_pt: observation.scalar_pt.saturating_sub(libm::round(interference_nt * 1000.0) as i32),
            band_passed_nt: row.scalar_nt,
            residual_nt,
            residual_after_update_nt: row.scalar_nt - self.coefficients().predict_nt(&row.terms),
        };
        (if observation.settled { Status::Used } else { Status::Settling }, compensated)
    }

    /// The interference at its level, nT, where the bank's is `followed_nt`. Only with the adaptive method, as above.
    fn levelled(&mut self, tick: u32, observation: &Observation, followed_nt: f64, residual_nt: f32) -> f64 {
        if self.estimator.bank().is_none() {
            return followed_nt;
        }
        let before = *self.level_estimator.as_ref();
        let columns = self.level_estimator.step(&self.level, tick, observation);
        let Observation { scalar_pt, is_first, settled, .. } = *observation;
        let written = Written { columns: &columns, scalar_pt, followed_nt, residual_nt, is_first, settled };
        let interference_nt = self.level_output.step(&self.level, &before, &written);
        self.level_output.change(&before, &self.level_estimator, &columns);
        interference_nt
    }

    /// Offset of the output for this epoch, nT. Only the adaptive method is steered: the others are as published, and
    /// as cheap.
    fn steer(&mut self) -> f32 {
        if self.estimator.bank().is_none() {
            return 0.0;
        }
        self.steering.step(&mut self.steering_state, self.front_end.band_pass())
    }

    /// Update the coefficients without a step in the interference. The band-pass tells the estimators nothing of the
    /// level, so that `A beta` jumps by thousands of nT when barely determined coefficients move; the interference
    /// follows the new coefficients from where it is, but for what [`Steering`] moves it by.
    fn learn(&mut self, observation: &Observation, before: &Coefficients) {
        self.estimator.update(&observation.band_passed);
        let change = before.change_to(self.coefficients());
        self.level_nt -= change.interference_nt(&observation.terms);
        if let (Some(_), Some(filter)) = (self.estimator.bank(), self.front_end_state.filter()) {
            self.steering_state.change(&change, &observation.terms, filter);
        }
    }

    /// The coefficients from all epochs so far.
    pub fn coefficients(&self) -> &Coefficients {
        self.estimator.coefficients()
    }

    /// The information behind the coefficients; `None` for a method that gathers none.
    pub fn information(&self) -> Option<&SquareRootInformation> {
        self.estimator.information()
    }

    /// How much each member of the adaptive method's bank counts, from the one that keeps all of the calibration to the
    /// plain one; `None` for the other methods.
    pub fn probabilities(&self) -> Option<[f32; MEMBERS]> {
        self.estimator.probabilities()
    }

    /// Variance of the noise in the rows behind [`information`](Self::information), over that of the residual.
    pub fn noise_gain(&self) -> f32 {
        self.estimator.noise_gain()
    }

    /// What the adaptive method says of its output for the latest epoch; `None` for the others. It is no part of
    /// [`Output`]: the log keeps ten epochs to a sector, and a replay has it to the bit.
    pub fn quality(&self) -> Option<&Quality> {
        self.estimator.quality()
    }
}

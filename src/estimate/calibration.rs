//! Calibration from a stream of epochs, in constant memory, as the body runs it; `host-sim calibrate` gives it rows that
//! were band-passed on the desk.

use super::singular_values::singular_values;
use super::square_root_information::SquareRootInformation;
use super::{ElasticNet, Information, Level, LevelEstimator, Prior};
use crate::epoch::{Epoch, Rejection};
use crate::filter::BandPassDesign;
use crate::front_end::{FrontEnd, FrontEndState};
use crate::model::{Coefficients, Row, TERMS, TermVector};
use crate::policy::{CALIBRATION_RECENTRE_EVERY, LEAST_CALIBRATION_S};
use crate::settings::{Settings, SettingsError};

/// A calibration in progress.
#[derive(Clone, Debug)]
pub struct Calibration {
    front_end: FrontEnd,
    front_end_state: FrontEndState,
    penalty: ElasticNet,
    band_pass: BandPassDesign,
    level: Level,
    level_estimator: LevelEstimator,
    factor: SquareRootInformation,
    used_epochs: u32,
    sum_nt: f64,
    sum_squares: f64,
    unexplained: f64,
}

/// What a calibration found.
#[derive(Clone, Debug)]
pub struct CalibrationResult {
    /// The coefficients that minimise eq. (7).
    pub coefficients: Coefficients,
    /// Standard deviation of the coefficient of each scaled term, nT, for residuals that are white within the band.
    pub std_nt: TermVector,
    /// Largest over smallest singular value of the band-passed scaled terms, without penalty.
    pub condition_number: f32,
    /// The observations themselves, as a factor.
    pub information: SquareRootInformation,
    /// Root mean square of what their least-squares solution leaves of the scalar, nT.
    pub noise_nt: f64,
    /// What they say of the level, for [`LevelEstimator`]; `None` when it is not finite.
    pub level: Option<Information>,
    /// Epochs behind the result.
    pub used_epochs: u32,
    /// Standard deviation of the band-passed scalar over them, nT.
    pub std_before_nt: f64,
    /// Root mean square of what the coefficients leave of it, nT.
    pub rms_after_nt: f64,
}

/// Why a calibration has no result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CalibrationError {
    /// There are too few usable epochs.
    TooShort {
        /// How many there are.
        used_epochs: u32,
        /// How many it takes.
        needed_epochs: u32,
    },
    /// The coefficients are not finite: the body was not moved at all, or the data are of no use.
    NotFinite,
}

impl core::fmt::Display for CalibrationError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::TooShort { used_epochs, needed_epochs } => write!(
                f,
                "only {used_epochs} usable epochs after the filter has settled, {needed_epochs} are needed: \
                 record longer, with fewer gaps"
            ),
            Self::NotFinite => write!(f, "no finite coefficients: check that the body was turned on all its axes"),
        }
    }
}

impl core::error::Error for CalibrationError {}

impl Calibration {
    /// A calibration before its first epoch, with the band-pass and penalties of `settings`.
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self {
            front_end: FrontEnd::new(settings.band_pass)?,
            front_end_state: FrontEndState::default(),
            penalty: settings.penalty,
            band_pass: settings.band_pass,
            level: Level::new(settings.band_pass)?,
            level_estimator: LevelEstimator::uninformed(),
            factor: SquareRootInformation::EMPTY,
            used_epochs: 0,
            sum_nt: 0.0,
            sum_squares: 0.0,
            unexplained: 0.0,
        })
    }

    /// Take in one epoch. Whether it counts: not when rejected, nor while the filter settles.
    pub fn step(&mut self, epoch: &Epoch) -> Result<bool, Rejection> {
        let observation = self.front_end.step(&mut self.front_end_state, epoch)?;
        self.level_estimator.step(&self.level, epoch.tick, &observation);
        if observation.settled {
            self.add(&observation.band_passed);
        }
        Ok(observation.settled)
    }

    /// Take in one row that has been band-passed elsewhere, its columns and its scalar alike.
    pub fn add(&mut self, row: &Row) {
        let scalar_nt = f64::from(row.scalar_nt);
        let unexplained = f64::from(self.factor.add(row));
        self.used_epochs = self.used_epochs.saturating_add(1);
        // f64: a day of squares does not fit the 24 bits of an f32.
        self.sum_nt += scalar_nt;
        self.sum_squares += scalar_nt * scalar_nt;
        self.unexplained += unexplained * unexplained;
        if self.used_epochs.is_multiple_of(CALIBRATION_RECENTRE_EVERY) {
            self.recentre();
        }
    }

    /// Rounding errors grow with what the centre leaves of the signal: bring it to the solution so far.
    fn recentre(&mut self) {
        if let Some(coefficients) = self.penalty.ridge(&self.factor) {
            self.factor.recentre(&coefficients);
        }
    }

    /// Solve eq. (7) for all epochs so far. The calibration can go on afterwards.
    pub fn solve(&self) -> Result<CalibrationResult, CalibrationError> {
        let needed_epochs = libm::ceil(LEAST_CALIBRATION_S * self.band_pass.sample_rate_hz) as u32;
        if self.used_epochs < needed_epochs {
            return Err(CalibrationError::TooShort { used_epochs: self.used_epochs, needed_epochs });
        }
        let coefficients = self.penalty.solve(&self.factor).ok_or(CalibrationError::NotFinite)?;
        let n = f64::from(self.used_epochs);
        let misfit: f64 = self.factor.residual_vector(&coefficients).iter().map(|&rest| square(rest)).sum();
        let rest_squares = self.unexplained + misfit;
        let sigma_nt = libm::sqrt(rest_squares / (n - TERMS as f64) * self.band_pass.samples_per_independent()) as f32;
        let values = singular_values(self.factor.transposed_of_terms());
        Ok(CalibrationResult {
            coefficients,
            std_nt: self.penalty.penalised(&self.factor).unit_std() * sigma_nt,
            condition_number: values[0] / values[TERMS - 1],
            information: self.factor.clone(),
            noise_nt: libm::sqrt(self.unexplained / n),
            level: self.level_estimator.information(),
            used_epochs: self.used_epochs,
            std_before_nt: libm::sqrt((self.sum_squares / n - square_f64(self.sum_nt / n)).max(0.0)),
            rms_after_nt: libm::sqrt(rest_squares / n),
        })
    }
}

impl CalibrationResult {
    /// What a [`Pipeline`](crate::Pipeline) starts from.
    pub fn prior(&self) -> Prior {
        let information = Information::of(&self.information, self.noise_nt as f32);
        Prior { coefficients: self.coefficients, information, level: self.level }
    }
}

fn square(value: f32) -> f64 {
    square_f64(f64::from(value))
}

fn square_f64(value: f64) -> f64 {
    value * value
}

//! A calibration on the body, under the operator's hand: nothing is kept that was not accepted.

use crate::Epoch;
use crate::Settings;
use crate::SettingsError;
use crate::estimate::{Calibration, CalibrationError, CalibrationResult, Information, Prior};
use crate::model::{Coefficients, NT_PER_UNIT, TERMS};

/// What a calibration found, for a person to judge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationSummary {
    /// The coefficients that minimise eq. (7).
    pub coefficients: Coefficients,
    /// Standard deviation of each coefficient, in the units of eq. (4) as [`Coefficients::to_paper_units`]: nT, nT per
    /// nT, seconds.
    pub std: [f64; TERMS],
    /// Standard deviation of the band-passed scalar before over after compensation, on the calibration's own data.
    pub improvement_ratio: f64,
    /// Largest over smallest singular value of the scaled terms. Some thousands after turns on all axes and headings.
    pub condition_number: f32,
    /// Epochs behind the result.
    pub used_epochs: u32,
    /// Standard deviation of the band-passed scalar, nT.
    pub std_before_nt: f64,
    /// Root mean square of what the coefficients leave of it, nT.
    pub rms_after_nt: f64,
}

impl From<&CalibrationResult> for CalibrationSummary {
    fn from(result: &CalibrationResult) -> Self {
        let CalibrationResult {
            coefficients, std_nt, condition_number, used_epochs, std_before_nt, rms_after_nt, ..
        } = *result;
        Self {
            coefficients,
            std: core::array::from_fn(|i| f64::from(std_nt[i]) / NT_PER_UNIT[i]),
            improvement_ratio: std_before_nt / rms_after_nt,
            condition_number,
            used_epochs,
            std_before_nt,
            rms_after_nt,
        }
    }
}

/// Where a session stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SessionState {
    /// No calibration.
    #[default]
    Idle,
    /// One is being recorded.
    Running {
        /// Epochs seen since the start.
        epochs: u32,
        /// Those among them that count.
        used_epochs: u32,
    },
    /// A result waits to be accepted or discarded.
    Waiting,
}

/// Why the session does not do what it is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SessionError {
    /// One is being recorded already.
    Running,
    /// A result waits to be accepted or discarded.
    Waiting,
    /// None is being recorded.
    NotRunning,
    /// There is no result to accept.
    NoResult,
    /// The settings do not allow a calibration.
    Settings(SettingsError),
    /// There is no result; the session goes on recording when it was only too short.
    Calibration(CalibrationError),
}

impl core::fmt::Display for SessionError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Running => f.write_str("a calibration is running: calibrate stop or calibrate discard yes"),
            Self::Waiting => f.write_str("a result is waiting: calibrate accept yes or calibrate discard yes"),
            Self::NotRunning => f.write_str("no calibration is running: calibrate start"),
            Self::NoResult => f.write_str("no result to accept: calibrate start, turn the body, calibrate stop"),
            Self::Settings(error) => error.fmt(f),
            Self::Calibration(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SessionError {}

/// A calibration from its start to the operator's verdict. Holds about 3 kB.
#[derive(Clone, Debug, Default)]
pub struct CalibrationSession {
    phase: Phase,
}

#[derive(Clone, Debug, Default)]
// One session on the body, in static memory: the small variants may waste the space of the large one.
#[allow(clippy::large_enum_variant)]
enum Phase {
    #[default]
    Idle,
    Running {
        calibration: Calibration,
        epochs: u32,
        used_epochs: u32,
    },
    Waiting {
        summary: CalibrationSummary,
        information: Option<Information>,
    },
}

impl CalibrationSession {
    /// No calibration.
    pub const fn new() -> Self {
        Self { phase: Phase::Idle }
    }

    /// Begin, with the band-pass and penalties of `settings`.
    pub fn start(&mut self, settings: &Settings) -> Result<(), SessionError> {
        match self.phase {
            Phase::Running { .. } => Err(SessionError::Running),
            Phase::Waiting { .. } => Err(SessionError::Waiting),
            Phase::Idle => {
                let calibration = Calibration::new(settings).map_err(SessionError::Settings)?;
                self.phase = Phase::Running { calibration, epochs: 0, used_epochs: 0 };
                Ok(())
            }
        }
    }

    /// Take in every epoch of the body; nothing but a comparison when no calibration is running.
    pub fn step(&mut self, epoch: &Epoch) {
        if let Phase::Running { calibration, epochs, used_epochs } = &mut self.phase {
            *epochs = epochs.saturating_add(1);
            if calibration.step(epoch) == Ok(true) {
                *used_epochs = used_epochs.saturating_add(1);
            }
        }
    }

    /// End the recording and solve: some tens of milliseconds on the body. A recording that is too short goes on.
    pub fn stop(&mut self) -> Result<CalibrationSummary, SessionError> {
        let Phase::Running { calibration, .. } = &self.phase else {
            let waiting = matches!(self.phase, Phase::Waiting { .. });
            return Err(if waiting { SessionError::Waiting } else { SessionError::NotRunning });
        };
        match calibration.solve() {
            Ok(result) => {
                let summary = CalibrationSummary::from(&result);
                self.phase = Phase::Waiting { summary, information: result.prior().information };
                Ok(summary)
            }
            Err(error) => {
                if error == CalibrationError::NotFinite {
                    self.phase = Phase::Idle;
                }
                Err(SessionError::Calibration(error))
            }
        }
    }

    /// The coefficients of the result that waits, and the information behind them. The session is idle afterwards.
    pub fn accept(&mut self) -> Result<Prior, SessionError> {
        match &self.phase {
            Phase::Waiting { summary, information } => {
                let prior = Prior { coefficients: summary.coefficients, information: *information };
                self.phase = Phase::Idle;
                Ok(prior)
            }
            Phase::Running { .. } => Err(SessionError::Running),
            Phase::Idle => Err(SessionError::NoResult),
        }
    }

    /// Give up what is running or waiting; false when there is neither.
    pub fn discard(&mut self) -> bool {
        !matches!(core::mem::take(&mut self.phase), Phase::Idle)
    }

    /// Where it stands.
    pub fn state(&self) -> SessionState {
        match self.phase {
            Phase::Idle => SessionState::Idle,
            Phase::Running { epochs, used_epochs, .. } => SessionState::Running { epochs, used_epochs },
            Phase::Waiting { .. } => SessionState::Waiting,
        }
    }

    /// The result that waits, if one does.
    pub fn summary(&self) -> Option<&CalibrationSummary> {
        match &self.phase {
            Phase::Waiting { summary, .. } => Some(summary),
            _ => None,
        }
    }
}

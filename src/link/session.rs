//! A calibration on the body, under the operator's hand: nothing is kept that was not accepted.

use super::found::{CalibrationSummary, Found};
use super::session_error::SessionError;
use crate::Epoch;
use crate::Settings;
use crate::estimate::{Calibration, Prior};
use crate::fluxgate_calibration::FluxgateCalibration;
use crate::model::Coefficients;
use crate::sensors::fluxgate::FluxgateSettings;

/// What is calibrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The 18 coefficients.
    Terms,
    /// The axes of the fluxgate.
    Fluxgate,
}

/// Where a session stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SessionState {
    /// No calibration.
    #[default]
    Idle,
    /// One is being recorded.
    Running {
        /// What for.
        subject: Subject,
        /// Epochs seen since the start.
        epochs: u32,
        /// Those among them that count.
        used_epochs: u32,
    },
    /// A result waits to be accepted or discarded.
    Waiting,
}

/// A result that was accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
// Lives on the stack until it is stored.
#[allow(clippy::large_enum_variant)]
pub enum Accepted {
    /// The coefficients, and the information behind them.
    Terms(Prior),
    /// Settings with the axes of the fluxgate.
    Fluxgate(FluxgateSettings),
}

/// A calibration from its start to the operator's verdict, one at a time. Holds about 3 kB.
#[derive(Clone, Debug, Default)]
pub struct CalibrationSession {
    /// What the epochs are made with, since the start of the body: what was saved since then does not hold yet.
    fluxgate: FluxgateSettings,
    phase: Phase,
}

#[derive(Clone, Debug, Default)]
// One session on the body, in static memory: the small variants may waste the space of the large one.
#[allow(clippy::large_enum_variant)]
enum Phase {
    #[default]
    Idle,
    Running {
        recording: Recording,
        epochs: u32,
        used_epochs: u32,
    },
    Waiting {
        found: Found,
        prior: Prior,
    },
}

#[derive(Clone, Debug)]
// As above.
#[allow(clippy::large_enum_variant)]
enum Recording {
    Terms(Calibration),
    Fluxgate(FluxgateCalibration),
}

impl Recording {
    /// What was found; of the 18 coefficients, also what a pipeline starts from.
    fn solve(&self) -> Result<(Found, Prior), SessionError> {
        match self {
            Self::Terms(calibration) => {
                let result = calibration.solve().map_err(SessionError::Calibration)?;
                Ok((Found::Terms(CalibrationSummary::from(&result)), result.prior()))
            }
            Self::Fluxgate(calibration) => {
                let result = calibration.solve().map_err(SessionError::Fluxgate)?;
                Ok((Found::Fluxgate(result), Prior::from(Coefficients::ZERO)))
            }
        }
    }

    fn subject(&self) -> Subject {
        match self {
            Self::Terms(_) => Subject::Terms,
            Self::Fluxgate(_) => Subject::Fluxgate,
        }
    }
}

impl CalibrationSession {
    /// No calibration; `fluxgate` is what the epochs are made with.
    pub const fn new(fluxgate: FluxgateSettings) -> Self {
        Self { fluxgate, phase: Phase::Idle }
    }

    /// Begin, with the band-pass and penalties of `settings`.
    pub fn start(&mut self, settings: &Settings) -> Result<(), SessionError> {
        self.check_idle()?;
        self.run(Recording::Terms(Calibration::new(settings).map_err(SessionError::Settings)?));
        Ok(())
    }

    /// Begin with the axes of the fluxgate.
    pub fn start_fluxgate(&mut self) -> Result<(), SessionError> {
        self.check_idle()?;
        self.run(Recording::Fluxgate(FluxgateCalibration::new(&self.fluxgate).map_err(SessionError::Settings)?));
        Ok(())
    }

    fn check_idle(&self) -> Result<(), SessionError> {
        match self.phase {
            Phase::Running { .. } => Err(SessionError::Running),
            Phase::Waiting { .. } => Err(SessionError::Waiting),
            Phase::Idle => Ok(()),
        }
    }

    fn run(&mut self, recording: Recording) {
        self.phase = Phase::Running { recording, epochs: 0, used_epochs: 0 };
    }

    /// Take in every epoch of the body; nothing but a comparison when no calibration is running.
    pub fn step(&mut self, epoch: &Epoch) {
        if let Phase::Running { recording, epochs, used_epochs } = &mut self.phase {
            *epochs = epochs.saturating_add(1);
            let is_used = match recording {
                Recording::Terms(calibration) => calibration.step(epoch) == Ok(true),
                Recording::Fluxgate(calibration) => calibration.step(epoch),
            };
            if is_used {
                *used_epochs = used_epochs.saturating_add(1);
            }
        }
    }

    /// End the recording and solve: some tens of milliseconds on the body. A recording that lacks something goes on.
    pub fn stop(&mut self) -> Result<Found, SessionError> {
        let Phase::Running { recording, .. } = &self.phase else {
            let waiting = matches!(self.phase, Phase::Waiting { .. });
            return Err(if waiting { SessionError::Waiting } else { SessionError::NotRunning });
        };
        let solved = recording.solve();
        match solved {
            Ok((found, prior)) => self.phase = Phase::Waiting { found, prior },
            Err(error) if error.goes_on() => {}
            Err(_) => self.phase = Phase::Idle,
        }
        solved.map(|(found, _)| found)
    }

    /// The result that waits. The session is idle afterwards.
    pub fn accept(&mut self) -> Result<Accepted, SessionError> {
        let accepted = match &self.phase {
            Phase::Waiting { found: Found::Terms(_), prior } => Accepted::Terms(*prior),
            Phase::Waiting { found: Found::Fluxgate(result), .. } => Accepted::Fluxgate(result.settings),
            Phase::Running { .. } => return Err(SessionError::Running),
            Phase::Idle => return Err(SessionError::NoResult),
        };
        self.phase = Phase::Idle;
        Ok(accepted)
    }

    /// Give up what is running or waiting; false when there is neither.
    pub fn discard(&mut self) -> bool {
        !matches!(core::mem::take(&mut self.phase), Phase::Idle)
    }

    /// Where it stands.
    pub fn state(&self) -> SessionState {
        match &self.phase {
            Phase::Idle => SessionState::Idle,
            Phase::Running { recording, epochs, used_epochs } => {
                SessionState::Running { subject: recording.subject(), epochs: *epochs, used_epochs: *used_epochs }
            }
            Phase::Waiting { .. } => SessionState::Waiting,
        }
    }

    /// The result that waits, if one does.
    pub fn found(&self) -> Option<&Found> {
        match &self.phase {
            Phase::Waiting { found, .. } => Some(found),
            _ => None,
        }
    }
}

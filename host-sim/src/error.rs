//! What can go wrong in a command, and the exit code that tells a script whose fault it is.

use crate::coefficients_file::CoefficientsError;
#[cfg(unix)]
use crate::emulator::EmulatorError;
use crate::output::OutputError;
use crate::recording::RecordingError;
use towmag::SettingsError;

/// Why a command failed. Its display is one line: what, where, what to do.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    /// A recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A coefficients file cannot be read.
    #[error(transparent)]
    Coefficients(#[from] CoefficientsError),
    /// A file cannot be imported.
    #[error(transparent)]
    Import(#[from] towmag_import::ImportError),
    /// A setting is out of its range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The recording is readable, but not enough for what was asked.
    #[error("{0}")]
    NotEnough(String),
    /// An effect is not asked for as it must be.
    #[error("--effect {0}")]
    Effect(#[from] crate::effects::RequestError),
    /// What was asked for cannot be done as asked.
    #[error("{0}")]
    Usage(String),
    /// A trial cannot be held.
    #[error(transparent)]
    Trial(#[from] towmag_trial::TrialError),
    /// The emulated body failed, or is not the same as its replay.
    #[cfg(unix)]
    #[error(transparent)]
    Emulator(Box<EmulatorError>),
    /// A result cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A table of a result cannot be written.
    #[error(transparent)]
    Table(#[from] csv::Error),
    /// The page cannot be put together.
    #[error("report.html cannot be made: {0}")]
    Page(#[from] std::io::Error),
    /// A file cannot be exported.
    #[error(transparent)]
    Export(#[from] towmag_export::ExportError),
    /// Recordings cannot be surveyed as asked.
    #[error(transparent)]
    Navigation(#[from] towmag_survey::navigation::NavigationError),
    /// A card cannot be prepared or tried.
    #[error(transparent)]
    Card(#[from] towmag_card::CardError),
    /// The live page cannot be served.
    #[error(transparent)]
    Live(#[from] towmag_live::LiveError),
    /// A port cannot be opened, or is gone.
    #[error("{port}: {source}")]
    Port {
        /// As the user gave it.
        port: String,
        /// The system's own words.
        source: std::io::Error,
    },
}

#[cfg(unix)]
impl From<EmulatorError> for HostError {
    fn from(error: EmulatorError) -> Self {
        match error {
            EmulatorError::Recording(error) => error.into(),
            EmulatorError::Settings(error) => error.into(),
            error => Self::Emulator(Box::new(error)),
        }
    }
}

impl HostError {
    /// 2 for bad usage or bad input, 1 for work that failed.
    pub fn exit_code(&self) -> u8 {
        let users_fault = match self {
            Self::Recording(error) => error.is_bad_input(),
            Self::Import(_)
            | Self::Coefficients(_)
            | Self::Settings(_)
            | Self::NotEnough(_)
            | Self::Effect(_)
            | Self::Navigation(_)
            | Self::Usage(_) => true,
            Self::Trial(error) => error.is_bad_input(),
            Self::Output(error) => error.is_bad_usage(),
            Self::Export(error) => error.is_bad_input(),
            Self::Live(error) => error.is_bad_usage(),
            Self::Card(error) => error.is_bad_usage(),
            #[cfg(unix)]
            Self::Emulator(error) => error.is_bad_usage(),
            Self::Table(_) | Self::Page(_) | Self::Port { .. } => false,
        };
        if users_fault { 2 } else { 1 }
    }
}

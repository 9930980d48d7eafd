//! What a survey is told beside its recordings.

use crate::level::Calibration;
use crate::navigation::NavigationOptions;

/// Settings of a survey.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveyOptions {
    /// What positions mean.
    pub navigation: NavigationOptions,
    /// So many false contacts an hour the threshold allows.
    pub false_alarms_per_hour: f64,
    /// What an earlier calibration of the body has found.
    pub calibration: Option<Calibration>,
}

impl Default for SurveyOptions {
    /// One false contact in two hours of noise: pieces of strong iron and what compensation leaves in turns make some 0.3 an hour more
    /// (tuning seeds 1 to 60 of the trial), and both together must stay below one, and below twice what is stated.
    fn default() -> Self {
        Self { navigation: NavigationOptions::default(), false_alarms_per_hour: 0.5, calibration: None }
    }
}

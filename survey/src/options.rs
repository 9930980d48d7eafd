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
    fn default() -> Self {
        Self { navigation: NavigationOptions::default(), false_alarms_per_hour: 1.0, calibration: None }
    }
}

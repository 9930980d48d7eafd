//! What a survey is told beside its recordings.

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

/// Coefficients of the body in the units of eq. (4), with their standard deviations.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// 3 permanent (nT), 6 induced (nT/nT), 9 eddy (s).
    pub coefficients: [f64; 18],
    /// In the same units; 0 where nothing is known of it.
    pub std: [f64; 18],
}

impl Default for SurveyOptions {
    fn default() -> Self {
        Self { navigation: NavigationOptions::default(), false_alarms_per_hour: 1.0, calibration: None }
    }
}

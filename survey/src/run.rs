//! All of a survey: navigation, the field, contacts.

use crate::navigation::{Navigated, NavigationError, diurnal, navigate};
use crate::options::SurveyOptions;
use crate::result::{Survey, SurveyedTow};
use crate::tow::Tow;

/// Why there is no survey.
#[derive(Debug, thiserror::Error)]
pub enum SurveyError {
    /// Positions or base station are not as asked for.
    #[error(transparent)]
    Navigation(#[from] NavigationError),
}

/// Survey recordings of one body.
///
/// # Errors
///
/// When what was asked for needs a column that a recording does not have.
// TEMPORARY, until level and contacts are joined: the field is the scalar as read less the diurnal variation, its anomaly the
// field less its median, no standard deviation is known, and there are no contacts.
pub fn survey(tows: &[Tow], options: &SurveyOptions) -> Result<Survey, SurveyError> {
    let navigation = navigate(tows, &options.navigation)?;
    let diurnal = diurnal(tows);
    let tows = tows.iter().zip(&navigation.tows).zip(&diurnal.variation_nt);
    let tows = tows.map(|((tow, navigated), variation_nt)| as_read(tow, navigated, variation_nt.as_deref())).collect();
    Ok(Survey {
        tows,
        contacts: Vec::new(),
        false_alarms_per_hour: options.false_alarms_per_hour,
        noise_floor_nt: f64::NAN,
        smallest_moment_am2: None,
        coefficients: options.calibration.as_ref().map_or([0.0; 18], |calibration| calibration.coefficients),
        coefficient_std: options.calibration.as_ref().map_or([0.0; 18], |calibration| calibration.std),
        grid: navigation.grid,
    })
}

fn as_read(tow: &Tow, navigated: &Navigated, variation_nt: Option<&[f64]>) -> SurveyedTow {
    let usable = |row: usize| if tow.is_usable[row] { tow.scalar_nt[row] } else { f64::NAN };
    let field_nt: Vec<f64> =
        (0..tow.len()).map(|row| usable(row) - variation_nt.map_or(0.0, |variation_nt| variation_nt[row])).collect();
    let mut known: Vec<f64> = field_nt.iter().copied().filter(|field| field.is_finite()).collect();
    known.sort_by(f64::total_cmp);
    let median_nt = known.get(known.len() / 2).copied().unwrap_or(f64::NAN);
    SurveyedTow {
        name: tow.name.clone(),
        time_s: tow.time_s.clone(),
        is_valid: field_nt.iter().map(|field| field.is_finite()).collect(),
        anomaly_nt: field_nt.iter().map(|field| field - median_nt).collect(),
        field_std_nt: vec![f64::NAN; tow.len()],
        anomaly_std_nt: vec![f64::NAN; tow.len()],
        field_nt,
        track: navigated.track.clone(),
        line: navigated.line.clone(),
        altitude_m: tow.altitude_m.clone(),
        smallest_moment_am2: Vec::new(),
        fixes: navigated.fixes,
        dropped_fixes: navigated.dropped_fixes,
        has_diurnal: variation_nt.is_some(),
    }
}

//! `report.html` of a survey.

use towmag_survey::Survey;

use super::tows::Read;
use crate::error::HostError;
use crate::output::OutputDir;
use crate::recording::utc_offset_s;
use crate::report::{SurveyReport, render_survey};

pub(super) fn write(output: &OutputDir, read: &Read, survey: &Survey, warnings: &[String]) -> Result<(), HostError> {
    let offset_s = |tow: &towmag_survey::Tow| utc_offset_s(&tow.time_s, tow.utc_s.as_deref());
    let utc_offset_s: Vec<Option<f64>> = read.tows.iter().map(offset_s).collect();
    let facts = facts(survey);
    let report = SurveyReport { survey, utc_offset_s: &utc_offset_s, warnings, facts: &facts };
    output.write("report.html", render_survey(&report)?)?;
    Ok(())
}

/// How it was done, for whoever doubts a figure.
fn facts(survey: &Survey) -> Vec<(String, String)> {
    let names = survey.tows.iter().map(|tow| tow.name.as_str()).collect::<Vec<_>>().join(", ");
    let rate = format!("{} an hour", survey.false_alarms_per_hour);
    let mut facts = vec![("Recordings".into(), names), ("False contacts that the threshold stands for".into(), rate)];
    if let Some(grid) = &survey.grid {
        facts.push(("Eastings and northings".into(), format!("EPSG:{}", grid.epsg())));
    }
    facts
}

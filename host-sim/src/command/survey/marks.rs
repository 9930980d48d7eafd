//! The contacts of a recording as marks on the page of another command.

use towmag_survey::navigation::navigate;
use towmag_survey::{Contact, SurveyOptions, survey};

use super::tows::read;
use crate::recording::Input;
use crate::report::{Mark, ReportData};
use crate::text::number::short;

/// A recording with more rows than four hours have is not held in memory for a few marks.
const MOST_ROWS: u64 = 144_000;
/// Less than a minute tells no contact from noise.
const LEAST_ROWS: u64 = 600;

/// Mark on the page of `recording` what a survey of it finds. It adds to the page alone: where no survey is possible, nothing is
/// marked.
pub(in crate::command) fn mark_contacts(report: &mut ReportData, recording: &Input, rows: u64) {
    if !(LEAST_ROWS..=MOST_ROWS).contains(&rows) {
        return;
    }
    let Ok(read) = read(vec![recording.clone()]) else { return };
    let options = SurveyOptions::default();
    let Ok(navigation) = navigate(&read.tows, &options.navigation) else { return };
    let survey = survey(&read.tows, &navigation, &options);
    if survey.contacts.is_empty() {
        return;
    }
    report.marks.extend(survey.contacts.iter().map(mark));
    let told: Vec<String> = survey.contacts.iter().map(told).collect();
    let found = format!("Marked by number: what host-sim survey finds here: {}.", told.join(", "));
    report.marks_note =
        Some(report.marks_note.take().map_or_else(|| found.clone(), |hidden| format!("{found} {hidden}")));
}

fn mark(contact: &Contact) -> Mark {
    Mark { time_s: contact.time_s, label: contact.number.to_string() }
}

fn told(contact: &Contact) -> String {
    let sign = if contact.peak_nt > 0.0 { "+" } else { "" };
    format!("{} at {} s ({sign}{} nT)", contact.number, short(contact.time_s), short(contact.peak_nt))
}

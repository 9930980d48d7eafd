//! The page of a survey: what to dive for, where it is, how sure that is, and what would have been found.

mod colours;
mod contacts;
mod courses;
mod input;
mod map;
mod profile;

use askama::Template;
use towmag_survey::Survey;

use contacts::{Card, Row};
use courses::Course;
pub use input::SurveyReport;
use map::Map;

use super::frame::PageFrame;
use crate::text::number::{short, three_digits};
use crate::text::survey::{self as words, NO_SMALLEST};

/// Rows in an hour at 10 Hz.
const ROWS_AN_HOUR: f64 = 36_000.0;

/// `report` as one self-contained HTML page.
///
/// # Errors
///
/// When the template cannot be filled; what it is filled with has no way to fail today.
pub fn render_survey(report: &SurveyReport<'_>) -> std::io::Result<String> {
    let survey = report.survey;
    let names: Vec<&str> = survey.tows.iter().map(|tow| tow.name.as_str()).collect();
    let recording = match names[..] {
        [first, _, _, _, ..] => format!("{first} and {} more", names.len() - 1),
        _ => names.join(", "),
    };
    let page = Page {
        frame: PageFrame {
            title: &format!("Survey: {recording}"),
            kind: "Survey",
            recording: &recording,
            headline: words::headline(survey).into(),
            headline_class: "",
            warnings: report.warnings,
            facts: report.facts,
            plotly_js: String::new(),
        },
        tiles: tiles(survey),
        contacts: contacts::rows(report),
        cards: contacts::cards(report),
        has_place: survey.contacts.iter().any(|contact| contact.place.is_some()),
        has_moment: survey.contacts.iter().any(|contact| contact.moment_am2.is_some()),
        has_unsure: survey.contacts.iter().any(|contact| !words::is_sure(contact)),
        time_title: contacts::time_title(report),
        profile_note: profile::note(survey),
        map: map::map(survey),
        courses: courses::courses(report),
        rate: short(survey.false_alarms_per_hour),
    };
    page.render().map_err(std::io::Error::other)
}

#[derive(Template)]
#[template(path = "survey.html")]
struct Page<'a> {
    frame: PageFrame<'a>,
    tiles: Vec<(&'static str, String)>,
    contacts: Vec<Row>,
    cards: Vec<Card>,
    has_place: bool,
    has_moment: bool,
    has_unsure: bool,
    time_title: &'static str,
    profile_note: &'static str,
    map: Option<Map>,
    courses: Vec<Course>,
    rate: String,
}

/// The figures beside the answer.
fn tiles(survey: &Survey) -> Vec<(&'static str, String)> {
    let rows: usize = survey.tows.iter().map(|tow| tow.is_valid.iter().filter(|valid| **valid).count()).sum();
    let hours = rows as f64 / ROWS_AN_HOUR;
    let mut tiles = vec![("Noise floor", format!("{} nT", words::two_digits(survey.noise_floor_nt)))];
    let smallest =
        |moment| format!("{} A m² ({} of iron)", words::two_digits(moment), words::kilograms([moment, moment]));
    let moment = survey.smallest_moment_am2.filter(|moment| moment.is_finite());
    tiles.push(("Smallest moment found", moment.map_or_else(|| NO_SMALLEST.into(), smallest)));
    tiles.push(("False alarms to expect", words::two_digits(survey.false_alarms_per_hour * hours)));
    tiles.push(("Searched", searched(survey, hours)));
    tiles
}

/// How long, and how far where that is known.
fn searched(survey: &Survey, hours: f64) -> String {
    let length_m = |along: &Vec<f64>| {
        let known = || along.iter().filter(|along| along.is_finite());
        Some(known().next_back()? - known().next()?)
    };
    let length_m: f64 = survey.tows.iter().filter_map(|tow| length_m(&tow.track.as_ref()?.along_m)).sum();
    let minutes = format!("{:.0} min", 60.0 * hours);
    if length_m > 0.0 { format!("{minutes}, {} km", three_digits(1e-3 * length_m)) } else { minutes }
}

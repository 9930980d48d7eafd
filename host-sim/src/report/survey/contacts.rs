//! The contacts: a line each in the table, a card each with its profile.

use towmag_survey::{Contact, Estimate};

use super::input::SurveyReport;
use super::profile::profile;
use crate::report::svg::Plot;
use crate::text::clock;
use crate::text::number::{group, three_digits};
use crate::text::survey as words;

/// A line of the table.
pub(super) struct Row {
    pub(super) number: usize,
    pub(super) is_first: bool,
    pub(super) is_sure: bool,
    /// Latitude and longitude.
    pub(super) place: Option<[String; 2]>,
    pub(super) iron: String,
    /// With its unit and interval; nothing where it is not known.
    pub(super) moment: String,
    pub(super) distance: String,
    /// Its interval.
    pub(super) between: String,
    pub(super) peak: String,
    pub(super) snr: String,
    pub(super) false_alarm: String,
    pub(super) passes: String,
    pub(super) line: String,
    pub(super) time: String,
}

/// All that is known of one.
pub(super) struct Card {
    pub(super) number: usize,
    pub(super) is_sure: bool,
    pub(super) title: String,
    pub(super) profile: Option<Plot>,
    pub(super) facts: Vec<(&'static str, String)>,
}

const UNKNOWN: &str = "–";

/// What to dive for comes first.
pub(super) fn rows(report: &SurveyReport<'_>) -> Vec<Row> {
    let row = |(place, contact): (usize, &Contact)| Row {
        number: contact.number,
        is_first: place == 0,
        is_sure: words::is_sure(contact),
        place: contact.place.as_ref().map(words::latitude_longitude),
        iron: contact.moment_am2.as_ref().map_or(UNKNOWN.into(), words::iron),
        moment: contact.moment_am2.as_ref().map_or(String::new(), moment),
        distance: contact.distance_m.as_ref().map_or(UNKNOWN.into(), |distance| words::two_digits(distance.value)),
        between: contact.distance_m.as_ref().map_or(String::new(), words::interval),
        peak: words::signed(contact.peak_nt),
        snr: format!("{:.0}", contact.snr),
        false_alarm: words::chance(contact.false_alarm_probability),
        passes: format!("{} pass{}", contact.passes, if contact.passes == 1 { "" } else { "es" }),
        line: line(contact),
        time: time(report, contact),
    };
    words::dive_order(&report.survey.contacts).into_iter().enumerate().map(row).collect()
}

/// In the same order.
pub(super) fn cards(report: &SurveyReport<'_>) -> Vec<Card> {
    let card = |contact: &Contact| Card {
        number: contact.number,
        is_sure: words::is_sure(contact),
        title: contact.place.as_ref().map_or_else(|| time(report, contact), words::position),
        profile: report.survey.tows.get(contact.tow).and_then(|tow| profile(contact, tow)),
        facts: facts(report, contact),
    };
    words::dive_order(&report.survey.contacts).into_iter().map(card).collect()
}

/// What the column of times is of.
pub(super) fn time_title(report: &SurveyReport<'_>) -> &'static str {
    let is_clock = |contact: &Contact| report.offset_s(contact.tow).is_some();
    if report.survey.contacts.iter().any(is_clock) { "Time, UTC" } else { "Time, s" }
}

fn time(report: &SurveyReport<'_>, contact: &Contact) -> String {
    match report.offset_s(contact.tow) {
        Some(offset_s) => clock::seconds(contact.time_s + offset_s),
        None => format!("{:.1} s", contact.time_s),
    }
}

fn line(contact: &Contact) -> String {
    if contact.line.is_empty() { UNKNOWN.into() } else { contact.line.to_string() }
}

fn facts(report: &SurveyReport<'_>, contact: &Contact) -> Vec<(&'static str, String)> {
    let mut facts = Vec::new();
    if let (Some(moment), Some(distance)) = (&contact.moment_am2, &contact.distance_m) {
        facts.push(("Iron", words::iron(moment)));
        facts.push(("Distance from the sensor", format!("{} m", words::with_interval(distance))));
        facts.push(("Moment", self::moment(moment)));
    }
    facts.extend(altitude_m(report, contact).map(|m| ("Sensor above the bottom", format!("{} m", three_digits(m)))));
    facts.push((
        "Peak",
        format!("{} nT, {} s wide", words::signed(contact.peak_nt), words::two_digits(contact.width_s)),
    ));
    facts.push(("SNR, chance of a false alarm", sureness(contact)));
    facts.push(("Line, passes", format!("{}, {}", line(contact), contact.passes)));
    // Of several days, and of several files, the time alone says little.
    if let Some(tow) = report.survey.tows.get(contact.tow).filter(|_| report.survey.tows.len() > 1) {
        facts.push(("Recording", tow.name.clone()));
    }
    facts.extend(report.offset_s(contact.tow).map(|offset_s| ("Date", clock::date(contact.time_s + offset_s))));
    facts.push((if report.offset_s(contact.tow).is_some() { "Time, UTC" } else { "Time" }, time(report, contact)));
    if let Some(place) = &contact.place {
        let [east, north] = [place.easting_m, place.northing_m].map(metres);
        facts.push(("Easting, northing", format!("{east}, {north} m")));
    }
    facts
}

fn moment(moment_am2: &Estimate) -> String {
    format!("{} A m²", words::with_interval(moment_am2))
}

fn sureness(contact: &Contact) -> String {
    format!("{:.0}, {}", contact.snr, words::chance(contact.false_alarm_probability))
}

/// To a tenth of a metre, with commas.
fn metres(value: f64) -> String {
    let tenths = (10.0 * value).round() as i64;
    let sign = if tenths < 0 { "−" } else { "" };
    format!("{sign}{}.{}", group((tenths / 10).abs()), (tenths % 10).abs())
}

/// At the closest approach.
fn altitude_m(report: &SurveyReport<'_>, contact: &Contact) -> Option<f64> {
    let tow = report.survey.tows.get(contact.tow)?;
    let row = tow.time_s.iter().position(|time_s| *time_s >= contact.time_s)?;
    tow.altitude_m.as_ref()?.get(row).copied().filter(|altitude_m| altitude_m.is_finite())
}

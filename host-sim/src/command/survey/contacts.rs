//! `contacts.csv` and `contacts.geojson`: one row, one feature an object.

use geojson::Geometry;
use serde_json::Value;
use towmag_survey::{Contact, Estimate, Survey};

use super::digits::{fixed, significant};
use super::geojson::{feature, place, text};
use super::levelled::RECORDING;
use crate::error::HostError;
use crate::output::OutputDir;

/// A field of a contact.
enum Field {
    Number(String),
    Text(String),
}

/// Write both.
pub(super) fn write(output: &OutputDir, survey: &Survey) -> Result<(), HostError> {
    let mut writer = csv::Writer::from_writer(output.create_file("contacts.csv")?);
    let names = fields(survey, None);
    writer.write_record(names.iter().map(|(name, _)| name))?;
    for contact in &survey.contacts {
        writer.write_record(fields(survey, Some(contact)).iter().map(|(_, field)| field.text()))?;
    }
    let file = writer.into_inner().map_err(|error| csv::Error::from(std::io::Error::other(error.to_string())))?;
    file.finish()?;
    let features = survey.contacts.iter().map(|contact| {
        let there = contact.place.and_then(|found| place(found.longitude_deg, found.latitude_deg));
        let properties = fields(survey, Some(contact)).into_iter().map(|(name, field)| (name, field.value()));
        feature(there.map(Geometry::new_point), properties.collect())
    });
    Ok(output.write("contacts.geojson", text(features.collect()))?)
}

impl Field {
    fn text(&self) -> &str {
        match self {
            Self::Number(text) | Self::Text(text) => text,
        }
    }

    fn value(&self) -> Value {
        match self {
            Self::Number(text) => serde_json::from_str(text).unwrap_or(Value::Null),
            Self::Text(text) => text.as_str().into(),
        }
    }
}

/// Names and values in the order of the contract; of no contact the names alone count.
fn fields(survey: &Survey, contact: Option<&Contact>) -> Vec<(&'static str, Field)> {
    let number = |text: fn(f64) -> String, of: fn(&Contact) -> Option<f64>| {
        Field::Number(contact.and_then(of).map(text).unwrap_or_default())
    };
    let whole =
        |of: fn(&Contact) -> usize| Field::Number(contact.map(|contact| of(contact).to_string()).unwrap_or_default());
    let degrees: fn(f64) -> String = |value| fixed(value, 8);
    let metres: fn(f64) -> String = |value| fixed(value, 3);
    let four: fn(f64) -> String = |value| significant(value, 4);
    let name = || contact.and_then(|contact| survey.tows.get(contact.tow)).map(|tow| tow.name.clone());
    let recording = (survey.tows.len() > 1).then(|| (RECORDING, Field::Text(name().unwrap_or_default())));
    let line = contact.map(|contact| contact.line.to_string()).unwrap_or_default();
    let own = [
        ("contact", whole(|contact| contact.number)),
        ("passes", whole(|contact| contact.passes)),
        ("time_s", number(metres, |contact| Some(contact.time_s))),
        ("line", Field::Text(line)),
        ("latitude_deg", number(degrees, |contact| Some(contact.place?.latitude_deg))),
        ("longitude_deg", number(degrees, |contact| Some(contact.place?.longitude_deg))),
        ("easting_m", number(metres, |contact| Some(contact.place?.easting_m))),
        ("northing_m", number(metres, |contact| Some(contact.place?.northing_m))),
        ("peak_nT", number(four, |contact| Some(contact.peak_nt))),
        ("width_s", number(four, |contact| Some(contact.width_s))),
        ("snr", number(four, |contact| Some(contact.snr))),
        ("false_alarm_probability", number(four, |contact| Some(contact.false_alarm_probability))),
        ("distance_m", number(four, |contact| value(contact.distance_m))),
        ("distance_low_m", number(four, |contact| low(contact.distance_m))),
        ("distance_high_m", number(four, |contact| high(contact.distance_m))),
        ("moment_Am2", number(four, |contact| value(contact.moment_am2))),
        ("moment_low_Am2", number(four, |contact| low(contact.moment_am2))),
        ("moment_high_Am2", number(four, |contact| high(contact.moment_am2))),
    ];
    recording.into_iter().chain(own).collect()
}

fn value(estimate: Option<Estimate>) -> Option<f64> {
    estimate.map(|estimate| estimate.value)
}

fn low(estimate: Option<Estimate>) -> Option<f64> {
    estimate.map(|estimate| estimate.low)
}

fn high(estimate: Option<Estimate>) -> Option<f64> {
    estimate.map(|estimate| estimate.high)
}

//! What drives a rest that has no name, in words for who tows the body: what it goes with, how much of it is understood, and what would
//! settle it.

use super::diagnosis::{closed, percent, sensor};
use crate::diagnosis::{Description, DriverForm};

/// Of a rest that no verdict speaks of.
pub(crate) fn small() -> String {
    "A small rest, which nothing hangs on.".into()
}

/// A sentence or three.
pub(crate) fn text(found: &Description) -> String {
    let Some(first) = found.drivers.first() else { return small() };
    let mut sentences = vec![format!(
        "What is left of the {} {} ({}).",
        sensor(found.channel),
        goes_with(&first.input, found.form),
        percent(first.probability)
    )];
    if let Some(delay_s) = found.delay_s {
        let side = if delay_s > 0.0 { "later" } else { "earlier" };
        sentences.push(format!("It is {:.1} s {side} than that.", delay_s.abs()));
    }
    if found.is_in_steps {
        sentences
            .push("It moves by a step whenever the body goes over far to one side, and stays there in between.".into());
    }
    if let Some(share) = &found.gap_closed {
        let shape = if found.is_closed_form { "A short formula" } else { "A fitted shape" };
        sentences.push(format!("{shape} of it closes {} of the rest and is proposed as an effect.", closed(share)));
    }
    if let Some(known) = found.looks_like {
        sentences.push(format!("It looks like a known effect that is not named: {known}."));
    }
    if let Some(like) = found.matched.as_ref().filter(|like| like.p_value <= 0.01) {
        sentences.push(format!("Its course looks like {} (correlation {:.2}).", like.column, like.correlation));
    }
    sentences.push(settles(&first.input, found.has_tilt).into());
    sentences.join(" ")
}

/// What it does with an input.
pub(crate) fn goes_with(input: &str, form: Option<DriverForm>) -> String {
    let what = what(input);
    match (input, form) {
        ("none", _) => "goes with nothing that was recorded".into(),
        ("time_periodic", _) => "comes and goes in a steady rhythm of its own".into(),
        ("time_irregular", _) => "comes and goes in time, with nothing that was recorded".into(),
        (_, Some(DriverForm::Delay)) => format!("is a reading that is late or early by {what}"),
        (_, Some(DriverForm::Multiplicative)) => format!("is a reading that {what} makes larger or smaller"),
        (_, Some(DriverForm::Variance)) => format!("is noise that grows and shrinks with {what}"),
        _ => format!("goes with {what}"),
    }
}

/// An input in words.
pub(crate) fn what(input: &str) -> &str {
    match input {
        "attitude" => "the attitude of the body",
        "attitude_rate" => "how fast the body turns",
        "attitude_history" => "how the body lay some seconds before",
        "depth" => "the depth",
        "depth_rate" => "the speed of the heave",
        "temperature" => "the temperature",
        "reading" => "the reading itself",
        "time_periodic" => "a rhythm of its own",
        "time_irregular" => "time alone",
        "none" => "nothing recorded",
        column => column,
    }
}

/// The sensor, column or manoeuvre that would settle it; `has_tilt` where roll and pitch are recorded already.
fn settles(input: &str, has_tilt: bool) -> &'static str {
    match input {
        "attitude" => {
            "To settle it, turn the body slowly through all headings, pitch and roll it, and look for iron or a sensor's axis."
        }
        "attitude_rate" => {
            "To settle it, repeat one manoeuvre at half and at double the speed, and look for loose or conducting parts."
        }
        "attitude_history" if !has_tilt => {
            "To settle it, record roll and pitch too, reach the same attitude from both sides and wait there, and look for loose parts and soft iron."
        }
        "attitude_history" => {
            "To settle it, reach the same attitude from both sides and wait there, and look for loose parts and soft iron."
        }
        "depth" | "depth_rate" => {
            "To settle it, change the depth on a straight course in calm water, and look at the depth sensor's cable."
        }
        "temperature" => "To settle it, let the body cool and warm at rest with its temperature recorded.",
        "reading" => {
            "To settle it, look at the scalar sensor's own settings, its filter and its counter, and log its status."
        }
        "time_periodic" => "To settle it, switch off one load after another at rest until the rhythm is gone.",
        "time_irregular" if !has_tilt => {
            "To settle it, log roll and pitch, the currents of the loads and the events of the tow, and record again."
        }
        "time_irregular" => "To settle it, log the currents of the loads and the events of the tow, and record again.",
        "none" => "To settle it, record at rest with one part removed or switched off at a time.",
        _ => "To settle it, change that alone and record again.",
    }
}

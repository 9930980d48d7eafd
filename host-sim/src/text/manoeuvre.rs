//! What to do next, in sentences.

use crate::diagnosis::{ManoeuvreKind, NextManoeuvre};

/// What to do and why.
pub fn next(next: &NextManoeuvre) -> String {
    let mut text = what_and_why(next.kind).to_string();
    if next.repeats_event {
        text.push_str(" Half way, repeat what may have caused the change: a load, a knock, a restart.");
    }
    if next.is_enough {
        return text;
    }
    format!(
        "No manoeuvre that was tried tells them apart in an hour, for what they add is small or alike in all of them. \
         The best of them: {text}"
    )
}

fn what_and_why(kind: ManoeuvreKind) -> &'static str {
    match kind {
        ManoeuvreKind::Shake => {
            "Shake the body at about 1 Hz by two degrees, on four headings at right angles; by hand on shore \
             will do. Only fast motion shows in which way a reading is late."
        }
        ManoeuvreKind::FourHeadings => {
            "Sail four headings at right angles, and on each rock the body by 7 degrees in roll, then in \
             pitch, then in yaw, 7 s to a period. What the attitude does must be seen about all three axes."
        }
        ManoeuvreKind::EightHeadings => {
            "Sail eight headings, 45 degrees apart, and on each rock the body by 7 degrees in roll, then in \
             pitch, then in yaw, 7 s to a period. Errors that go with the direction of the field differ only \
             over many directions."
        }
        ManoeuvreKind::YoYo => {
            "In flat water, on one heading, let the body go up and down by 2 metres, 12 s to a period. A \
             gradient follows the depth there, and swell is not there."
        }
        ManoeuvreKind::ThereAndBack => {
            "Sail one heading, the opposite one, and the first again, and rock the body on each by 7 degrees \
             in roll, then in pitch, then in yaw, 7 s to a period. What has changed for good shows where \
             everything else is the same."
        }
        ManoeuvreKind::Still => {
            "Stay on one heading without manoeuvres, far from the shore, all loads off. What is left then \
             comes from no load and from no motion."
        }
        ManoeuvreKind::OneThingChanged => {
            "Repeat the recording with the same manoeuvres and one thing changed at a time: loads off, another speed, \
             another place. What changes with it is the cause."
        }
    }
}

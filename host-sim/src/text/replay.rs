//! An exact replay in a sentence.

use crate::diagnosis::{Outcome, SessionReplay};

/// What the replay of a session says.
pub fn session(replay: &SessionReplay) -> String {
    let SessionReplay { session, compared_epochs, outcome, stopped, .. } = replay;
    let until = stopped.as_ref().map_or(String::new(), |why| format!("; not compared from there on: {why}"));
    match outcome {
        Outcome::Equal => format!("session {session}: {compared_epochs} epochs equal their replay{until}"),
        Outcome::Differs { first_tick, stage, epochs, .. } => {
            let stage = stage.replace('_', " ");
            format!(
                "session {session}: {epochs} of {compared_epochs} epochs differ from their replay, the first at tick \
                 {first_tick}, by the {stage}{until}"
            )
        }
        Outcome::Unchecked { why } => format!("session {session} could not be checked: {why}"),
    }
}

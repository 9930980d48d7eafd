//! What a command does.

use super::answer::{Answer, StatusReport, put_parameter};
use super::command::{Calibrate, Command, TextLine};
use super::session::{Accepted, CalibrationSession};
use super::session_error::SessionError;
use crate::body::UnixTime;
use crate::store::{BodySettings, Parameter, Stored};

/// What is left to do for the program after [`execute`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Nothing.
    None,
    /// The stored settings have changed: write them. `log` holds at once, all others from the next start, so that what
    /// the log's header says is true for the whole session.
    SaveSettings,
    /// A calibration was accepted: store it, then close the log and start anew from it.
    SaveCalibration,
    /// Answer with what the timer showed when the line came, and shows now.
    TellTimer,
    /// Set the clock.
    SetTime {
        /// To this time...
        time: UnixTime,
        /// ...when the timer showed this, microseconds, or when the line came.
        stamp_us: Option<u32>,
    },
    /// Begin a self-test, which answers some seconds later.
    SelfTest,
    /// Close the log and start anew.
    Restart,
}

/// Do what a command says to what it is about: `draft` holds what was set and not saved. The answer is to be sent, then
/// the action done, and the answer corrected with another line if it fails.
pub fn execute(
    command: &Command,
    stored: &mut Stored,
    draft: &mut BodySettings,
    session: &mut CalibrationSession,
    status: &StatusReport,
) -> (Answer, Action) {
    match command {
        Command::Status => {
            let is_unsaved = *draft != stored.settings;
            (Answer::Status(StatusReport { session: session.state(), is_unsaved, ..*status }), Action::None)
        }
        Command::Get(None) => (Answer::Settings, Action::None),
        Command::Get(Some(parameter)) => (parameter_line(draft, *parameter), Action::None),
        Command::Set { parameter, value } => match parameter.set(draft, value) {
            Ok(()) => (parameter_line(draft, *parameter), Action::None),
            Err(error) => (refused(&error), Action::None),
        },
        Command::Save if *draft == stored.settings => (text("nothing to save"), Action::None),
        Command::Save => {
            stored.settings = *draft;
            (text("saved: holds from the next start, log at once"), Action::SaveSettings)
        }
        Command::Calibrate(step) => calibrate(*step, stored, draft, session),
        Command::Log(on) => {
            stored.settings.log = *on;
            draft.log = *on;
            (text(if *on { "log on" } else { "log off" }), Action::SaveSettings)
        }
        Command::TimeAsk => (text(""), Action::TellTimer),
        Command::TimeSet { time, stamp_us } => (text("time set"), Action::SetTime { time: *time, stamp_us: *stamp_us }),
        Command::SelfTest => (text("self-test: 3 s"), Action::SelfTest),
        Command::Help => (Answer::Help, Action::None),
        Command::Reset => (text("starting anew"), Action::Restart),
    }
}

/// What to do while the fluxgate is calibrated.
const TURN: &str =
    "calibration of the fluxgate running: turn slowly, below 17 deg/s, through all directions, far from iron";

fn calibrate(
    step: Calibrate,
    stored: &mut Stored,
    draft: &mut BodySettings,
    session: &mut CalibrationSession,
) -> (Answer, Action) {
    let done: Result<(Answer, Action), SessionError> = match step {
        Calibrate::Start => session
            .start(&stored.settings.estimator)
            .map(|()| (text("calibration running: roll, pitch and yaw on four headings"), Action::None)),
        Calibrate::Fluxgate => session.start_fluxgate().map(|()| (text(TURN), Action::None)),
        Calibrate::Stop => session.stop().map(|found| (Answer::Calibration(found), Action::None)),
        Calibrate::Accept => {
            session.accept().map(|accepted| (text(accept(&accepted, stored, draft)), Action::SaveCalibration))
        }
        Calibrate::Discard if session.discard() => Ok((text("calibration discarded"), Action::None)),
        Calibrate::Discard => Err(SessionError::NoResult),
    };
    done.unwrap_or_else(|error| (refused(&error), Action::None))
}

/// Take over an accepted calibration; the answer.
fn accept(accepted: &Accepted, stored: &mut Stored, draft: &mut BodySettings) -> &'static str {
    match accepted {
        Accepted::Terms(prior) => {
            stored.accept(prior);
            "calibration accepted: starting anew with it"
        }
        Accepted::Fluxgate(fluxgate) => {
            stored.accept_fluxgate(fluxgate);
            // Else a `save` would undo it, should this one fail.
            draft.fluxgate.take_axes(fluxgate);
            "calibration of the fluxgate accepted: starting anew with it, coefficients zero: calibrate start for new ones"
        }
    }
}

fn parameter_line(draft: &BodySettings, parameter: Parameter) -> Answer {
    let mut line = TextLine::new();
    // The longest name and value have room.
    let _ = put_parameter(&mut line, draft, parameter);
    Answer::Line(line)
}

fn refused(error: &impl core::fmt::Display) -> Answer {
    Answer::telling(&format_args!("error: {error}"))
}

fn text(text: &str) -> Answer {
    Answer::telling(&text)
}

//! What the body answers, line by line: the caller takes the next line when the transmitter has room for it.

use super::command::{HELP, TextLine};
use super::faults::{FAULT_NAMES, FaultCounters};
use super::found::Found;
use super::found_lines::put_found;
use super::session::{SessionState, Subject};
use crate::body::UnixTime;
use crate::housekeeping::Housekeeping;
use crate::self_test::SelfTestReport;
use crate::store::{BodySettings, Condition, Parameter};
use core::fmt::Write;

/// An answer of one line or many.
#[derive(Clone, Debug, PartialEq)]
// One at a time.
#[allow(clippy::large_enum_variant)]
pub enum Answer {
    /// A single line.
    Line(TextLine),
    /// The commands.
    Help,
    /// All settings.
    Settings,
    /// How the body is.
    Status(StatusReport),
    /// What a calibration found.
    Calibration(Found),
    /// What a self-test found.
    SelfTest(SelfTestReport),
}

/// How the body is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatusReport {
    /// Version of the firmware.
    pub firmware_version: &'static str,
    /// Latest tick.
    pub tick: u32,
    /// The time; `None` while it is not known.
    pub time: Option<UnixTime>,
    /// Sectors of 512 bytes that are left for the log, one a second; `None` without an open log.
    pub sectors_left: Option<u32>,
    /// The calibration.
    pub session: SessionState,
    /// How the settings were found at the start.
    pub settings: Condition,
    /// Whether settings were set and not saved.
    pub is_unsaved: bool,
    /// Leak and battery.
    pub housekeeping: Housekeeping,
    /// All fault counters.
    pub faults: FaultCounters,
}

impl Answer {
    /// A line that tells something that has a display. What is too long is cut off.
    pub fn telling(text: &impl core::fmt::Display) -> Self {
        let mut line = Cut(TextLine::new());
        // Cut off rather than refused, so that it cannot fail.
        let _ = write!(line, "{text}");
        Self::Line(line.0)
    }

    /// Line `number`, counted from 0, with the settings as they are now; `None` after the last.
    pub fn line(&self, settings: &BodySettings, number: usize) -> Option<TextLine> {
        let mut line = Cut(TextLine::new());
        match self {
            Self::Line(text) => return (number == 0).then(|| text.clone()),
            Self::Help => line.write_str(HELP.get(number)?),
            Self::Settings => put_parameter(&mut line, settings, Parameter::at(number)?),
            Self::Status(report) => report.put(&mut line, settings, number)?,
            Self::Calibration(found) => put_found(&mut line, found, number)?,
            Self::SelfTest(report) => report.put(&mut line, number)?,
        }
        .ok()?;
        Some(line.0)
    }
}

/// `name = value`.
pub(super) fn put_parameter(line: &mut impl Write, settings: &BodySettings, parameter: Parameter) -> core::fmt::Result {
    match parameter.get(settings) {
        Some(value) => write!(line, "{} = {value}", parameter.name()),
        None => write!(line, "{} (not in this scalar_format)", parameter.name()),
    }
}

impl StatusReport {
    fn put(&self, line: &mut impl Write, settings: &BodySettings, number: usize) -> Option<core::fmt::Result> {
        Some(match number {
            0 => write!(line, "towmag {}, tick {}", self.firmware_version, self.tick),
            1 => match self.time {
                Some(UnixTime { unix_us, error_us }) => {
                    let (unix_s, error_ms) = (unix_us / 1_000_000, error_us.div_ceil(1_000));
                    write!(line, "time: {unix_s} s since 1970-01-01 UTC, +- {error_ms} ms")
                }
                None => line.write_str("time: not set, type time set seconds"),
            },
            2 => self.put_log(line, settings.log),
            3 if self.is_unsaved => write!(line, "{}; changed and not saved: type save", self.settings),
            3 => write!(line, "{}", self.settings),
            4 => self.put_session(line),
            5 => self.put_housekeeping(line),
            _ => {
                let mut faults = FAULT_NAMES.iter().zip(&self.faults.0).filter(|(_, count)| **count > 0);
                let (name, count) = faults.nth(number - 6)?;
                write!(line, "fault: {name} {count}")
            }
        })
    }

    fn put_log(&self, line: &mut impl Write, on: bool) -> core::fmt::Result {
        match (on, self.sectors_left) {
            (true, None) => line.write_str("log: no card"),
            (false, None) => line.write_str("log: off, type log start"),
            (true, Some(left)) => write!(line, "log: on, room for {} h", left / 3600),
            (false, Some(left)) => write!(line, "log: off, room for {} h, type log start", left / 3600),
        }
    }

    fn put_housekeeping(&self, line: &mut impl Write) -> core::fmt::Result {
        match self.housekeeping.battery_v {
            Some(battery_v) => write!(line, "battery: {:.2} V, leak contact: ", f64::from(battery_v))?,
            None => line.write_str("battery: not measured, leak contact: ")?,
        }
        line.write_str(match self.housekeeping.has_leak {
            Some(true) => "WET",
            Some(false) => "dry",
            None => "not fitted",
        })
    }

    fn put_session(&self, line: &mut impl Write) -> core::fmt::Result {
        match self.session {
            SessionState::Idle => line.write_str("calibration: none"),
            SessionState::Running { subject, epochs, used_epochs } => {
                let of = if subject == Subject::Fluxgate { " of the fluxgate" } else { "" };
                write!(line, "calibration{of}: running, {used_epochs} of {epochs} epochs used")
            }
            SessionState::Waiting => {
                line.write_str("calibration: a result waits, type calibrate accept yes or calibrate discard yes")
            }
        }
    }
}

/// Writes as much as there is room for, in whole characters.
struct Cut(TextLine);

impl Write for Cut {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let room = self.0.capacity() - self.0.len();
        let fitting = text.get(..text.floor_char_boundary(room)).unwrap_or_default();
        self.0.push_str(fitting).map_err(|_| core::fmt::Error)
    }
}

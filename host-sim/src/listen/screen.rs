//! What a person sees while listening.

use std::io::{self, Write};

use towmag::link::{FAULT_NAMES, FaultCounters, Telemetry};
use towmag::sensors::grid::{FluxMark, ScalarMark};
use towmag::{Rejection, Status};

use super::heard::{Heard, Told};
use crate::message::on_one_line;
use crate::recording::RATE_HZ;

/// Ticks in a second: between two lines where the output is no terminal.
const TICKS_PER_LINE: u32 = RATE_HZ as u32;

/// One line that is always the latest on a terminal; a line per second elsewhere. Answers, and faults that have become
/// more, on lines of their own.
pub struct Screen<W: Write> {
    out: W,
    is_terminal: bool,
    /// The second of the last line.
    shown: Option<u32>,
}

impl<W: Write> Screen<W> {
    /// Show on `out`.
    pub fn new(out: W, is_terminal: bool) -> Self {
        Self { out, is_terminal, shown: None }
    }

    /// A message and what the body told beside it; `faults` are those known so far, `bad` the damaged frames.
    pub(super) fn telemetry(
        &mut self,
        message: &Telemetry,
        told: &Told,
        faults: &mut FaultCounters,
        bad: u32,
    ) -> io::Result<()> {
        let before = *faults;
        faults.update(&message.faults);
        for (name, (before, now)) in FAULT_NAMES.iter().zip(before.0.iter().zip(&faults.0)) {
            if now > before {
                self.text(&format!("fault: {name} {now} (+{})", now - before))?;
            }
        }
        let second = message.tick / TICKS_PER_LINE;
        if self.is_terminal {
            write!(self.out, "\r{}\x1b[K", line(message, told, bad))?;
            self.out.flush()
        } else if self.shown.replace(second) != Some(second) {
            writeln!(self.out, "{}", line(message, told, bad))?;
            self.out.flush()
        } else {
            Ok(())
        }
    }

    /// A line of its own.
    pub(super) fn text(&mut self, text: &str) -> io::Result<()> {
        let (start, end) = if self.is_terminal { ("\r", "\x1b[K") } else { ("", "") };
        // The other end of the cable does not steer this terminal.
        writeln!(self.out, "{start}{}{end}", on_one_line(text))?;
        self.out.flush()
    }

    /// The end, with what was heard.
    pub(super) fn end(&mut self, heard: &Heard) -> io::Result<()> {
        if self.is_terminal {
            writeln!(self.out)?;
        }
        let Heard { messages, lines, lost_ticks, restarts, undecodable, frames } = heard;
        writeln!(
            self.out,
            "{messages} messages, {lost_ticks} lost, {restarts} restarts, {lines} lines of text; bad frames: {} of {} \
             bytes, {} unknown, {undecodable} of another version",
            frames.bad, frames.bad_bytes, frames.unknown
        )?;
        self.out.flush()
    }
}

fn line(message: &Telemetry, told: &Told, bad: u32) -> String {
    let Telemetry { tick, unix_ms, raw_scalar_pt, compensated, status, quality, activity, .. } = message;
    let time = unix_ms.map_or_else(|| "--:--:--".into(), |ms| clock(ms / 1000));
    let raw = raw_scalar_pt.map_or_else(|| "-".into(), nanotesla);
    let field = compensated.map_or_else(|| "-".into(), |compensated| nanotesla(compensated.compensated_pt));
    let residual = compensated.map_or_else(|| "-".into(), |compensated| format!("{:+.3}", compensated.residual_nt));
    let signal = quality.signal.map_or_else(|| "-".into(), |signal| signal.to_string());
    let mut line = format!(
        "{time} tick {tick} raw {raw} nT, compensated {field} nT, residual {residual} nT, {}, signal {signal}",
        status_name(*status)
    );
    for (name, metres) in [("depth", told.navigation.depth_m), ("altitude", told.navigation.altitude_m)] {
        if let Some(metres) = metres {
            line.push_str(&format!(", {name} {metres:.2} m"));
        }
    }
    if let Some(battery_v) = told.housekeeping.battery_v {
        line.push_str(&format!(", battery {battery_v:.2} V"));
    }
    for (is_set, word) in [
        (told.housekeeping.has_leak == Some(true), "LEAK"),
        (quality.scalar != ScalarMark::Present, scalar_name(quality.scalar)),
        (quality.flux != FluxMark::Present, flux_name(quality.flux)),
        (activity.calibrating, "CALIBRATING"),
        (!activity.logging, "NOT LOGGED"),
        (activity.log_failing, "LOG FAILS"),
    ] {
        if is_set {
            line.push_str(", ");
            line.push_str(word);
        }
    }
    if bad > 0 {
        line.push_str(&format!(", bad frames {bad}"));
    }
    line
}

/// Time of day, UTC.
fn clock(unix_s: u64) -> String {
    format!("{:02}:{:02}:{:02}", unix_s / 3600 % 24, unix_s / 60 % 60, unix_s % 60)
}

/// Picotesla as nanotesla, every digit.
pub(super) fn nanotesla(scalar_pt: i32) -> String {
    let sign = if scalar_pt < 0 { "-" } else { "" };
    let magnitude = scalar_pt.unsigned_abs();
    format!("{sign}{}.{:03}", magnitude / 1000, magnitude % 1000)
}

/// What became of an epoch, in the words of the table and the screen.
pub(super) fn status_name(status: Status) -> &'static str {
    match status {
        Status::Used => "used",
        Status::Settling => "settling",
        Status::Rejected(Rejection::ScalarMissing) => "scalar missing",
        Status::Rejected(Rejection::ScalarOutOfRange) => "scalar out of range",
        Status::Rejected(Rejection::FluxMissing) => "fluxgate missing",
        Status::Rejected(Rejection::FluxOutOfRange) => "fluxgate out of range",
        Status::Rejected(Rejection::AfterGap) => "after gap",
    }
}

/// The scalar reading's mark.
pub(super) fn scalar_name(mark: ScalarMark) -> &'static str {
    match mark {
        ScalarMark::Present => "present",
        ScalarMark::Missing => "no scalar",
        ScalarMark::Invalid => "invalid scalar",
        ScalarMark::OffTime => "scalar off time",
    }
}

/// The fluxgate reading's mark.
pub(super) fn flux_name(mark: FluxMark) -> &'static str {
    match mark {
        FluxMark::Present => "present",
        FluxMark::Missing => "no fluxgate",
        FluxMark::Clipped => "fluxgate clipped",
    }
}

//! Lamps in words.

use std::collections::VecDeque;

use towmag::link::Telemetry;
use towmag::sensors::grid::{FluxMark, ScalarMark};
use towmag::{Rejection, Status};
use towmag_live::{Lamp, Lamps, Level};

use super::super::heard::Heard;
use super::super::screen::{flux_name, scalar_name, status_name};
use crate::recording::RATE_HZ;

/// Words that change with every message are told once a second; what gets better or worse, at once.
const TICKS: u32 = RATE_HZ as u32;

/// Losses are those of the last minute.
const LOSS_S: usize = 60;

/// A clock that is off by more than this, ms, puts a target a body's length from where it is, at 2 m/s.
const GOOD_CLOCK_MS: u16 = 500;

/// Lamps in words.
#[derive(Debug)]
pub(super) struct LampWords {
    ship: Lamp,
    shown: Lamps,
    /// Messages since the lamps were told.
    quiet: u32,
    /// What was lost until each of the last seconds.
    losses: VecDeque<u64>,
}

impl LampWords {
    /// `kept` names the files that are written.
    pub(super) fn new(kept: Vec<String>, is_live: bool) -> Self {
        let ship = match (kept.is_empty(), is_live) {
            (false, _) => Lamp::new(Level::Good, kept.join(", ")),
            (true, true) => Lamp::new(Level::Warn, "NOT RECORDED"),
            (true, false) => Lamp::new(Level::Good, "a recording"),
        };
        Self { ship, shown: Lamps::default(), quiet: u32::MAX - 1, losses: VecDeque::new() }
    }

    /// The lamps at a message, if it is time to tell them.
    pub(super) fn of_message(&mut self, message: &Telemetry, heard: &Heard) -> Option<Lamps> {
        let lamps = Lamps {
            sensor: sensor(message),
            adaptation: adaptation(message),
            log: log(message),
            card: card(message),
            cable: self.cable(heard),
            time: time(message),
            ship: self.ship.clone(),
        };
        self.tell(lamps)
    }

    /// The same of a row of a recording, of which nothing else is known.
    pub(super) fn of_row(&mut self, is_valid: bool) -> Option<Lamps> {
        let sensor = if is_valid { Lamp::new(Level::Good, "valid") } else { Lamp::new(Level::Bad, "not valid") };
        let ship = self.ship.clone();
        self.tell(Lamps { sensor, ship, ..Lamps::default() })
    }

    fn tell(&mut self, lamps: Lamps) -> Option<Lamps> {
        self.quiet += 1;
        let is_urgent = levels(&lamps) != levels(&self.shown);
        if !is_urgent && self.quiet < TICKS {
            return None;
        }
        self.quiet = 0;
        self.shown = lamps.clone();
        Some(lamps)
    }

    fn cable(&mut self, heard: &Heard) -> Lamp {
        let lost = heard.lost_ticks + u64::from(heard.frames.bad);
        if heard.messages % u64::from(TICKS) == 1 {
            self.losses.push_back(lost);
            if self.losses.len() > LOSS_S {
                self.losses.pop_front();
            }
        }
        match lost - self.losses.front().copied().unwrap_or(lost).min(lost) {
            0 => Lamp::new(Level::Good, "nothing lost"),
            lost => Lamp::new(Level::Warn, format!("{lost} lost in a minute")),
        }
    }
}

fn levels(lamps: &Lamps) -> [Level; 7] {
    let Lamps { sensor, adaptation, log, card, cable, time, ship } = lamps;
    [sensor, adaptation, log, card, cable, time, ship].map(|lamp| lamp.level)
}

fn sensor(message: &Telemetry) -> Lamp {
    let quality = &message.quality;
    match (quality.scalar, quality.flux, quality.signal) {
        (ScalarMark::Missing | ScalarMark::Invalid, ..) => Lamp::new(Level::Bad, scalar_name(quality.scalar)),
        (_, FluxMark::Missing | FluxMark::Clipped, _) => Lamp::new(Level::Bad, flux_name(quality.flux)),
        (ScalarMark::OffTime, ..) => Lamp::new(Level::Warn, scalar_name(quality.scalar)),
        (.., Some(signal)) => Lamp::new(Level::Good, format!("signal {signal}")),
        (.., None) => Lamp::new(Level::Good, "both present"),
    }
}

fn adaptation(message: &Telemetry) -> Lamp {
    match message.status {
        _ if message.activity.calibrating => Lamp::new(Level::Warn, "CALIBRATING"),
        Status::Used => Lamp::new(Level::Good, "follows"),
        Status::Settling => Lamp::new(Level::Warn, "settling"),
        Status::Rejected(Rejection::AfterGap) => Lamp::new(Level::Warn, "after a gap"),
        status => Lamp::new(Level::Warn, format!("waits: {}", status_name(status))),
    }
}

fn log(message: &Telemetry) -> Lamp {
    match (message.activity.logging, message.activity.log_failing) {
        (_, true) => Lamp::new(Level::Bad, "LOG FAILS"),
        (false, _) => Lamp::new(Level::Bad, "NOT LOGGED"),
        (true, false) => Lamp::new(Level::Good, "logging"),
    }
}

fn card(message: &Telemetry) -> Lamp {
    match (message.activity.logging, message.activity.log_failing) {
        (_, true) => Lamp::new(Level::Bad, "does not take it"),
        (true, false) => Lamp::new(Level::Good, "takes all"),
        (false, false) => Lamp::new(Level::Unknown, "not written to"),
    }
}

fn time(message: &Telemetry) -> Lamp {
    match (message.unix_ms, message.time_error_ms) {
        (None, _) => Lamp::new(Level::Warn, "not set"),
        (Some(_), None) => Lamp::new(Level::Good, "set"),
        (Some(_), Some(error_ms)) if error_ms <= GOOD_CLOCK_MS => {
            Lamp::new(Level::Good, format!("within {error_ms} ms"))
        }
        (Some(_), Some(error_ms)) => Lamp::new(Level::Warn, format!("off by {:.1} s", f64::from(error_ms) / 1e3)),
    }
}

//! The lock-step of recording, body and twin.

use std::collections::VecDeque;

use towmag::Output;
use towmag::sensors::ads131m04::FRAME_BYTES;

use super::emulated::Emulated;
use super::error::EmulatorError;
use super::machine::{Machine, Request};
use super::settings::Typed;
use super::twin::{Event, Twin};
use super::{card, compare, telemetry};
use crate::pace::Pace;
use crate::wire::FaultKind;
use crate::wire::adc::{self, Adc};
use crate::wire::body::epochs_of_rows;
use crate::wire::feed::{Feed, Step};

/// Recording, body and twin, which never run ahead of one another.
pub(super) struct Lockstep<'a> {
    feed: Feed<'a>,
    adc: Adc,
    twin: Twin,
    machine: Machine,
    typed: Vec<Typed>,
    /// How fast somebody wants to see it.
    pace: Option<Pace>,
    /// Events that the twin has yet to live through.
    pending: VecDeque<Event>,
    step: Step,
    /// Data-ready edges of this life, as far as the feed has followed.
    conversions: u32,
    /// When the middle of each row was: start of the body, stamp, row.
    row_stamps: Vec<(usize, u32, u64)>,
    is_over: bool,
}

impl<'a> Lockstep<'a> {
    /// Before the body's first request.
    pub(super) fn new(feed: Feed<'a>, twin: Twin, machine: Machine, typed: Vec<Typed>, pace: Option<Pace>) -> Self {
        Self {
            feed,
            adc: Adc::new(),
            twin,
            machine,
            typed,
            pace,
            pending: VecDeque::new(),
            step: Step::default(),
            conversions: 0,
            row_stamps: Vec::new(),
            is_over: false,
        }
    }

    /// Go through the recording to its end.
    pub(super) fn run(&mut self) -> Result<(), EmulatorError> {
        loop {
            match self.machine.request()? {
                Some(request) if request.is_farewell() => self.follow(&request)?,
                Some(request) => self.answer(&request)?,
                None if self.is_over => return Ok(()),
                None => self.machine.revive()?,
            }
        }
    }

    fn answer(&mut self, request: &Request) -> Result<(), EmulatorError> {
        self.follow(request)?;
        self.advance(request)?;
        let mut frame = self.adc.exchange(&request.frame, self.step.counts);
        if self.step.unplugged {
            (self.adc, frame) = (Adc::new(), [0; FRAME_BYTES]);
        }
        // Only once: further transactions at this conversion are those of a set-up.
        let step = std::mem::take(&mut self.step).split(&mut self.step);
        let Step { sentence, nmea, housekeeping, damaged_frame, blow, .. } = step;
        if damaged_frame {
            adc::damage(&mut frame);
        }
        let command = match blow {
            _ if self.is_over => 3,
            Some(FaultKind::Power) => {
                self.machine.cut_power();
                self.adc = Adc::new();
                return Ok(());
            }
            Some(FaultKind::Reset) => 1,
            Some(FaultKind::Panic) => 2,
            _ => 0,
        };
        self.twin.send(&sentence);
        self.twin.answer(frame);
        self.machine.answer(&frame, &sentence, &nmea, housekeeping, command)
    }

    /// Let the twin live through all events whose transactions are complete: those before the last that starts any.
    fn follow(&mut self, request: &Request) -> Result<(), EmulatorError> {
        for &event in &request.events {
            if event == Event::Boot {
                self.catch_up(self.pending.len());
                self.twin.boot(&self.machine.stored()?)?;
                self.conversions = 0;
            } else {
                self.pending.push_back(event);
            }
        }
        if request.events.iter().any(|event| event.starts_transactions()) {
            let complete = self.pending.iter().rposition(|event| event.starts_transactions()).unwrap_or(0);
            self.catch_up(complete);
        }
        Ok(())
    }

    fn catch_up(&mut self, events: usize) {
        for event in self.pending.drain(..events) {
            self.twin.live(event);
        }
    }

    /// Go on to the body's conversion.
    fn advance(&mut self, request: &Request) -> Result<(), EmulatorError> {
        while self.conversions != request.conversions && !self.is_over {
            self.conversions = self.conversions.wrapping_add(1);
            match self.feed.next()? {
                Some(step) => self.step = step,
                None => self.is_over = true,
            }
            self.adc.convert();
            let stamp = request.events.iter().rev().find_map(|event| match event {
                Event::Conversion(stamp_us) => Some(*stamp_us),
                _ => None,
            });
            if let (Some(row), Some(stamp_us)) = (self.step.row, stamp) {
                self.row_stamps.push((self.twin.sessions.len().saturating_sub(1), stamp_us, row));
            }
            if let (Some(row), Some(pace)) = (self.step.row, &mut self.pace) {
                pace.wait(row);
            }
            for typed in self.typed.extract_if(.., |typed| Some(typed.row) == self.step.row) {
                self.machine.type_line(&typed.line)?;
            }
        }
        Ok(())
    }

    /// Hold the body against its replay, and take what it gave.
    pub(super) fn finish(mut self) -> Result<Emulated, EmulatorError> {
        self.catch_up(self.pending.len());
        let (cables, card) = self.machine.finish()?;
        let read = telemetry::read(&cables);
        compare::all_telemetry(&read.lives, &self.twin.sessions)?;
        let log = card::read_log(&card).map_err(EmulatorError::io("card"))?;
        compare::all_logs(&log.sessions, &self.twin.sessions)?;
        compare::all_housekeeping(&log.sessions, &self.twin.housekeeping)?;
        Ok(Emulated {
            outputs: self.outputs(),
            epochs: read.lives.iter().map(Vec::len).sum(),
            starts: self.twin.sessions.len(),
            pipeline: self.twin.pipeline().clone(),
            stored: self.machine.stored()?,
            telemetry: cables.concat(),
            log: log.bytes,
            log_epochs: log.sessions.iter().map(|session| session.epochs.len()).sum(),
            events: log.sessions.into_iter().flat_map(|session| session.events).collect(),
            figures: read.figures,
            texts: read.texts,
        })
    }

    /// The outputs in the order of the rows.
    fn outputs(&self) -> Vec<Option<Output>> {
        let mut outputs = vec![None; usize::try_from(self.feed.rows()).unwrap_or(usize::MAX)];
        for (start, session) in self.twin.sessions.iter().enumerate() {
            let stamps = self.row_stamps.iter().filter(|(of, ..)| *of == start);
            for (row, made) in epochs_of_rows(stamps.map(|&(_, stamp_us, row)| (stamp_us, row)), session) {
                if let Some(place) = outputs.get_mut(row as usize) {
                    *place = Some(made.record.output);
                }
            }
        }
        outputs
    }
}

impl Step {
    /// What happens once, and what stays as long as the conversion does.
    fn split(self, stays: &mut Self) -> Self {
        let Self { counts, housekeeping, unplugged, .. } = self;
        *stays = Self { counts, housekeeping, unplugged, ..Self::default() };
        self
    }
}

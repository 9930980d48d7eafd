//! The lock-step of recording, body and twin.

use std::collections::{BTreeMap, VecDeque};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use towmag::estimate::Prior;
use towmag::link::Telemetry;
use towmag::log::{EpochRecord, Event as LogEvent, EventKind};
use towmag::sensors::ads131m04::FRAME_BYTES;
use towmag::sensors::fluxgate::FluxgateSettings;
use towmag::sensors::grid::GridSettings;
use towmag::sensors::scalar::ScalarSettings;
use towmag::store::{BodySettings, Stored};
use towmag::{Output, Pipeline, Settings};

use super::card::{self, Session};
use super::machine::{Machine, Request};
use super::telemetry::{self, Figures};
use super::twin::{Event, Twin};
use super::{EmulatorError, compare};
use crate::error::HostError;
use crate::recording::Recording;
use crate::wire::adc::{self, Adc};
use crate::wire::body::{Made, epochs_of_rows};
use crate::wire::feed::{Feed, NT_PER_COUNT, Step};
use crate::wire::{Fault, FaultKind};

/// How to emulate.
#[derive(Clone, Debug)]
pub struct EmulationSettings {
    /// The firmware, built for emulation.
    pub image: PathBuf,
    /// The scalar sensor; its format is what the body is sent.
    pub scalar: ScalarSettings,
    /// Fluxgate conversions to an epoch, odd, 1 to 25.
    pub conversions_per_epoch: u8,
    /// What befalls the body.
    pub faults: Vec<Fault>,
    /// What the operator types.
    pub typed: Vec<Typed>,
}

/// A line for the console, and the row at which it is typed: `ROW:LINE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Typed {
    /// From 0.
    pub row: u64,
    /// Without its end.
    pub line: String,
}

impl FromStr for Typed {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let usage = "ROW:LINE, such as 100:status";
        let (row, line) = text.split_once(':').ok_or(usage)?;
        Ok(Self { row: row.trim().parse().map_err(|_| usage)?, line: line.trim().into() })
    }
}

/// What an emulation gave, when body and replay are equal.
pub struct Emulated {
    /// The body's output for each row of the recording; `None` when the body had none for it.
    pub outputs: Vec<Option<Output>>,
    /// Epochs that were compared.
    pub epochs: usize,
    /// Starts of the body.
    pub starts: usize,
    /// The core as it is at the end.
    pub pipeline: Pipeline,
    /// What the body's flash holds at the end.
    pub stored: Stored,
    /// What came down the cable.
    pub telemetry: Vec<u8>,
    /// Lines of text that came down the cable.
    pub texts: Vec<String>,
    /// The sectors of the log.
    pub log: Vec<u8>,
    /// Epoch records in the log.
    pub log_epochs: usize,
    /// Events in the log.
    pub events: Vec<LogEvent>,
    /// The body's counters and costs.
    pub figures: Figures,
}

/// Run the firmware over a recording, and hold it against the replay of the same bytes.
pub fn emulate(
    recording: &Path,
    settings: &Settings,
    prior: impl Into<Prior>,
    emulation: &EmulationSettings,
) -> Result<Emulated, HostError> {
    let opened = Recording::open(recording)?;
    let log_file_h = log_hours(&opened);
    let settings = body_settings(settings, emulation, log_file_h);
    settings.validate()?;
    let Prior { coefficients, information } = prior.into();
    let stored = Stored { settings, coefficients, information };
    let per_epoch = usize::from(emulation.conversions_per_epoch);
    let feed = Feed::new(opened, settings.scalar.format, per_epoch, emulation.faults.clone());
    let twin = Twin::new(&stored)?;
    let starts = 1 + emulation.faults.iter().map(|fault| fault.rows.end - fault.rows.start).sum::<u64>();
    let card_blocks = log_file_h * 3_600 + u32::try_from(starts).unwrap_or(u32::MAX).min(10_000);
    let machine = Machine::start(&emulation.image, &stored, card_blocks)?;
    let mut lockstep = Lockstep {
        feed,
        adc: Adc::new(),
        twin,
        machine,
        typed: emulation.typed.clone(),
        pending: VecDeque::new(),
        step: Step::default(),
        conversions: 0,
        row_stamps: Vec::new(),
        is_over: false,
    };
    lockstep.run()?;
    lockstep.finish()
}

/// Room for the log, hours: eight rows a block are less than what fits. A row takes at least twenty bytes.
fn log_hours(recording: &Recording<File>) -> u32 {
    let most_rows = recording.byte_len().unwrap_or(40_000_000) / 20;
    u32::try_from(most_rows / 8 / 3_600 + 1).unwrap_or(u32::MAX).min(240)
}

/// A body whose sensors have no delay, and whose fluxgate has the resolution of a recording.
fn body_settings(settings: &Settings, emulation: &EmulationSettings, log_file_h: u32) -> BodySettings {
    BodySettings {
        estimator: *settings,
        scalar: emulation.scalar,
        scalar_baud: 115_200,
        grid: GridSettings {
            scalar_delay_us: 0,
            flux_delay_us: 0,
            conversions_per_epoch: emulation.conversions_per_epoch,
            ..GridSettings::default()
        },
        fluxgate: FluxgateSettings { nt_per_count: [NT_PER_COUNT; 3], ..FluxgateSettings::default() },
        log: true,
        log_file_h,
    }
}

struct Lockstep {
    feed: Feed<File>,
    adc: Adc,
    twin: Twin,
    machine: Machine,
    typed: Vec<Typed>,
    /// Events that the twin has yet to live through.
    pending: VecDeque<Event>,
    step: Step,
    /// Data-ready edges of this life, as far as the feed has followed.
    conversions: u32,
    /// When the middle of each row was: start of the body, stamp, row.
    row_stamps: Vec<(usize, u32, u64)>,
    is_over: bool,
}

impl Lockstep {
    fn run(&mut self) -> Result<(), HostError> {
        loop {
            match self.machine.request()? {
                Some(request) if request.is_farewell() => self.follow(&request)?,
                Some(request) => self.answer(&request)?,
                None if self.is_over => return Ok(()),
                None => self.machine.revive()?,
            }
        }
    }

    fn answer(&mut self, request: &Request) -> Result<(), HostError> {
        self.follow(request)?;
        self.advance(request)?;
        let mut frame = self.adc.exchange(&request.frame, self.step.counts);
        if self.step.unplugged {
            (self.adc, frame) = (Adc::new(), [0; FRAME_BYTES]);
        }
        // Only once: further transactions at this conversion are those of a set-up.
        let Step { sentence, damaged_frame, blow, .. } = std::mem::take(&mut self.step).split(&mut self.step);
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
        Ok(self.machine.answer(&frame, &sentence, command)?)
    }

    /// Let the twin live through all events whose transactions are complete: those before the last that starts any.
    fn follow(&mut self, request: &Request) -> Result<(), HostError> {
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
    fn advance(&mut self, request: &Request) -> Result<(), HostError> {
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
            for typed in self.typed.extract_if(.., |typed| Some(typed.row) == self.step.row) {
                self.machine.type_line(&typed.line)?;
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Emulated, HostError> {
        self.catch_up(self.pending.len());
        let (cables, card) = self.machine.finish()?;
        let read = telemetry::read(&cables);
        compare_telemetry(&read.lives, &self.twin.sessions)?;
        let log = card::read_log(&card).map_err(EmulatorError::io("card"))?;
        compare_log(&log.sessions, &self.twin.sessions)?;
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
        *stays = Self { counts: self.counts, unplugged: self.unplugged, ..Self::default() };
        self
    }
}

fn compare_telemetry(lives: &[Vec<Telemetry>], sessions: &[Vec<Made>]) -> Result<(), EmulatorError> {
    for (life, made) in sessions.iter().enumerate() {
        let told: Vec<Telemetry> = made.iter().map(|made| made.telemetry).collect();
        let body = lives.get(life).map_or(&[][..], Vec::as_slice);
        compare::telemetry(life, body, &told, life + 1 == sessions.len()).map_err(EmulatorError::Differs)?;
    }
    Ok(())
}

fn compare_log(logged: &[Session], sessions: &[Vec<Made>]) -> Result<(), EmulatorError> {
    for (start, made) in sessions.iter().enumerate() {
        let expected: Vec<EpochRecord> = made.iter().map(|made| made.record).collect();
        let none = Session::default();
        let session = logged.get(start).unwrap_or(&none);
        let has_pauses = session.events.iter().any(|event| event.kind == EventKind::LogStop);
        let compare = if has_pauses { compare::log_with_pauses } else { compare::log };
        compare(start, &session.epochs, &expected).map_err(EmulatorError::Differs)?;
        if session.lost_epochs > 0 || session.faults > 0 {
            let Session { lost_epochs, faults, .. } = session;
            return Err(EmulatorError::Broken(format!(
                "the log of start {start} lacks {lost_epochs} epochs and has {faults} faults"
            )));
        }
    }
    Ok(())
}

/// The figures with the costs in instructions, by what the body has found a known number of them to take.
pub fn in_instructions(figures: &Figures) -> BTreeMap<&'static str, u32> {
    let known = figures.get("ticks_per_100000_instructions").copied().unwrap_or(0);
    let instructions = |ticks: u32| (f64::from(ticks) * 100_000.0 / f64::from(known.max(1))) as u32;
    let convert = |(&name, &value): (&&'static str, &u32)| match name {
        "ticks_per_epoch_worst" => ("instructions_per_epoch_worst", instructions(value)),
        "ticks_per_epoch_mean" => ("instructions_per_epoch_mean", instructions(value)),
        _ => (name, value),
    };
    figures.iter().map(convert).collect()
}

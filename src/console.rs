//! The operator's lines from the ship, what they do, and the answers.

use crate::body::{Firmware, TimeOfDay};
use crate::hardware::{Stamp, System};
use crate::health::{Count, Health};
use crate::link::{
    Action, Answer, Calibrate, CalibrationSession, Command, Input, LineReader, SessionState, StatusReport,
    acknowledgement, execute,
};
use crate::log::{Event, EventKind, truncated};
use crate::store::{BodySettings, Condition, SettingsInFlash};
use crate::telemetry::Outbox;
use embedded_hal_nb::nb;
use embedded_hal_nb::serial::Read;
use embedded_storage::nor_flash::NorFlash;
use heapless::spsc::{Consumer, Producer, Queue};

/// Bytes from the ship, `None` where some are missing: a screenful that somebody pastes, and two calls of the console at
/// 115,200 baud.
pub type InboxQueue = Queue<Option<u8>, 1024>;

/// The way in for what the ship sends.
pub struct Inbox<'a> {
    queue: Producer<'a, Option<u8>>,
    /// The last bytes found no room, and the queue does not tell yet.
    has_lost: bool,
}

impl<'a> Inbox<'a> {
    /// Fill the queue.
    pub fn new(queue: Producer<'a, Option<u8>>) -> Self {
        Self { queue, has_lost: false }
    }

    /// A byte, or `None` where the receiver reports an error; false when there is no room. Where bytes are lost the queue
    /// gets a `None` before the next one, so that what stood before and after is never read as one line.
    fn put(&mut self, byte: Option<u8>) -> bool {
        if self.has_lost && self.queue.enqueue(None).is_err() {
            return false;
        }
        self.has_lost = self.queue.enqueue(byte).is_err();
        !self.has_lost
    }
}

/// What happened, on its way to the log: events that are too long for the queue of the epochs.
pub type NoticeQueue = Queue<Event, 4>;

/// Bytes taken in one call of [`receive`].
const LONGEST_BURST: usize = 16;

/// Take what the ship has sent. Errors, and bytes that find the queue full, are counted.
pub fn receive(port: &mut impl Read<u8>, inbox: &mut Inbox<'_>, health: &Health) {
    for _ in 0..LONGEST_BURST {
        let byte = match port.read() {
            Ok(byte) => Some(byte),
            Err(nb::Error::WouldBlock) => break,
            Err(nb::Error::Other(_)) => {
                health.counts.add(Count::CableOverruns, 1);
                None
            }
        };
        health.counts.add_if(!inbox.put(byte), Count::CableOverruns);
    }
}

/// What commands act on, besides the settings.
pub struct ConsoleContext<'a> {
    /// The calibration.
    pub session: CalibrationSession,
    /// `None` until someone sets it.
    pub time_of_day: Option<TimeOfDay>,
    /// The way to the ship.
    pub outbox: Outbox<'a>,
    /// Tick of the latest epoch.
    pub tick: u32,
}

impl<'a> ConsoleContext<'a> {
    /// A start, at the time that the last session has left.
    pub fn new(outbox: Outbox<'a>, system: &impl System) -> Self {
        let time_of_day = system.time_left().map(|unix_ms| TimeOfDay::set(unix_ms, system.stamp_us(Stamp::Other)));
        Self { session: CalibrationSession::new(), time_of_day, outbox, tick: 0 }
    }
}

/// Takes lines one at a time: the next when the answer is on its way.
pub struct Console<'a, F, S> {
    inbox: Consumer<'a, Option<u8>>,
    notices: Producer<'a, Event>,
    lines: LineReader,
    settings: SettingsInFlash<F>,
    /// What was set, and holds when it has been saved and the body has started anew.
    draft: BodySettings,
    /// The number to acknowledge before the answer.
    to_acknowledge: Option<u16>,
    /// The number of the last command that had one.
    last_number: Option<u16>,
    /// The answer under way, and its next line.
    answer: Option<(Answer, usize)>,
    restarts: bool,
    version: &'static str,
    health: &'a Health,
    system: S,
}

impl<'a, F: NorFlash, S: System> Console<'a, F, S> {
    /// A console that begins by telling what is wrong with the settings, if anything is.
    pub fn new(
        inbox: Consumer<'a, Option<u8>>,
        mut notices: Producer<'a, Event>,
        settings: SettingsInFlash<F>,
        firmware: &Firmware,
        health: &'a Health,
        system: S,
    ) -> Self {
        let condition = settings.condition();
        let is_well = matches!(condition, Condition::Intact | Condition::Fresh);
        if !is_well {
            let kind = EventKind::Notice(text_of(&condition));
            // The queue is empty yet.
            _ = notices.enqueue(Event { tick: 0, kind });
        }
        let answer = (!is_well).then(|| (Answer::telling(&condition), 0));
        let version = firmware.version;
        let draft = settings.stored.settings;
        Self {
            inbox,
            notices,
            lines: LineReader::default(),
            settings,
            draft,
            to_acknowledge: None,
            last_number: None,
            answer,
            restarts: false,
            version,
            health,
            system,
        }
    }

    /// Go on with the answer, then take in what has come.
    pub fn run(&mut self, context: &mut ConsoleContext<'_>) {
        while self.has_answered(&mut context.outbox) {
            if self.restarts {
                return self.restart(context);
            }
            let Some(input) = self.next_input() else { break };
            self.take(input, context);
        }
        let counters = self.lines.counters();
        self.health.counts.set(Count::ConsoleLinesDropped, counters.overlong.saturating_add(counters.damaged));
    }

    /// Send as many lines as there is room for; whether that was the last.
    fn has_answered(&mut self, outbox: &mut Outbox<'_>) -> bool {
        if let Some(number) = self.to_acknowledge {
            if !outbox.text(&acknowledgement(number)) {
                return false;
            }
            self.to_acknowledge = None;
        }
        while let Some((answer, next)) = &mut self.answer {
            match answer.line(&self.draft, *next) {
                Some(line) if outbox.text(&line) => *next += 1,
                Some(_) => return false,
                None => self.answer = None,
            }
        }
        true
    }

    fn next_input(&mut self) -> Option<Input> {
        while let Some(byte) = self.inbox.dequeue() {
            match byte {
                Some(byte) => {
                    let input = self.lines.push(byte);
                    if input.is_some() {
                        return input;
                    }
                }
                None => self.lines.receive_error(),
            }
        }
        None
    }

    fn take(&mut self, input: Input, context: &mut ConsoleContext<'_>) {
        let answer = match input {
            Input::Command(command) => self.obey(&command, context),
            Input::Refused(error) => Answer::telling(&error),
            Input::Dropped(dropped) => Answer::telling(&dropped),
            Input::Numbered { number, command } => {
                self.to_acknowledge = Some(number);
                if self.last_number.replace(number) == Some(number) {
                    return; // sent again: its acknowledgement did not arrive
                }
                match command {
                    Ok(command) => self.obey(&command, context),
                    Err(error) => Answer::telling(&error),
                }
            }
        };
        self.answer = Some((answer, 0));
    }

    fn obey(&mut self, command: &Command, context: &mut ConsoleContext<'_>) -> Answer {
        let now_us = self.system.stamp_us(Stamp::Other);
        let report = self.report(context, now_us);
        let before = context.session.state();
        let (answer, action) =
            execute(command, &mut self.settings.stored, &mut self.draft, &mut context.session, &report);
        if *command == Command::Calibrate(Calibrate::Stop) {
            self.note_calibration(before, context);
        }
        match action {
            Action::None => {}
            Action::SaveSettings => return self.save().unwrap_or(answer),
            Action::SaveCoefficients => match self.save() {
                Some(failure) => return failure,
                None => self.restarts = true,
            },
            Action::SetTime { unix_s } => {
                let unix_ms = unix_s * 1_000;
                context.time_of_day = Some(TimeOfDay::set(unix_ms, now_us));
                self.notice(context.tick, EventKind::TimeSet { unix_ms });
            }
            Action::Restart => self.restarts = true,
        }
        answer
    }

    fn report(&self, context: &mut ConsoleContext<'_>, now_us: u32) -> StatusReport {
        StatusReport {
            firmware_version: self.version,
            tick: context.tick,
            unix_s: context.time_of_day.as_mut().map(|time| time.unix_ms(now_us) / 1_000),
            sectors_left: self.health.log.sectors_left(),
            session: SessionState::Idle, // `execute` fills these two in
            is_unsaved: false,
            settings: self.settings.condition(),
            faults: self.health.counts.faults(),
        }
    }

    /// What a calibration came to, for the log.
    fn note_calibration(&mut self, before: SessionState, context: &ConsoleContext<'_>) {
        let SessionState::Running { used_epochs, .. } = before else { return };
        let kind = context.session.summary().map_or(EventKind::CalibrationFailed { used_epochs }, |summary| {
            EventKind::Calibrated {
                coefficients: summary.coefficients,
                used_epochs: summary.used_epochs,
                std_before_nt: summary.std_before_nt as f32,
                rms_after_nt: summary.rms_after_nt as f32,
            }
        });
        self.notice(context.tick, kind);
    }

    fn notice(&mut self, tick: u32, kind: EventKind) {
        self.health.counts.add_if(self.notices.enqueue(Event { tick, kind }).is_err(), Count::RecordsLost);
    }

    /// Store settings and coefficients; the answer when that fails.
    fn save(&mut self) -> Option<Answer> {
        self.health.log.want(self.settings.stored.settings.log);
        let error = self.settings.save().err()?;
        Some(Answer::telling(&format_args!("error: not stored, gone with the next start: {error}")))
    }

    /// When the last line has left the queue, have the log closed and the chip started anew.
    fn restart(&mut self, context: &mut ConsoleContext<'_>) {
        if context.outbox.is_empty() {
            let now_us = self.system.stamp_us(Stamp::Other);
            self.system.leave_time(context.time_of_day.as_mut().map(|time| time.unix_ms(now_us)));
            self.health.ask_for_restart();
        }
    }
}

fn text_of<const N: usize>(what: &impl core::fmt::Display) -> heapless::String<N> {
    let mut text = heapless::String::<N>::new();
    // Too long only for a text that this firmware does not have; then it is cut.
    _ = core::fmt::Write::write_fmt(&mut text, format_args!("{what}"));
    truncated(&text)
}

//! The operator's lines from the ship, what they do, and the answers.

mod found_event;

use crate::body::{Firmware, TimeOfDay, after_reset};
use crate::hardware::{SensorTransmitters, Stamp, System};
use crate::health::{Count, Health};
use crate::housekeeping::Housekeeping;
use crate::link::{
    Action, Answer, Calibrate, CalibrationSession, Command, Input, LineReader, SessionState, StatusReport, TimerTold,
    acknowledgement, execute,
};
use crate::log::{Event, EventKind, truncated};
use crate::self_test::{Due, SelfTest, SelfTestReport};
use crate::sensors::fluxgate::FluxgateSettings;
use crate::sensors::grid::{FluxMark, ScalarMark};
use crate::store::{BodySettings, Condition, SettingsInFlash};
use crate::telemetry::Outbox;
use embedded_hal_nb::nb;
use embedded_hal_nb::serial::Read;
use embedded_storage::nor_flash::NorFlash;
use found_event::event_of;
use heapless::spsc::{Consumer, Producer, Queue};

/// What has come from the ship.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// A byte.
    Byte(u8),
    /// A byte that ends a line, and the timer when it came, microseconds.
    LineEnd(u8, u32),
    /// Bytes are missing here.
    Loss,
}

/// On its way to the console: a screenful that somebody pastes, and two calls of the console at 115,200 baud.
pub type InboxQueue = Queue<Arrival, 1024>;

/// The way in for what the ship sends.
pub struct Inbox<'a> {
    queue: Producer<'a, Arrival>,
    /// The last bytes found no room, and the queue does not tell yet.
    has_lost: bool,
}

impl<'a> Inbox<'a> {
    /// Fill the queue.
    pub fn new(queue: Producer<'a, Arrival>) -> Self {
        Self { queue, has_lost: false }
    }

    /// False when there is no room. Where bytes are lost the queue gets a [`Arrival::Loss`] before the next one, so that
    /// what stood before and after is never read as one line.
    fn put(&mut self, arrival: Arrival) -> bool {
        if self.has_lost && self.queue.enqueue(Arrival::Loss).is_err() {
            return false;
        }
        self.has_lost = self.queue.enqueue(arrival).is_err();
        !self.has_lost
    }
}

/// What happened, on its way to the log: events that are too long for the queue of the epochs.
pub type NoticeQueue = Queue<Event, 4>;

/// Bytes taken in one call of [`receive`].
const LONGEST_BURST: usize = 16;

/// Take what the ship has sent. Errors, and bytes that find the queue full, are counted.
pub fn receive(port: &mut impl Read<u8>, inbox: &mut Inbox<'_>, health: &Health, system: &impl System) {
    for _ in 0..LONGEST_BURST {
        let arrival = match port.read() {
            Ok(byte @ (b'\r' | b'\n')) => Arrival::LineEnd(byte, system.now_us()),
            Ok(byte) => Arrival::Byte(byte),
            Err(nb::Error::WouldBlock) => break,
            Err(nb::Error::Other(_)) => {
                health.counts.add(Count::CableOverruns, 1);
                Arrival::Loss
            }
        };
        health.counts.add_if(!inbox.put(arrival), Count::CableOverruns);
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
    /// How good its readings were.
    pub marks: (ScalarMark, FluxMark),
    /// Leak and battery as they were told last.
    pub housekeeping: Housekeeping,
}

impl<'a> ConsoleContext<'a> {
    /// A start, at the time that the last session has left, of epochs that are made with `fluxgate`.
    pub fn new(outbox: Outbox<'a>, fluxgate: FluxgateSettings, system: &impl System) -> Self {
        let kept = system.kept_time().and_then(|kept| after_reset(kept, system.reset_cause()));
        let time_of_day = kept.map(|time| TimeOfDay::set(time, system.stamp_us(Stamp::Other)));
        Self {
            session: CalibrationSession::new(fluxgate),
            time_of_day,
            outbox,
            tick: 0,
            marks: (ScalarMark::Missing, FluxMark::Missing),
            housekeeping: Housekeeping::default(),
        }
    }
}

impl ConsoleContext<'_> {
    /// A second began when the timer showed `stamp_us`.
    pub fn pulse(&mut self, stamp_us: u32) {
        if let Some(time_of_day) = &mut self.time_of_day {
            time_of_day.pulse(stamp_us);
        }
    }
}

/// Takes lines one at a time: the next when the answer is on its way.
pub struct Console<'a, F, T, S> {
    inbox: Consumer<'a, Arrival>,
    notices: Producer<'a, Event>,
    lines: LineReader,
    settings: SettingsInFlash<F>,
    /// What was set, and holds when it has been saved and the body has started anew.
    draft: BodySettings,
    /// The number to acknowledge before the answer.
    to_acknowledge: Option<u16>,
    /// The number of the last command that had one.
    last_number: Option<u16>,
    self_test: SelfTest<T>,
    /// The answer under way, and its next line.
    answer: Option<(Answer, usize)>,
    restarts: bool,
    version: &'static str,
    health: &'a Health,
    system: S,
}

impl<'a, F: NorFlash, T: SensorTransmitters, S: System> Console<'a, F, T, S> {
    /// A console that begins by telling what is wrong with the settings, if anything is.
    pub fn new(
        inbox: Consumer<'a, Arrival>,
        mut notices: Producer<'a, Event>,
        settings: SettingsInFlash<F>,
        self_test: SelfTest<T>,
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
            self_test,
            answer,
            restarts: false,
            version,
            health,
            system,
        }
    }

    /// Go on with the answer, then take in what has come.
    pub fn run(&mut self, context: &mut ConsoleContext<'_>) {
        self.tell_self_test(context);
        while self.has_answered(&mut context.outbox) {
            if self.restarts {
                return self.restart(context);
            }
            let Some((input, came_us)) = self.next_input() else { break };
            self.take(input, came_us, context);
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

    /// What the next line was, and when its end came.
    fn next_input(&mut self) -> Option<(Input, u32)> {
        while let Some(arrival) = self.inbox.dequeue() {
            match arrival {
                Arrival::Byte(byte) => _ = self.lines.push(byte), // nothing comes out of it before the line's end
                Arrival::LineEnd(byte, came_us) => {
                    if let Some(input) = self.lines.push(byte) {
                        return Some((input, came_us));
                    }
                }
                Arrival::Loss => self.lines.receive_error(),
            }
        }
        None
    }

    fn take(&mut self, input: Input, came_us: u32, context: &mut ConsoleContext<'_>) {
        let answer = match input {
            Input::Command(command) => self.obey(&command, came_us, context),
            Input::Refused(error) => Answer::telling(&error),
            Input::Dropped(dropped) => Answer::telling(&dropped),
            Input::Numbered { number, command } => {
                self.to_acknowledge = Some(number);
                if self.last_number.replace(number) == Some(number) {
                    return; // sent again: its acknowledgement did not arrive
                }
                match command {
                    Ok(command) => self.obey(&command, came_us, context),
                    Err(error) => Answer::telling(&error),
                }
            }
        };
        self.answer = Some((answer, 0));
    }

    fn obey(&mut self, command: &Command, came_us: u32, context: &mut ConsoleContext<'_>) -> Answer {
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
            Action::SaveCalibration => match self.save() {
                Some(failure) => return failure,
                None => self.restarts = true,
            },
            Action::TellTimer => return Answer::telling(&TimerTold { came_us, goes_us: self.system.now_us() }),
            Action::SetTime { time, stamp_us } => {
                let stamp_us = stamp_us.unwrap_or(came_us);
                let time_of_day = context.time_of_day.get_or_insert(TimeOfDay::set(time, stamp_us));
                time_of_day.correct(time, stamp_us);
                let now = time_of_day.at(now_us);
                self.notice(context.tick, EventKind::Time(now));
            }
            Action::SelfTest => self.self_test.ask(context.tick, self.health),
            Action::Restart => self.restarts = true,
        }
        answer
    }

    /// When the self-test is over, and no answer under way: tell what it found, and log it.
    fn tell_self_test(&mut self, context: &ConsoleContext<'_>) {
        if self.answer.is_some() {
            return;
        }
        let Some(due) = self.self_test.step(context.tick, self.health) else { return };
        let report = self.self_test_report(due, context);
        let mut text = heapless::String::new();
        // The names of all parts have room.
        _ = report.put_summary(&mut text);
        self.notice(context.tick, EventKind::Notice(text));
        self.answer = Some((Answer::SelfTest(report), 0));
    }

    fn self_test_report(&mut self, due: Due, context: &ConsoleContext<'_>) -> SelfTestReport {
        let (scalar, flux) = context.marks;
        SelfTestReport {
            due,
            clock: self.self_test.clock(),
            converter: self.health.checks.converter(),
            flux,
            scalar,
            card: self.health.checks.card(),
            is_logging_wanted: self.health.log.is_wanted(),
            flash: self.settings.is_intact().into(),
            reset: self.system.reset_cause(),
            restarts_by_fault: self.health.counts.get(Count::RestartsByFault),
        }
    }

    fn report(&self, context: &mut ConsoleContext<'_>, now_us: u32) -> StatusReport {
        StatusReport {
            firmware_version: self.version,
            tick: context.tick,
            time: context.time_of_day.as_mut().map(|time| time.at(now_us)),
            sectors_left: self.health.log.sectors_left(),
            session: SessionState::Idle, // `execute` fills these two in
            is_unsaved: false,
            settings: self.settings.condition(),
            housekeeping: context.housekeeping,
            faults: self.health.counts.faults(),
        }
    }

    /// What a calibration came to, for the log.
    fn note_calibration(&mut self, before: SessionState, context: &ConsoleContext<'_>) {
        let SessionState::Running { used_epochs, .. } = before else { return };
        let kind = context.session.found().map_or(EventKind::CalibrationFailed { used_epochs }, event_of);
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
            self.system.keep_time(context.time_of_day.as_mut().map(|time| time.at(now_us)));
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

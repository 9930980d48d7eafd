//! The operator's lines from the ship, what they do, and the answers.

mod context;
mod found_event;
mod inbox;

pub use context::ConsoleContext;
pub use inbox::{Arrival, Inbox, InboxQueue, receive};

use crate::body::{Firmware, TimeOfDay};
use crate::hardware::{SensorTransmitters, Stamp, System};
use crate::health::{Count, Health};
use crate::link::{
    Action, Answer, Calibrate, Command, Input, LineReader, SessionState, StatusReport, TimerTold, acknowledgement,
    execute,
};
use crate::log::{Event, EventKind, truncated};
use crate::self_test::{Due, SelfTest, SelfTestReport};
use crate::store::{BodySettings, Condition, SettingsInFlash};
use crate::telemetry::Outbox;
use embedded_storage::nor_flash::NorFlash;
use found_event::event_of;
use heapless::spsc::{Consumer, Producer, Queue};

/// What happened, on its way to the log: events that are too long for the queue of the epochs.
pub type NoticeQueue = Queue<Event, 4>;

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

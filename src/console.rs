//! The operator's lines from the ship, what they do, and the answers.

use crate::board::{self, Keeper};
use crate::status::{Count, STATUS};
use crate::telemetry::Outbox;
use heapless::spsc::{Consumer, Producer, Queue};
use towmag::body::Clock;
use towmag::link::{
    Action, Answer, Calibrate, CalibrationSession, Command, FaultCounters, Input, LineReader, SessionState,
    StatusReport, execute,
};
use towmag::log::{Event, EventKind, truncated};
use towmag::store::Condition;

/// Bytes from the ship, `None` where the receiver reports an error: three of the longest lines.
pub type InboxQueue = Queue<Option<u8>, 256>;

/// What happened, on its way to the log: events that are too long for the queue of the epochs.
pub type NoticeQueue = Queue<Event, 4>;

/// What commands act on, besides the settings.
pub struct Desk<'a> {
    pub session: CalibrationSession,
    /// `None` until someone sets it.
    pub clock: Option<Clock>,
    pub outbox: Outbox<'a>,
    /// Tick of the latest epoch.
    pub tick: u32,
}

/// Takes lines one at a time: the next when the answer is on its way.
pub struct Console<'a> {
    inbox: Consumer<'a, Option<u8>>,
    notices: Producer<'a, Event>,
    lines: LineReader,
    keeper: Keeper,
    /// The answer under way, and its next line.
    answer: Option<(Answer, usize)>,
    restarts: bool,
}

impl<'a> Console<'a> {
    pub fn new(inbox: Consumer<'a, Option<u8>>, mut notices: Producer<'a, Event>, keeper: Keeper) -> Self {
        STATUS.want_log(keeper.stored.settings.log);
        let is_well = matches!(keeper.condition, Condition::Intact | Condition::Fresh);
        if !is_well {
            let kind = EventKind::Notice(text_of(&keeper.condition));
            // The queue is empty yet.
            _ = notices.enqueue(Event { tick: 0, kind });
        }
        let answer = (!is_well).then(|| (Answer::telling(&keeper.condition), 0));
        Self { inbox, notices, lines: LineReader::default(), keeper, answer, restarts: false }
    }

    /// Go on with the answer, then take in what has come.
    pub fn run(&mut self, desk: &mut Desk<'_>, faults: &FaultCounters) {
        while self.has_answered(&mut desk.outbox) {
            if self.restarts {
                return self.restart(desk);
            }
            let Some(input) = self.next_input() else { break };
            self.take(input, desk, faults);
        }
        let counters = self.lines.counters();
        STATUS.set(Count::ConsoleLinesDropped, counters.overlong.saturating_add(counters.damaged));
    }

    /// Send as many lines as there is room for; whether that was the last.
    fn has_answered(&mut self, outbox: &mut Outbox<'_>) -> bool {
        while let Some((answer, next)) = &mut self.answer {
            match answer.line(&self.keeper.stored.settings, *next) {
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

    fn take(&mut self, input: Input, desk: &mut Desk<'_>, faults: &FaultCounters) {
        let answer = match input {
            Input::Command(command) => self.obey(&command, desk, faults),
            Input::Refused(error) => Answer::telling(&error),
            Input::Dropped(dropped) => Answer::telling(&dropped),
        };
        self.answer = Some((answer, 0));
    }

    fn obey(&mut self, command: &Command, desk: &mut Desk<'_>, faults: &FaultCounters) -> Answer {
        let now_us = board::stamp_us(board::Source::Other);
        let report = self.report(desk, faults, now_us);
        let before = desk.session.state();
        let (answer, action) = execute(command, &mut self.keeper.stored, &mut desk.session, &report);
        if *command == Command::Calibrate(Calibrate::Stop) {
            self.note_calibration(before, desk);
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
                desk.clock = Some(Clock::set(unix_ms, now_us));
                self.notice(desk.tick, EventKind::TimeSet { unix_ms });
            }
            Action::Restart => self.restarts = true,
        }
        answer
    }

    fn report(&self, desk: &mut Desk<'_>, faults: &FaultCounters, now_us: u32) -> StatusReport {
        StatusReport {
            firmware_version: env!("CARGO_PKG_VERSION"),
            tick: desk.tick,
            unix_s: desk.clock.as_mut().map(|clock| clock.unix_ms(now_us) / 1_000),
            sectors_left: STATUS.sectors_left(),
            session: SessionState::Idle, // `execute` fills it in
            settings: self.keeper.condition,
            faults: *faults,
        }
    }

    /// What a calibration came to, for the log.
    fn note_calibration(&mut self, before: SessionState, desk: &Desk<'_>) {
        let SessionState::Running { used_epochs, .. } = before else { return };
        let kind = desk.session.summary().map_or(EventKind::CalibrationFailed { used_epochs }, |summary| {
            EventKind::Calibrated {
                coefficients: summary.coefficients,
                used_epochs: summary.used_epochs,
                std_before_nt: summary.std_before_nt as f32,
                rms_after_nt: summary.rms_after_nt as f32,
            }
        });
        self.notice(desk.tick, kind);
    }

    fn notice(&mut self, tick: u32, kind: EventKind) {
        Count::RecordsLost.unless(self.notices.enqueue(Event { tick, kind }).is_ok());
    }

    /// Store settings and coefficients; the answer when that fails.
    fn save(&mut self) -> Option<Answer> {
        let Keeper { flash, store, stored, condition } = &mut self.keeper;
        STATUS.want_log(stored.settings.log);
        let Some(store) = store else {
            return Some(Answer::telling(&"error: not stored, gone with the next start: the flash cannot be read"));
        };
        match store.save(flash, stored) {
            Ok(()) => {
                *condition = Condition::Intact;
                None
            }
            Err(error) => Some(Answer::telling(&format_args!("error: not stored, gone with the next start: {error}"))),
        }
    }

    /// When the last line has left the queue, have the log closed and the chip started anew.
    fn restart(&mut self, desk: &mut Desk<'_>) {
        if desk.outbox.is_empty() {
            let now_us = board::stamp_us(board::Source::Other);
            board::leave_time(desk.clock.as_mut().map(|clock| clock.unix_ms(now_us)));
            STATUS.ask_for_restart();
        }
    }
}

fn text_of<const N: usize>(what: &impl core::fmt::Display) -> heapless::String<N> {
    let mut text = heapless::String::<N>::new();
    // Too long only for a text that this firmware does not have; then it is cut.
    _ = core::fmt::Write::write_fmt(&mut text, format_args!("{what}"));
    truncated(&text)
}

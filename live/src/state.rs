//! All that a viewer may ask for.

use std::collections::VecDeque;

use crate::alarm::{AlarmKind, Alarms};
use crate::feed::Update;
use crate::history::History;
use crate::lamp::{Lamps, Level};
use crate::message::{Hello, HistoryCells, Message, Row};
use crate::notice::{Contact, Mark};
use crate::options::LiveOptions;
use crate::sample::Sample;

/// Marks, and contacts, that are kept for viewers; the files have all.
const NOTICES: usize = 500;
/// Lines of text.
const TEXTS: usize = 100;

/// All that a viewer may ask for.
pub(crate) struct State {
    options: LiveOptions,
    session: String,
    history: History,
    lamps: Lamps,
    alarms: Alarms,
    marks: VecDeque<Mark>,
    contacts: VecDeque<Contact>,
    texts: VecDeque<String>,
    is_over: bool,
    /// Epochs that no viewer has been sent yet.
    pub(crate) fresh: Vec<Row>,
    /// When something came last, s of the server's clock.
    heard_s: f64,
}

impl State {
    /// Nothing is known yet; `session` is another one for each start.
    pub(crate) fn new(options: LiveOptions, session: String) -> Self {
        Self {
            options,
            session,
            history: History::default(),
            lamps: Lamps::default(),
            alarms: Alarms::default(),
            marks: VecDeque::new(),
            contacts: VecDeque::new(),
            texts: VecDeque::new(),
            is_over: false,
            fresh: Vec::new(),
            heard_s: 0.0,
        }
    }

    /// Take something new at a time of the server's clock, s; what viewers are to be told beside epochs goes to `tell`.
    pub(crate) fn take(&mut self, update: Update, clock_s: f64, tell: &mut impl FnMut(&Message<'_>)) {
        match update {
            Update::Sample(sample) => self.take_sample(&sample, clock_s, tell),
            Update::Lamps(lamps) if lamps != self.lamps => {
                self.lamps = lamps;
                tell(&Message::Lamps { lamps: &self.lamps });
            }
            Update::Lamps(_) => {}
            Update::Text(text) => tell(&Message::Text { text: keep(&mut self.texts, text, TEXTS).as_str() }),
            Update::Mark(mark) => tell(&Message::Mark { mark: keep(&mut self.marks, mark, NOTICES) }),
            Update::Contact(contact) => {
                tell(&Message::Contact { contact: keep(&mut self.contacts, contact, NOTICES) });
                let text = format!(
                    "Target {}: {:+.1} nT, signal to noise {:.0}",
                    contact.number, contact.peak_nt, contact.snr
                );
                self.alarms.ring(AlarmKind::Target, contact.time_s, text);
                tell(&Message::Alarms { alarms: self.alarms.all() });
            }
            Update::End => {
                self.is_over = true;
                tell(&Message::End);
            }
        }
    }

    /// Time passes; nothing may have come.
    pub(crate) fn watch_silence(&mut self, clock_s: f64, tell: &mut impl FnMut(&Message<'_>)) {
        let is_silent = self.options.is_live && !self.is_over && clock_s > self.heard_s;
        let text = || "Nothing comes up the cable".to_string();
        if self.alarms.watch(AlarmKind::Cable, is_silent, clock_s, self.now_s(), text) {
            tell(&Message::Alarms { alarms: self.alarms.all() });
        }
    }

    fn take_sample(&mut self, sample: &Sample, clock_s: f64, tell: &mut impl FnMut(&Message<'_>)) {
        self.history.push(sample);
        self.fresh.push(Row::new(sample));
        self.heard_s = clock_s;
        let (lamps, lowest_m) = (&self.lamps, self.options.lowest_altitude_m);
        let is_low = sample.altitude_m.is_some_and(|altitude_m| altitude_m < lowest_m);
        let mut watch = |kind, is_wrong, text: &dyn Fn() -> String| {
            self.alarms.watch(kind, is_wrong, sample.time_s, sample.time_s, text)
        };
        let changes = [
            watch(AlarmKind::Cable, false, &String::new),
            watch(AlarmKind::Sensor, lamps.sensor.level == Level::Bad, &|| format!("Sensor: {}", lamps.sensor.word)),
            watch(AlarmKind::Log, lamps.log.level == Level::Bad, &|| format!("Log: {}", lamps.log.word)),
            watch(AlarmKind::Altitude, is_low, &|| format!("Less than {lowest_m} m above the bottom")),
            watch(AlarmKind::Leak, sample.has_leak == Some(true), &|| "Water in the body".into()),
        ];
        if changes.contains(&true) {
            tell(&Message::Alarms { alarms: self.alarms.all() });
        }
    }

    /// A person has seen an alarm; what it was, where that is news.
    pub(crate) fn acknowledge(&mut self, alarm: &str, tell: &mut impl FnMut(&Message<'_>)) -> Option<String> {
        let text = self.alarms.acknowledge(AlarmKind::parse(alarm)?)?;
        tell(&Message::Alarms { alarms: self.alarms.all() });
        Some(text)
    }

    /// The mark that somebody wants, at a time that is on the strip.
    pub(crate) fn mark(&self, time_s: Option<f64>, label: String) -> Mark {
        let oldest_s = self.history.tier(f64::INFINITY).cells().next().map_or(0.0, |cell| cell.time_s);
        let wanted_s = time_s.unwrap_or(f64::INFINITY).min(self.now_s());
        Mark { time_s: wanted_s.max(oldest_s), label }
    }

    /// What a new viewer is told.
    pub(crate) fn hello(&self, may_mark: bool, may_command: bool) -> String {
        let hello = Hello {
            session: &self.session,
            title: &self.options.title,
            version: env!("CARGO_PKG_VERSION"),
            is_live: self.options.is_live,
            is_over: self.is_over,
            may_mark,
            may_command,
            lowest_altitude_m: self.options.lowest_altitude_m,
            now_s: self.history.last_s(),
            lamps: &self.lamps,
            alarms: self.alarms.all(),
            marks: self.marks.iter().collect(),
            contacts: self.contacts.iter().collect(),
            texts: self.texts.iter().map(String::as_str).collect(),
        };
        Message::Hello(hello).json()
    }

    /// What was in the last so many seconds, or later than a time.
    pub(crate) fn history(&self, window_s: f64, since_s: Option<f64>) -> String {
        let cells = HistoryCells::new(window_s, since_s, self.history.tier(window_s), self.history.track());
        Message::History(cells).json()
    }

    fn now_s(&self) -> f64 {
        self.history.last_s().unwrap_or(0.0)
    }
}

/// Keep the latest so many; the one that came.
fn keep<T>(all: &mut VecDeque<T>, new: T, most: usize) -> &T {
    if all.len() == most {
        all.pop_front();
    }
    all.push_back_mut(new)
}

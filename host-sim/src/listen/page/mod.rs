//! What the live page is told: each message of the body as an epoch, lamps in words, contacts, and what people want done.

mod contacts;
mod lamps;
mod settled;
mod strip_time;

use std::sync::mpsc::Receiver;

use towmag::Status;
use towmag::link::Telemetry;
use towmag_live::{Contact, Feed, LiveError, LiveOptions, Mark, Order, Sample, Server, Update};

use super::heard::{Heard, Told};
use super::ship_time::unix_us;
use contacts::Detector;
use lamps::LampWords;
use settled::Settled;
use strip_time::StripTime;

/// What is shown at most is what somebody can have marked, s.
const LONGEST_BACK_S: f64 = 43_200.0;

/// A page that is served, and what it has to know between messages.
pub(super) struct Page {
    server: Server,
    feed: Feed,
    orders: Option<Receiver<Order>>,
    time: StripTime,
    words: LampWords,
    settled: Settled,
    detector: Detector,
}

impl Page {
    /// Serve a page; `kept` names the files that are written.
    pub(super) fn serve(options: LiveOptions, kept: Vec<String>) -> Result<Self, LiveError> {
        let is_live = options.is_live;
        let mut server = Server::start(options)?;
        let (feed, orders) = (server.feed(), server.orders());
        let detector = Detector::begin()?;
        Ok(Self {
            feed,
            orders,
            server,
            time: StripTime::new(),
            words: LampWords::new(kept, is_live),
            settled: Settled::default(),
            detector,
        })
    }

    /// What a person types into a browser.
    pub(super) fn links(&self) -> Vec<String> {
        self.server.links()
    }

    /// A message of the body and what it told beside it; `ship_us` is the ship's time if it came just now.
    pub(super) fn telemetry(&mut self, message: &Telemetry, told: &Told, heard: &Heard, ship_us: Option<u64>) {
        let time_s = self.time.place(message.tick, message.unix_ms, ship_us);
        if let Some(lamps) = self.words.of_message(message, heard) {
            self.feed.send(Update::Lamps(lamps));
        }
        let is_settled = self.settled.of_message(time_s, message.status == Status::Settling);
        self.sample(sample(message, told, time_s), is_settled);
    }

    fn sample(&mut self, sample: Sample, is_settled: bool) {
        let sample = Sample { heard_s: Some(unix_us() as f64 / 1e6), ..sample };
        self.feed.send(Update::Sample(sample));
        self.detector.take(&sample, is_settled);
    }

    /// An epoch of a recording: good or bad is all that is known of it.
    pub(super) fn row(&mut self, sample: Sample, is_valid: bool) {
        if let Some(lamps) = self.words.of_row(is_valid) {
            self.feed.send(Update::Lamps(lamps));
        }
        let is_settled = self.settled.of_row(sample.time_s);
        self.sample(sample, is_settled);
    }

    /// A line of text.
    pub(super) fn text(&self, text: &str) {
        self.feed.send(Update::Text(text.into()));
    }

    /// A mark that is in the files now.
    pub(super) fn mark(&self, mark: Mark) {
        self.feed.send(Update::Mark(mark));
    }

    /// A mark of a recording. Where the body's clock was not set, what was written is a time of the ship that the strip does
    /// not have: it was made about now, then.
    pub(super) fn recorded_mark(&self, mark: Mark) {
        let now_s = self.time.last_s();
        let is_on_strip = (mark.time_s - now_s).abs() < LONGEST_BACK_S;
        self.mark(if is_on_strip { mark } else { Mark { time_s: now_s, ..mark } });
    }

    /// Contacts that were found since this was asked last; the page is shown them.
    pub(super) fn contacts(&self) -> Vec<Contact> {
        let found = self.detector.found();
        found.iter().for_each(|contact| self.feed.send(Update::Contact(*contact)));
        found
    }

    /// What viewers want done.
    pub(super) fn orders(&self) -> Vec<Order> {
        self.orders.iter().flat_map(Receiver::try_iter).collect()
    }

    /// The end of what there is to show.
    pub(super) fn end(&self) {
        self.feed.send(Update::End);
    }
}

fn sample(message: &Telemetry, told: &Told, time_s: f64) -> Sample {
    let nanotesla = |pt: i32| f64::from(pt) / 1e3;
    let degrees = |angle_e7: i32| f64::from(angle_e7) * 1e-7;
    let position = told.navigation.position;
    Sample {
        time_s,
        sent_s: message.unix_ms.map(|unix_ms| unix_ms as f64 / 1e3),
        heard_s: None,
        raw_nt: message.raw_scalar_pt.map(nanotesla),
        compensated_nt: message.compensated.map(|compensated| nanotesla(compensated.compensated_pt)),
        residual_nt: message.compensated.map(|compensated| compensated.residual_nt.into()),
        depth_m: told.navigation.depth_m.map(f64::from),
        altitude_m: told.navigation.altitude_m.map(f64::from),
        position_deg: position.map(|position| [degrees(position.latitude_e7), degrees(position.longitude_e7)]),
        has_leak: told.housekeeping.has_leak,
        battery_v: told.housekeeping.battery_v.map(f64::from),
    }
}

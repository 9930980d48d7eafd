//! One session of a log beside its replay, epoch by epoch.

use towmag::estimate::Prior;
use towmag::log::{EpochRecord, Header, Record};
use towmag::model::Coefficients;
use towmag::{Method, Output, Pipeline, SettingsError};

use super::outcome::{Outcome, SessionReplay};

/// Why a difference says nothing where the log does not hold all that the body started from.
const UNKNOWN_CALIBRATION: &str = "the adaptive method started from a calibration of which the log has the coefficients \
                                   alone: give the same calibration with --coefficients";

/// A session while it is replayed.
pub(crate) struct Session {
    number: u32,
    version: Option<String>,
    /// Replays from each of the starts that the log leaves possible.
    replays: Vec<Replay>,
    /// Whether the body must have started as one of them, so that a difference from all of them says something.
    is_known: bool,
    /// Why it could not be compared.
    unchecked: Option<String>,
    stopped: Option<String>,
    /// The tick that comes next.
    next_tick: u32,
    compared: u64,
}

/// A replay from one of the possible starts.
struct Replay {
    pipeline: Pipeline,
    first: Option<FirstDifference>,
    /// Epochs that differ.
    differing: u64,
    /// Sum of the squared differences of the residuals, nT^2, and how many there are.
    squares_nt2: f64,
    residuals: u64,
}

/// The first epoch that differs.
struct FirstDifference {
    tick: u32,
    stage: &'static str,
    logged: Output,
    replayed: Output,
}

impl Session {
    pub(crate) fn new(number: u32) -> Self {
        Self {
            number,
            version: None,
            replays: Vec::new(),
            is_known: false,
            unchecked: Some("its header is lost".into()),
            stopped: None,
            next_tick: 0,
            compared: 0,
        }
    }

    /// Start the replay where the body did.
    pub(crate) fn header(&mut self, header: &Header, prior: Option<&Prior>) {
        if self.version.is_some() {
            return self.stop("a second header follows");
        }
        self.version = Some(header.firmware_version.as_str().into());
        self.next_tick = header.start_tick;
        match replays(header, prior) {
            Ok((replays, is_known)) => (self.replays, self.is_known, self.unchecked) = (replays, is_known, None),
            Err(error) => self.unchecked = Some(format!("this program refuses its settings: {error}")),
        }
    }

    /// End the comparison: from here on the state of the body is not known.
    pub(crate) fn stop(&mut self, why: &str) {
        if self.stopped.is_some() || self.unchecked.is_some() {
            return;
        }
        if self.compared == 0 {
            self.unchecked = Some(format!("{why} at its start"));
        } else {
            self.stopped = Some(format!("{why} after tick {}", self.next_tick.wrapping_sub(1)));
        }
    }

    /// Replay one more epoch and compare. Ticks may be left out: the grid of epochs leaves some out when it moves to the
    /// scalar sensor's phase, and the core has seen it so. Epochs that the log has lost are recorded as lost.
    pub(crate) fn epoch(&mut self, record: &EpochRecord) {
        if record.epoch.tick < self.next_tick {
            self.stop("the ticks go back");
        }
        if self.stopped.is_some() || self.unchecked.is_some() {
            return;
        }
        self.replays.iter_mut().for_each(|replay| replay.epoch(record));
        self.next_tick = record.epoch.tick.saturating_add(1);
        self.compared += 1;
    }

    /// What the replay of the whole session says.
    pub(crate) fn finish(self) -> SessionReplay {
        let outcome = self.outcome();
        SessionReplay {
            session: format!("{:08x}", self.number),
            firmware_version: self.version,
            compared_epochs: self.compared,
            outcome,
            stopped: self.stopped,
        }
    }

    /// What the replay says that agrees for longest.
    fn outcome(&self) -> Outcome {
        if let Some(why) = &self.unchecked {
            return Outcome::Unchecked { why: why.clone() };
        }
        if self.compared == 0 {
            return Outcome::Unchecked { why: "it holds no epoch".into() };
        }
        let agrees_until = |replay: &&Replay| replay.first.as_ref().map_or(u32::MAX, |first| first.tick);
        let longest = self.replays.iter().max_by_key(agrees_until);
        match longest.and_then(|replay| Some((replay, replay.first.as_ref()?))) {
            None => Outcome::Equal,
            Some((replay, first)) if self.is_known => replay.differs(first),
            Some(_) => Outcome::Unchecked { why: UNKNOWN_CALIBRATION.into() },
        }
    }
}

/// A replay from each of the starts that the header leaves possible, and whether the right one is among them.
///
/// The log keeps the coefficients of a calibration, but not its information, of which the adaptive method makes use.
fn replays(header: &Header, prior: Option<&Prior>) -> Result<(Vec<Replay>, bool), SettingsError> {
    let bare = Prior::from(header.coefficients);
    let needs_more = header.settings.method == Method::Adaptive && header.coefficients != Coefficients::ZERO;
    let given = prior
        .filter(|prior| needs_more && prior.information.is_some())
        .filter(|prior| bits(&prior.coefficients) == bits(&header.coefficients));
    let replay = |prior: &Prior| Ok(Replay::new(Pipeline::new(&header.settings, *prior)?));
    let replays: Result<Vec<Replay>, SettingsError> = std::iter::once(&bare).chain(given).map(replay).collect();
    Ok((replays?, !needs_more || given.is_some()))
}

fn bits(coefficients: &Coefficients) -> Vec<u32> {
    coefficients.basis().iter().map(|value| value.to_bits()).collect()
}

impl Replay {
    fn new(pipeline: Pipeline) -> Self {
        Self { pipeline, first: None, differing: 0, squares_nt2: 0.0, residuals: 0 }
    }

    fn epoch(&mut self, record: &EpochRecord) {
        let replayed = self.pipeline.step(&record.epoch);
        let residual_nt = |output: &Output| output.compensated.map(|compensated| f64::from(compensated.residual_nt));
        if let (Some(logged), Some(replayed)) = (residual_nt(&record.output), residual_nt(&replayed)) {
            self.squares_nt2 += (logged - replayed).powi(2);
            self.residuals += 1;
        }
        if encoded(record) != encoded(&EpochRecord { output: replayed, ..*record }) {
            self.differing += 1;
            let stage = stage(&record.output, &replayed);
            let tick = record.epoch.tick;
            self.first.get_or_insert(FirstDifference { tick, stage, logged: record.output, replayed });
        }
    }

    fn differs(&self, first: &FirstDifference) -> Outcome {
        Outcome::Differs {
            first_tick: first.tick,
            stage: first.stage,
            epochs: self.differing,
            difference_rms_nT: (self.squares_nt2 / self.residuals.max(1) as f64).sqrt(),
            logged: format!("{:?}", first.logged),
            replayed: format!("{:?}", first.replayed),
        }
    }
}

/// A record as the log keeps it: bits are compared, as `==` takes 0 and -0 for equal.
fn encoded(record: &EpochRecord) -> ([u8; Record::MAX_LEN], Option<usize>) {
    let mut bytes = [0; Record::MAX_LEN];
    let len = Record::Epoch(*record).encode(&mut bytes);
    (bytes, len)
}

/// The first stage of the core whose output differs.
fn stage(logged: &Output, replayed: &Output) -> &'static str {
    match (logged.compensated, replayed.compensated) {
        (Some(a), Some(b)) if logged.status == replayed.status => {
            let is_same = a.band_passed_nt.to_bits() == b.band_passed_nt.to_bits();
            if is_same { "estimator" } else { "band_pass" }
        }
        _ => "front_end",
    }
}

//! Equal bit for bit, or where not.

use towmag::link::Telemetry;
use towmag::logbook::{EpochRecord, Record};

use super::telemetry::comparable;

/// Sessions end in a power cut: what was not yet a whole sector, and what was queued, is gone. Nothing else may be.
const MOST_UNSAVED: usize = 32;

/// The first difference between the body and its replay.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    what: &'static str,
    session: usize,
    index: usize,
    body: Option<String>,
    replay: Option<String>,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { what, session, index, body, replay } = self;
        write!(f, "{what}, start {session}, epoch {index}: ")?;
        match (body, replay) {
            (Some(body), Some(replay)) => write!(f, "body {body}, replay {replay}"),
            (Some(body), None) => write!(f, "only the body has {body}"),
            (None, Some(replay)) => write!(f, "only the replay has {replay}"),
            (None, None) => write!(f, "nothing"),
        }
    }
}

/// Hold the telemetry, which is one stream over all sessions, against the replay.
pub(super) fn telemetry(body: &[Telemetry], replay: &[Vec<Telemetry>]) -> Result<(), Difference> {
    let body: Vec<Telemetry> = body.iter().map(comparable).collect();
    let mut rest = body.as_slice();
    for (session, expected) in replay.iter().enumerate() {
        let is_last = session + 1 == replay.len();
        let (here, further) =
            if is_last { (rest, [].as_slice()) } else { rest.split_at(rest.len().min(expected.len())) };
        first_difference("telemetry", session, here, expected, |message| message.frame().to_vec())?;
        rest = further;
    }
    Ok(())
}

/// Hold a session's log against the replay: it may end early, but only by what a power cut takes.
pub(super) fn log(session: usize, body: &[EpochRecord], replay: &[EpochRecord]) -> Result<(), Difference> {
    let saved = replay.len().saturating_sub(MOST_UNSAVED).max(body.len()).min(replay.len());
    first_difference("log", session, body, &replay[..saved], bits)
}

/// `bits` are all bits of a message: `==` on floating-point numbers would take 0 for -0.
fn first_difference<T: std::fmt::Debug>(
    what: &'static str,
    session: usize,
    body: &[T],
    replay: &[T],
    bits: impl Fn(&T) -> Vec<u8>,
) -> Result<(), Difference> {
    for index in 0..body.len().max(replay.len()) {
        let (body, replay) = (body.get(index), replay.get(index));
        if body.map(&bits) != replay.map(&bits) {
            let text = |of: Option<&T>| of.map(|of| format!("{of:?}"));
            return Err(Difference { what, session, index, body: text(body), replay: text(replay) });
        }
    }
    Ok(())
}

/// A record as the log keeps it.
fn bits(record: &EpochRecord) -> Vec<u8> {
    let mut bytes = vec![0; Record::MAX_LEN];
    let len = Record::Epoch(*record).encode(&mut bytes).unwrap_or(0);
    bytes.truncate(len);
    bytes
}

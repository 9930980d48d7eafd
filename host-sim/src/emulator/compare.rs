//! Equal bit for bit, or where not.

use std::collections::HashSet;

use towmag::link::Telemetry;
use towmag::log::{EpochRecord, Record};

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

/// Hold the telemetry of a life against the replay. Only the last life ends when everything has been sent.
pub(super) fn telemetry(
    session: usize,
    body: &[Telemetry],
    replay: &[Telemetry],
    is_last: bool,
) -> Result<(), Difference> {
    let body: Vec<Telemetry> = body.iter().map(comparable).collect();
    let sent = if is_last { replay } else { all_but_unsaved(&body, replay) };
    first_difference("telemetry", session, &body, sent, |message| message.frame().to_vec())
}

/// Hold a session's log against the replay: it may end early, but only by what a power cut takes.
pub(super) fn log(session: usize, body: &[EpochRecord], replay: &[EpochRecord]) -> Result<(), Difference> {
    first_difference("log", session, body, all_but_unsaved(body, replay), bits)
}

/// The log of a session in which logging was switched off for a time: what there is must be right. Fault flags are recorded
/// when they change, which depends on what was recorded before.
pub(super) fn log_with_pauses(session: usize, body: &[EpochRecord], replay: &[EpochRecord]) -> Result<(), Difference> {
    let without_flags = |record: &EpochRecord| EpochRecord { faults: None, ..*record };
    let ticks: HashSet<u32> = body.iter().map(|record| record.epoch.tick).collect();
    let logged = replay.iter().filter(|record| ticks.contains(&record.epoch.tick));
    let (body, logged): (Vec<_>, Vec<_>) =
        (body.iter().map(without_flags).collect(), logged.map(without_flags).collect());
    first_difference("log", session, &body, &logged, bits)
}

/// The replay without the end that a body may have lost.
fn all_but_unsaved<'a, T>(body: &[T], replay: &'a [T]) -> &'a [T] {
    &replay[..replay.len().saturating_sub(MOST_UNSAVED).max(body.len()).min(replay.len())]
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

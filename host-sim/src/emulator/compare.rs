//! Equal bit for bit, or where not.

use std::collections::HashSet;

use towmag::housekeeping::Housekeeping;
use towmag::link::Telemetry;
use towmag::log::{EpochRecord, Event, EventKind, Record};

use super::card::Session;
use super::difference::Difference;
use super::error::EmulatorError;
use super::telemetry::comparable;
use crate::wire::body::Made;

/// Sessions end in a power cut: what was not yet a whole sector, and what was queued, is gone. Nothing else may be.
const MOST_UNSAVED: usize = 32;

/// Hold the telemetry of all lives against the replay.
pub(super) fn all_telemetry(lives: &[Vec<Telemetry>], sessions: &[Vec<Made>]) -> Result<(), EmulatorError> {
    for (life, made) in sessions.iter().enumerate() {
        let replay: Vec<Telemetry> = made.iter().map(|made| made.telemetry).collect();
        let body = lives.get(life).map_or(&[][..], Vec::as_slice);
        telemetry(life, body, &replay, life + 1 == sessions.len())?;
    }
    Ok(())
}

/// Hold the log of all sessions against the replay.
pub(super) fn all_logs(logged: &[Session], sessions: &[Vec<Made>]) -> Result<(), EmulatorError> {
    for (start, made) in sessions.iter().enumerate() {
        let expected: Vec<EpochRecord> = made.iter().map(|made| made.record).collect();
        let none = Session::default();
        let session = logged.get(start).unwrap_or(&none);
        let has_pauses = session.events.iter().any(|event| event.kind == EventKind::LogStop);
        let compare = if has_pauses { log_with_pauses } else { log };
        compare(start, &session.epochs, &expected)?;
        if session.lost_epochs > 0 || session.faults > 0 {
            let Session { lost_epochs, faults, .. } = session;
            return Err(EmulatorError::Broken(format!(
                "the log of start {start} lacks {lost_epochs} epochs and has {faults} faults"
            )));
        }
    }
    Ok(())
}

/// Hold what the log of all sessions tells of leak and battery against the replay, at the epochs that are in it.
pub(super) fn all_housekeeping(logged: &[Session], told: &[Vec<(u32, Housekeeping)>]) -> Result<(), Difference> {
    for (start, (session, told)) in logged.iter().zip(told).enumerate() {
        let ticks: HashSet<u32> = session.epochs.iter().map(|record| record.epoch.tick).collect();
        let is_logged = |event: &Event| ticks.contains(&event.tick);
        let of_body = session.events.iter().filter(|event| matches!(event.kind, EventKind::Housekeeping(_)));
        let body: Vec<Event> = of_body.filter(|event| is_logged(event)).cloned().collect();
        let event = |&(tick, housekeeping)| Event { tick, kind: EventKind::Housekeeping(housekeeping) };
        let replay: Vec<Event> = told.iter().map(event).filter(is_logged).collect();
        first_difference("leak and battery", start, &body, &replay, |event| encoded(&Record::Event(event.clone())))?;
    }
    Ok(())
}

/// Hold the telemetry of a life against the replay. Only the last life ends when everything has been sent.
fn telemetry(session: usize, body: &[Telemetry], replay: &[Telemetry], is_last: bool) -> Result<(), Difference> {
    let body: Vec<Telemetry> = body.iter().map(comparable).collect();
    let sent = if is_last { replay } else { all_but_unsaved(&body, replay) };
    first_difference("telemetry", session, &body, sent, |message| message.frame().to_vec())
}

/// Hold a session's log against the replay: it may end early, but only by what a power cut takes.
fn log(session: usize, body: &[EpochRecord], replay: &[EpochRecord]) -> Result<(), Difference> {
    first_difference("log", session, body, all_but_unsaved(body, replay), bits)
}

/// The log of a session in which logging was switched off for a time: what there is must be right. Fault flags are recorded
/// when they change, which depends on what was recorded before.
fn log_with_pauses(session: usize, body: &[EpochRecord], replay: &[EpochRecord]) -> Result<(), Difference> {
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

fn bits(record: &EpochRecord) -> Vec<u8> {
    encoded(&Record::Epoch(*record))
}

/// A record as the log keeps it.
fn encoded(record: &Record) -> Vec<u8> {
    let mut bytes = vec![0; Record::MAX_LEN];
    let len = record.encode(&mut bytes).unwrap_or(0);
    bytes.truncate(len);
    bytes
}

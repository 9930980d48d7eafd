//! Equal bit for bit, or where not.

use towmag::logbook::{EpochRecord, Record};

/// Sessions end in a power cut: what was not yet a whole sector, and what was queued, is gone. Nothing else may be.
const MOST_UNSAVED: usize = 32;

/// The first difference between the body and its replay.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    what: &'static str,
    session: usize,
    index: usize,
    body: Option<Box<EpochRecord>>,
    replay: Option<Box<EpochRecord>>,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { what, session, index, body, replay } = self;
        let tick = body.as_ref().or(replay.as_ref()).map_or(0, |record| record.epoch.tick);
        write!(f, "{what}, start {session}, epoch {index} (tick {tick}): ")?;
        match (body, replay) {
            (Some(body), Some(replay)) => write!(f, "body {body:?}, replay {replay:?}"),
            (Some(body), None) => write!(f, "only the body has {body:?}"),
            (None, Some(replay)) => write!(f, "only the replay has {replay:?}"),
            (None, None) => write!(f, "nothing"),
        }
    }
}

/// Hold the telemetry, which is one stream over all sessions, against the replay.
pub(super) fn telemetry(body: &[EpochRecord], replay: &[Vec<EpochRecord>]) -> Result<(), Difference> {
    let mut rest = body;
    for (session, expected) in replay.iter().enumerate() {
        let is_last = session + 1 == replay.len();
        let (here, further) =
            if is_last { (rest, [].as_slice()) } else { rest.split_at(rest.len().min(expected.len())) };
        first_difference("telemetry", session, here, expected)?;
        rest = further;
    }
    Ok(())
}

/// Hold a session's log against the replay: it may end early, but only by what a power cut takes.
pub(super) fn log(session: usize, body: &[EpochRecord], replay: &[EpochRecord]) -> Result<(), Difference> {
    let saved = replay.len().saturating_sub(MOST_UNSAVED).max(body.len()).min(replay.len());
    first_difference("log", session, body, &replay[..saved])
}

fn first_difference(
    what: &'static str,
    session: usize,
    body: &[EpochRecord],
    replay: &[EpochRecord],
) -> Result<(), Difference> {
    for index in 0..body.len().max(replay.len()) {
        let (body, replay) = (body.get(index), replay.get(index));
        if bits(body) != bits(replay) {
            let [body, replay] = [body, replay].map(|record| record.copied().map(Box::new));
            return Err(Difference { what, session, index, body, replay });
        }
    }
    Ok(())
}

/// All bits of a record, as the log keeps them: `==` on floating-point numbers would take 0 for -0.
fn bits(record: Option<&EpochRecord>) -> Option<Vec<u8>> {
    let mut bytes = vec![0; Record::MAX_LEN];
    let len = Record::Epoch(*record?).encode(&mut bytes)?;
    bytes.truncate(len);
    Some(bytes)
}

//! A device log against an exact replay of the inputs that it holds: equal bit for bit, or the firmware is the finding.

mod outcome;
mod session;

use std::path::Path;

use towmag::estimate::Prior;
use towmag::log::{EventKind, Record, Records, Recovered};

use crate::diagnosis::result::{CandidateShare, Cell, Diagnosis, EffectFound, Gap, GapClosed, Verdict};
use crate::effects::{FIRMWARE_MISMATCH, Library};
use crate::error::HostError;
use crate::recording::{FileBlocks, RecordingError, survey};
pub use outcome::{Outcome, SessionReplay};
use session::Session;

/// Replay every session of a log. `prior` is the calibration that the body may have started from.
///
/// # Errors
///
/// When the file cannot be opened.
pub fn replay_log(path: &Path, prior: Option<&Prior>) -> Result<Vec<SessionReplay>, HostError> {
    let io = |source| RecordingError::Io { path: path.display().to_string(), source };
    let mut source = FileBlocks::open(path).map_err(io)?;
    let (keys, _) = survey(&mut source);
    let mut sessions: Vec<Session> = Vec::new();
    for item in Records::new(&mut source, &keys) {
        if let Recovered::Session(id) = item {
            sessions.push(Session::new(id.session));
        } else if let Some(session) = sessions.last_mut() {
            take(session, item, prior);
        }
    }
    Ok(sessions.into_iter().map(Session::finish).collect())
}

/// One item of a log after the start of its session.
fn take(session: &mut Session, item: Recovered, prior: Option<&Prior>) {
    match item {
        Recovered::Record(Record::Header(header)) => session.header(&header, prior),
        Recovered::Record(Record::Epoch(record)) => session.epoch(&record),
        Recovered::Record(Record::Event(event)) => match event.kind {
            EventKind::SettingsChanged(_) => session.stop("settings were changed"),
            EventKind::LogStop => session.stop("logging was switched off"),
            _ => {}
        },
        Recovered::Record(Record::Loss(_)) => session.stop("the body lost records"),
        Recovered::Missing { .. } | Recovered::SectorLost(_) => session.stop("sectors are missing"),
        Recovered::Unreadable(_) => session.stop("a record cannot be read"),
        Recovered::Session(_) => {}
    }
}

/// Whether any session differs from its replay.
pub fn is_mismatch(sessions: &[SessionReplay]) -> bool {
    sessions.iter().any(|session| matches!(session.outcome, Outcome::Differs { .. }))
}

/// The diagnosis of a log whose outputs differ from their replay, and of nothing else; `None` when none does.
pub fn mismatch(sessions: Vec<SessionReplay>) -> Option<Diagnosis> {
    let (stage, difference_rms_nt) = sessions.iter().find_map(|session| match &session.outcome {
        Outcome::Differs { stage, difference_rms_nT, .. } => Some((*stage, *difference_rms_nT)),
        _ => None,
    })?;
    Some(Diagnosis {
        verdict: Verdict::Explained,
        gap: gap(difference_rms_nt),
        cells: vec![Cell { by: "stage", cell: stage.into(), channel: "firmware", excess_share: 1.0, p_value: 0.0 }],
        effects: vec![effect()],
        candidates: candidates(),
        next_manoeuvre: None,
        unexplained: Vec::new(),
        description: None,
        targets: Vec::new(),
        rounding: None,
        is_cut_short: false,
        channels: Vec::new(),
        consequence: None,
        simulation: None,
        exact_replay: sessions,
        bad_rows: Default::default(),
        provenance: None,
        specs: Library::default().specs().collect(),
        residuals: Vec::new(),
    })
}

/// A replay has no noise: all of the difference is the gap.
fn gap(difference_rms_nt: f64) -> Gap {
    Gap {
        residual_rms_nT: difference_rms_nt,
        noise_floor_rms_nT: 0.0,
        excess_rms_nT: difference_rms_nt,
        p_value: 0.0,
        channel: "firmware",
    }
}

/// The firmware itself, for certain.
fn effect() -> EffectFound {
    EffectFound {
        name: FIRMWARE_MISMATCH,
        probability: 1.0,
        parameters: Vec::new(),
        gap_closed: GapClosed { fraction: 1.0, ci95: [1.0, 1.0], held_out: false },
        confirmed: None,
        indistinguishable_from: Vec::new(),
        load: None,
        regressor: None,
        column: None,
        channel: "firmware",
        is_noise_without_edge: false,
        strength: f64::MAX,
    }
}

/// Every possible main cause; none but the firmware has a probability.
fn candidates() -> Vec<CandidateShare> {
    let library = Library::default();
    let names = library.specs().map(|spec| spec.name);
    let others = names.chain(["none", "unknown"]).map(|name| (name, 0.0));
    std::iter::once((FIRMWARE_MISMATCH, 1.0))
        .chain(others)
        .map(|(name, probability)| CandidateShare { name, probability, identifiable_fraction: None })
        .collect()
}

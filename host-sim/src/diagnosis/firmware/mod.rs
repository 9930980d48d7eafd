//! A device log against an exact replay of the inputs that it holds: equal bit for bit, or the firmware is the finding.

mod session;

use std::path::Path;

use serde::Serialize;
use towmag::estimate::Prior;
use towmag::log::{EventKind, Record, Records, Recovered};

use crate::diagnosis::result::{CandidateShare, Cell, Diagnosis, EffectFound, Gap, GapClosed, Verdict};
use crate::effects::{FIRMWARE_MISMATCH, Library};
use crate::error::HostError;
use crate::recording::{FileBlocks, RecordingError, survey};
use session::Session;

/// What the replay of a session says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SessionReplay {
    /// Number of the session, as the column `line` has it.
    pub session: String,
    /// Version of the firmware that wrote it; none where its header is lost.
    pub firmware_version: Option<String>,
    /// Epochs that were replayed and compared.
    pub compared_epochs: u64,
    /// What the comparison says.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Why the comparison ends before the session does; none where it does not.
    pub stopped: Option<String>,
}

/// How the outputs of a session compare with their replay.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "outcome", rename_all = "snake_case")]
pub enum Outcome {
    /// Every epoch that was compared is equal bit for bit.
    Equal,
    /// They differ.
    #[allow(non_snake_case)] // units as in the other results
    Differs {
        /// Tick of the first epoch that differs.
        first_tick: u32,
        /// The first stage of the core whose output differs there: `front_end`, `band_pass` or `estimator`.
        stage: &'static str,
        /// Epochs that differ.
        epochs: u64,
        /// Logged less replayed residual, root mean square over the compared epochs that have one, nT.
        difference_rms_nT: f64,
        /// Output of that epoch as it was logged.
        logged: String,
        /// The same replayed.
        replayed: String,
    },
    /// It could not be compared, so that nothing is said about it.
    Unchecked {
        /// Why.
        why: String,
    },
}

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
    let (stage, difference_nt) = sessions.iter().find_map(|session| match &session.outcome {
        Outcome::Differs { stage, difference_rms_nT, .. } => Some((*stage, *difference_rms_nT)),
        _ => None,
    })?;
    let cell = Cell { by: "stage", cell: stage.into(), channel: "firmware", excess_share: 1.0, p_value: 0.0 };
    Some(Diagnosis {
        verdict: Verdict::Explained,
        gap: Gap {
            residual_rms_nT: difference_nt,
            noise_floor_rms_nT: 0.0,
            excess_rms_nT: difference_nt,
            p_value: 0.0,
            channel: "firmware",
        },
        cells: vec![cell],
        effects: vec![effect()],
        candidates: candidates(),
        next_manoeuvre: None,
        unexplained: Vec::new(),
        channels: Vec::new(),
        exact_replay: sessions,
        specs: Library::default().specs().collect(),
        residuals: Vec::new(),
    })
}

/// A replay has no noise: what differs, differs.
fn effect() -> EffectFound {
    EffectFound {
        name: FIRMWARE_MISMATCH,
        probability: 1.0,
        parameters: Vec::new(),
        gap_closed: GapClosed { fraction: 1.0, ci95: [1.0, 1.0], held_out: false },
        confirmed: None,
        indistinguishable_from: Vec::new(),
        load: None,
        channel: "firmware",
        strength: f64::MAX,
    }
}

fn candidates() -> Vec<CandidateShare> {
    let library = Library::default();
    let names = library.specs().map(|spec| spec.name);
    let others = names.chain(["none", "unknown"]).map(|name| (name, 0.0));
    std::iter::once((FIRMWARE_MISMATCH, 1.0))
        .chain(others)
        .map(|(name, probability)| CandidateShare { name, probability, identifiable_fraction: None })
        .collect()
}

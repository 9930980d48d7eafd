//! What the replay of a session of a device log says.

use serde::Serialize;

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
